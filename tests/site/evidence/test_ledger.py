import io
import zipfile

import pytest

from robo_genesis.site.evidence import ledger_data


def test_the_same_bundle_gives_the_same_bytes_whenever_it_was_written(tmp_path):
    archives = []
    for content in ("a log", "a log", "another log"):
        (tmp_path / "log.txt").write_text(content)
        archives.append(ledger_data.archive(tmp_path))
    assert archives[0] == archives[1] != archives[2]
    assert zipfile.ZipFile(io.BytesIO(archives[0])).namelist() == ["log.txt"]


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
