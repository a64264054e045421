import pytest

from robo_genesis.site.evidence import ledger_data


@pytest.mark.parametrize(
    ("name", "content", "kind"),
    [
        ("a.svg", b"<svg><path/></svg>", "figure"),
        ("a.svg", b"<svg><image href='data:'/></svg>", "camera frame"),
        ("a.png", b"", "camera frame"),
    ],
)
def test_a_picture_of_pixels_is_a_camera_frame(tmp_path, name, content, kind):
    (tmp_path / name).write_bytes(content)
    assert ledger_data.picture_kind(tmp_path / name) == kind
