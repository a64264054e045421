import shutil
from dataclasses import replace

import pytest
from bundles import QUADRANTS
from spoilers import (
    both,
    failing,
    log,
    manifest,
    measured_again,
    off_law,
    on,
    part,
    predicate,
    rewrite,
    seal,
)

from robo_genesis.core import project
from robo_genesis.evidence.status import (
    UNREADABLE,
    bundle_status,
    page_status,
    recorded_folders,
    recorded_status,
    refused_records,
)
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04.checks import StepExperiment, run_checks
from robo_genesis.lessons.l04.metrics import measure, metric_records


@pytest.fixture
def outputs(folder):
    return folder.parents[2]


def test_a_sound_bundle_is_verified(outputs):
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.reason) == ("verified", "")
    assert status.sentence.startswith("Lab run by hand, Genesis ")
    assert "12 of 12 checks passed, camera frames by llvmpipe, measured 20" in status.sentence


def test_a_build_without_a_camera_says_clean_kernel_and_skip(recorder, measured, monkeypatch):
    monkeypatch.setenv("ROBO_GENESIS_COMMAND", "make book")
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(measured, frames={}, renderer=None))
    sentence = page_status(written.parents[2], "l04", "lab", "cpu").sentence
    assert "clean notebook kernel" in sentence
    assert "camera SKIP" in sentence


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
    assert (status.state, status.manifest, status.badge) == ("missing", None, "amdgpu-missing")
    assert status.sentence == "No bundle was recorded for l04/lab."


def test_a_spoiled_bundle_is_refused_with_its_reason(outputs, folder):
    (folder / "log.txt").unlink()
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.manifest, status.code) == ("refused", None, "files")
    assert status.reason.startswith("files: listed but absent: ['log.txt']")
    assert "make verify" in status.sentence


def spoil_stale(folder):
    part("engine", quadrants_version="1.2.9")(folder)
    seal(folder)


OLD_ENGINE = f"Quadrants 1.2.9; this site uses {QUADRANTS}."
OLD_FORM = "It was recorded in an older form of the bundle."
STATES = [
    ("missing", None, shutil.rmtree, ""),
    ("stale", "stale", spoil_stale, OLD_ENGINE),
    ("stale", "older-schema", predicate(schema_version=0, mood="good"), OLD_FORM),
    ("failed", "failed", both(failing("two joints on one DOF"), seal), "did not all pass."),
    ("refused", "files", lambda folder: (folder / "log.txt").unlink(), UNREADABLE),
    ("refused", "schema", predicate(schema_version=2), UNREADABLE),
    # A bundle cannot set its own state.
    ("refused", "bad-schema", both(predicate(state="verified"), seal), UNREADABLE),
    ("refused", "bad-schema", both(manifest(lambda m: m.update(badge="verified")), seal), ""),
    ("refused", "checks", both(rewrite(control_force=off_law), measured_again, seal), ""),
]


@pytest.mark.parametrize(("state", "code", "spoil", "summary"), STATES)
def test_each_state_comes_from_the_bundle_alone(folder, state, code, spoil, summary):
    spoil(folder)
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.badge, status.code) == (state, f"cpu-{state}", code)
    assert status.manifest is None
    assert status.reason
    assert status.summary.endswith(summary)


def test_the_reason_of_stale_says_found_and_expected(folder):
    spoil_stale(folder)
    reason = bundle_status(folder).reason
    assert f"engine.quadrants_version is '1.2.9', expected '{QUADRANTS}'" in reason
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
    (book / "evidence" / "l04" / "amdgpu").write_text("no bundle")
    (book / "evidence" / "l04" / "amdgpu.sigstore.json").write_text("{}")
    assert [path.name for path in recorded_folders(book)] == ["amdgpu", "cpu", "cuda"]


def test_a_build_continues_with_what_is_verified_or_stale(book, courses_pages):
    assert refused_records(book) == []
    spoil_stale(book / "evidence" / "l04" / "cpu")
    assert recorded_status(book, "l04", "cpu").state == "stale"
    assert refused_records(book) == []


def test_a_build_stops_at_a_spoiled_bundle_or_a_file_in_its_place(book, courses_pages):
    (book / "evidence" / "l04" / "cpu" / "log.txt").unlink()
    (book / "evidence" / "l04" / "amdgpu").write_text("no bundle")
    file, folder = refused_records(book)
    assert file.startswith("evidence/l04/amdgpu: the recorded bundle is refused: missing-file:")
    assert folder.startswith("evidence/l04/cpu: the recorded bundle is refused: files: ")


def test_a_bundle_in_the_folder_of_another_lesson_is_refused(book, courses_pages):
    (book / "evidence" / "l04").rename(book / "evidence" / "l05")
    assert "lesson is 'l04', expected 'l05'" in recorded_status(book, "l05", "cpu").reason


def test_an_accelerator_s_bundle_is_verified(book, courses_pages):
    on("amdgpu")(book / "evidence" / "l04" / "cpu")
    assert recorded_status(book, "l04", "amdgpu").state == "verified"
    assert recorded_status(book, "l04", "cpu").state == "missing"


@pytest.fixture
def undecided(recorder, measured, experiment, make_run):
    """A sound bundle whose G2 responds as G1 does, with G2's own controller."""
    traces = experiment.traces | {"G2": make_run("G2", 20.0, 0.8)}
    metrics = measure(traces, l04.CASES, experiment.joints.entry(l04.STEPPED_JOINT))
    again = StepExperiment(
        experiment.joints, experiment.model, l04.CASES, traces, metrics, "camera", experiment.frames
    )
    records = metric_records(metrics, experiment.model)
    outcomes = run_checks(again)
    assert all(check.passed for check in outcomes)
    return recorder.write(
        replace(measured, traces=traces, metrics=records, checks=outcomes)
    ), metrics


def test_a_sound_bundle_that_does_not_show_the_claims_is_inconclusive(undecided):
    folder, metrics = undecided
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.badge) == ("inconclusive", "cpu-inconclusive")
    assert status.manifest is not None
    values = ", ".join(f"{case} {metrics[case].peak_speed:.6g} rad/s" for case in ("G1", "G2"))
    claim = f"peak_speed higher in G2 than in G1 is within the margin ({values})"
    assert claim in status.reason
    assert "overshoot higher in G2 than in G1" in status.reason
    assert "rise_time no later in G2" not in status.reason
    assert status.summary in status.sentence


def test_a_build_continues_with_what_is_inconclusive(undecided, tmp_path, courses_pages):
    folder, _ = undecided
    shutil.copytree(folder, tmp_path / "book" / "evidence" / "l04" / "cpu")
    assert recorded_status(tmp_path / "book", "l04", "cpu").state == "inconclusive"
    assert refused_records(tmp_path / "book") == []


@pytest.mark.parametrize(
    ("change", "summary"),
    [
        (both(part("engine", version="1.2.0"), log("version: ", "version: 1.2.0, was: ")),
         f"Genesis 1.2.0; this site uses {project.engine_pin()}."),
        (part("source", page="0" * 64), "The lab's code changed since."),
        (manifest(lambda m: m["predicate"]["source"]["modules"].update(metrics="0" * 64)),
         "The course's code changed since."),
    ],
)  # fmt: skip
def test_the_summary_of_stale_names_what_changed(folder, change, summary):
    both(change, seal)(folder)
    status = bundle_status(folder)
    assert status.state == "stale"
    assert status.summary.endswith(summary)
    assert status.summary not in status.reason


def test_a_lesson_s_folder_that_is_a_link_is_refused(folder, tmp_path, courses_pages):
    elsewhere = tmp_path / "elsewhere" / "l04"
    shutil.copytree(folder, elsewhere / "cpu")
    (tmp_path / "evidence").mkdir()
    (tmp_path / "evidence" / "l04").symlink_to(elsewhere)
    status = recorded_status(tmp_path, "l04", "cpu")
    assert (status.state, status.code, status.manifest) == ("refused", "path", None)
    assert "evidence/l04 is a link" in status.reason
    assert len(refused_records(tmp_path)) == 1
