"""`make evidence`: exit status, what is printed, and the real lab on the CPU."""

import signal

import pytest
import tiny_book

from robo_genesis.core.project import BOOK, CACHE
from robo_genesis.evidence.bundle import evidence_key
from robo_genesis.pipeline.bundles.verify import verify_bundle


def test_a_recording_without_a_camera_is_refused(tmp_path):
    report = tiny_book.fails("evidence.py", tmp_path, RENDER="0")
    assert "RENDER='0' is not valid for a recording, which always has camera fr" in report


def test_ctrl_c_leaves_the_old_bundle_and_no_part_of_a_new_one(tmp_path):
    old, started = tiny_book.old_bundle(tmp_path, "cpu"), tmp_path / "started"
    waits = f"pathlib.Path({str(started)!r}).write_text('1')\nimport time\ntime.sleep(60)"
    leaves = tiny_book.cell(f"{tiny_book.WRITE_BUNDLE}\n{waits}")
    tiny_book.make_book(tmp_path, lab=tiny_book.notebook(leaves, front=tiny_book.LAB_FRONT))
    given = {"LESSON": "l04", "BACKEND": "cpu", "TO": str(tmp_path / "kept")}
    process = tiny_book.start("evidence.py", tmp_path, **given)
    tiny_book.wait_for(process, started)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in out
    assert [path.name for path in old.parents[1].iterdir()] == ["cpu"]
    assert old.read_text() == "old"
    assert not (tmp_path / "cache/recording").exists()


@pytest.mark.engine
def test_the_real_lab_recorded_on_the_cpu_is_accepted_evidence(tmp_path):
    cache, kept = tmp_path / "cache", tmp_path / "kept"
    (CACHE / "engine").mkdir(parents=True, exist_ok=True)
    cache.mkdir()
    (cache / "engine").symlink_to(CACHE / "engine")  # compiled kernels, no executed page
    given = {"LESSON": "l02", "BACKEND": "cpu", "TO": str(kept)}
    process = tiny_book.start("evidence.py", tmp_path, "--book", str(BOOK), **given)
    out, err = process.communicate()
    assert process.returncode == 0, err
    place = kept / "l02" / "cpu"
    facts = verify_bundle(place).predicate
    assert [path.name for path in kept.iterdir()] == ["l02"]
    assert facts.command == "make evidence"
    assert facts.render.mode == "camera"
    assert facts.evidence_key == evidence_key(facts.model_dump())
    row = f"recorded  {len(facts.checks)} of {len(facts.checks)}"
    assert row in out
