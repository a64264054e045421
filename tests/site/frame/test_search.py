import pytest

from robo_genesis.site.frame.search import SearchNames, ends


@pytest.mark.parametrize(
    ("word", "found"),
    [
        ("joint4", ["joint4"]),
        ("finger_joint1", ["finger_joint1", "joint1"]),
        ("set_dofs_kp", ["set_dofs_kp", "dofs_kp", "kp"]),
        ("__init__", ["__init__", "init__"]),
        ("q_", ["q_"]),
    ],
)
def test_a_name_is_found_by_its_ends(word, found):
    assert ends(word) == found


def test_words_of_a_text_stay_whole():
    words = SearchNames({}).split("reads get_dofs_control_force() once")
    assert words[0] == "reads"
    assert words[1] == "get_dofs_control_force"
    assert "control_force" in words
    assert words[-1] == "once"
