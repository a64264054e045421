"""`make evidence`: exit status, what is printed, and the real lab on the CPU."""

import pytest
import tiny_book

from robo_genesis.core.project import BOOK, CACHE
from robo_genesis.evidence.bundle import evidence_key
from robo_genesis.pipeline.bundles.verify import verify_bundle


def test_a_recording_without_a_camera_is_refused(tmp_path):
    report = tiny_book.fails("evidence.py", tmp_path, RENDER="0")
    assert (
        "RENDER='0' is not valid for a recording, which always has camera fr" in report
    )


def test_a_lesson_without_a_lab_is_status_1(tmp_path):
    tiny_book.make_book(tmp_path, text="# Text\n")
    given = {"LESSON": "l09", "BACKEND": "cpu", "TO": str(tmp_path / "kept")}
    assert "LESSON='l09' is not valid" in tiny_book.fails(
        "evidence.py", tmp_path, **given
    )


@pytest.mark.engine
def test_the_real_lab_recorded_on_the_cpu_is_accepted_evidence(tmp_path):
    cache, kept = tmp_path / "cache", tmp_path / "kept"
    (CACHE / "engine").mkdir(parents=True, exist_ok=True)
    cache.mkdir()
    (cache / "engine").symlink_to(
        CACHE / "engine"
    )  # compiled kernels, no executed page
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
