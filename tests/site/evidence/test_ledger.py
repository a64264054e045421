import io
import zipfile

import pytest
from docutils import nodes

from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.site.evidence import ledger_data
from robo_genesis.site.evidence.ledger import run_block
from robo_genesis.site.evidence.ledger_data import PageRun


def test_the_same_bundle_gives_the_same_bytes_whenever_it_was_written(tmp_path):
    log = tmp_path / "log.txt"
    log.write_text("a log")
    (tmp_path / "arrays").mkdir()
    (tmp_path / "arrays" / "G1.npz").write_bytes(b"numbers")
    before = ledger_data.archive(tmp_path)
    log.touch()
    log.chmod(0o600)
    assert ledger_data.archive(tmp_path) == before
    assert zipfile.ZipFile(io.BytesIO(before)).namelist() == [
        "arrays/G1.npz",
        "log.txt",
    ]
    log.write_text("another log")
    assert ledger_data.archive(tmp_path) != before


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


@pytest.mark.parametrize(
    ("recorded", "key", "command"),
    [
        (False, "l04/lab/cpu", "$ make book"),
        (True, "l04/lab/cpu/recorded", "$ make evidence LESSON=l04 BACKEND=cpu"),
    ],
)
def test_a_recorded_run_has_its_own_key_and_command(tmp_path, recorded, key, command):
    run = PageRun("l04/lab", tmp_path, Status("stale", "cpu", "old", None), recorded)
    assert run.key == key
    block = run_block("", run)
    assert [code.astext() for code in block.findall(nodes.literal_block)] == [command]
