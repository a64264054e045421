import shutil
from dataclasses import replace

import pytest
from spoilers import failing, on, part, predicate, seal

from robo_genesis import project
from robo_genesis.evidence.status import (
    bundle_status,
    page_status,
    recorded_folders,
    recorded_status,
    refused_records,
)


@pytest.fixture
def outputs(folder):
    return folder.parents[2]


def test_a_sound_bundle_is_verified(outputs):
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.reason) == ("verified", "")
    assert status.sentence.startswith("cpu: verified. Run by hand, Genesis ")
    assert "12 of 12 checks passed, camera frames by llvmpipe, measured 20" in status.sentence


def test_a_run_by_the_build_is_called_a_clean_kernel(recorder, measured, monkeypatch):
    monkeypatch.setenv("ROBO_GENESIS_COMMAND", "make book")
    written = recorder.write(measured)
    assert "Clean kernel" in page_status(written.parents[2], "l04", "lab", "cpu").sentence


def test_another_backend_s_evidence_is_missing_until_it_is_recorded(
    folder, tmp_path, courses_pages
):
    status = recorded_status(tmp_path, "l04", "amdgpu")
    assert (status.state, status.backend) == ("missing", "amdgpu")
    assert f"recorded for Genesis {project.engine_pin()}." in status.sentence
    shutil.copytree(folder, tmp_path / "evidence" / "l04" / "cpu")
    assert recorded_status(tmp_path, "l04", "cpu").state == "verified"


def test_no_bundle_is_missing(outputs):
    status = page_status(outputs, "l04", "lab", "amdgpu")
    assert (status.state, status.manifest) == ("missing", None)
    assert status.sentence == "amdgpu: missing. No bundle was recorded for l04/lab."


def test_a_spoiled_bundle_is_refused_with_its_reason(outputs, folder):
    (folder / "log.txt").unlink()
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.manifest, status.code) == ("refused", None, "files")
    assert status.sentence.startswith("cpu: refused. files: listed but absent: ['log.txt']")


def test_a_copy_for_another_backend_is_refused(outputs, folder):
    shutil.copytree(folder, folder.with_name("amdgpu"))
    assert page_status(outputs, "l04", "lab", "amdgpu").state == "refused"


def test_a_run_without_a_camera_says_skip(outputs, folder, recorder, measured):
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(measured, frames={}, renderer=None))
    status = page_status(written.parents[2], "l04", "lab", "cpu")
    assert "camera SKIP" in status.sentence


def spoil_stale(folder):
    part("engine", quadrants_version="1.2.9")(folder)
    seal(folder)


def spoil_failed(folder):
    failing("two joints on one DOF")(folder)
    seal(folder)


STATES = {
    "verified": lambda folder: None,
    "stale": spoil_stale,
    "failed": spoil_failed,
    "refused": lambda folder: (folder / "log.txt").unlink(),
    "missing": shutil.rmtree,
}


@pytest.mark.parametrize("state", STATES)
def test_each_state_comes_from_the_bundle_alone(folder, state):
    STATES[state](folder)
    status = bundle_status(folder, "l04", "lab")
    assert status.state == state
    assert (status.manifest is not None) == (state == "verified")
    assert bool(status.reason) == (state != "verified")


def test_an_older_form_is_stale_and_nothing_of_it_is_read(folder):
    predicate(schema_version=0, mood="good")(folder)
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.code, status.manifest) == ("stale", "older-schema", None)
    assert status.reason.endswith("schema_version is 0, expected 1. Record the bundle again.")


def test_a_newer_form_is_refused(folder):
    predicate(schema_version=2)(folder)
    assert (bundle_status(folder).state, bundle_status(folder).code) == ("refused", "schema")


def test_what_is_stale_says_found_and_expected(folder):
    spoil_stale(folder)
    reason = bundle_status(folder).reason
    assert "engine.quadrants_version is '1.2.9', expected '1.3.0'" in reason
    assert "make evidence LESSON=l04" in reason


@pytest.fixture
def book(folder, tmp_path):
    """A book with the CPU's bundle recorded, and files that are none."""
    lesson = tmp_path / "book" / "evidence" / "l04"
    shutil.copytree(folder, lesson / "cpu")
    (lesson / "notes.md").touch()
    (lesson / ".cpu.partial").mkdir()
    (lesson.parent / "recording.md").touch()
    return tmp_path / "book"


def test_recorded_bundles_are_found_and_nothing_else(book, tmp_path):
    assert recorded_folders(book) == [book / "evidence" / "l04" / "cpu"]
    assert recorded_folders(tmp_path / "nowhere") == []
    (book / "evidence" / "l04" / "cuda").symlink_to("cpu")
    assert [path.name for path in recorded_folders(book)] == ["cpu", "cuda"]


def test_a_build_goes_on_with_what_is_verified_missing_or_stale(book, courses_pages):
    assert refused_records(book) == []
    spoil_stale(book / "evidence" / "l04" / "cpu")
    assert recorded_status(book, "l04", "cpu").state == "stale"
    assert refused_records(book) == []
    predicate(schema_version=0)(book / "evidence" / "l04" / "cpu")
    assert refused_records(book) == []


def test_a_build_does_not_go_on_with_a_bundle_that_is_spoiled(book, courses_pages):
    (book / "evidence" / "l04" / "cpu" / "log.txt").unlink()
    (line,) = refused_records(book)
    assert line.startswith("evidence/l04/cpu: the recorded bundle is refused: files: ")


def test_a_bundle_stands_below_its_own_lesson_and_comes_from_the_lab(book, courses_pages):
    there = book / "evidence" / "l05"
    (book / "evidence" / "l04").rename(there)
    assert "lesson is 'l04', expected 'l05'" in recorded_status(book, "l05", "cpu").reason


def test_an_accelerator_s_bundle_is_verified(book, courses_pages):
    on("amdgpu")(book / "evidence" / "l04" / "cpu")
    assert recorded_status(book, "l04", "amdgpu").state == "verified"
    assert recorded_status(book, "l04", "cpu").state == "missing"
