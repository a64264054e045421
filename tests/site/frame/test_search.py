import pytest

from robo_genesis.site.frame.search import SearchNames


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("reads joint4", ["reads", "joint4"]),
        ("set_dofs_kp()", ["set_dofs_kp", "dofs_kp", "kp"]),
        ("__init__", ["__init__", "init__"]),
        ("q_", ["q_"]),
    ],
)
def test_a_name_is_found_by_its_ends(text, found):
    assert SearchNames({}).split(text) == found
