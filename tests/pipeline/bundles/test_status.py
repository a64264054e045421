import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from bundles import QUADRANTS
from spoilers import (
    SPOILED,
    both,
    drop_case,
    last_bit,
    log,
    manifest,
    measured_elsewhere,
    older_compiler,
    on,
    own_run_id,
    part,
    predicate,
    rewrite,
    seal,
)

from robo_genesis.core import project
from robo_genesis.pipeline.bundles.status import (
    UNREADABLE,
    bundle_status,
    recorded_folders,
    recorded_status,
    refused_records,
)


def test_a_sound_bundle_is_verified(folder):
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.reason) == ("verified", "")
    assert status.sentence.startswith("Lab run by hand, Genesis ")
    assert (
        "14 of 14 checks passed, camera frames by llvmpipe, measured 20"
        in status.sentence
    )


def test_a_build_without_a_camera_says_clean_kernel_and_skip(
    recorder, experiment, monkeypatch
):
    monkeypatch.setenv("ROBO_GENESIS_COMMAND", "make book")
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(experiment, frames={}, rendered=False), None)
    sentence = bundle_status(written).sentence
    assert "clean notebook kernel" in sentence
    assert "camera SKIP" in sentence


OLD_ENGINE = f"Genesis 1.2.0; this site uses {project.engine_pin()}."
OLD_COMPILER = f"Quadrants 1.2.9; this site uses {QUADRANTS}."
STATES = [
    ("missing", None, shutil.rmtree, ""),
    ("stale", "stale", older_compiler, OLD_COMPILER),
    ("stale", "stale", SPOILED["an older engine"][2], OLD_ENGINE),
    ("stale", "stale", part("source", page="0" * 64), "The lab's code changed since."),
    (
        "stale",
        "stale",
        SPOILED["another module"][2],
        "The course's code changed since.",
    ),
    (
        "stale",
        "older-schema",
        SPOILED["an older schema"][2],
        "It was recorded in an older form of the bundle.",
    ),
    (
        "failed",
        "failed",
        SPOILED["a link too many, and it says so"][2],
        "did not all pass.",
    ),
    ("refused", "files", SPOILED["no log"][2], UNREADABLE),
    # A bundle cannot set its own state.
    ("refused", "bad-schema", predicate(state="verified"), UNREADABLE),
    ("refused", "bad-schema", manifest(lambda m: m.update(badge="verified")), ""),
]
spoil_stale = both(STATES[1][2], seal)


@pytest.mark.parametrize(("state", "code", "spoil", "summary"), STATES)
def test_each_state_comes_from_the_bundle_alone(folder, state, code, spoil, summary):
    spoil(folder)
    if folder.exists():
        seal(folder)
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.badge, status.code) == (state, f"cpu-{state}", code)
    assert status.manifest is None
    assert status.sentence == (status.summary or status.reason) != ""
    assert status.summary.endswith(summary)


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


def test_a_build_continues_with_what_is_sound_and_stops_at_the_rest(
    book, courses_pages
):
    cpu = book / "evidence" / "l04" / "cpu"
    for spoil, state in ((seal, "verified"), (spoil_stale, "stale")):
        spoil(cpu)
        assert recorded_status(book, "l04", "cpu").state == state
        assert refused_records(book, {}) == []
    (cpu / "log.txt").unlink()
    (cpu.parent / "amdgpu").write_text("no bundle")
    file, folder = refused_records(book, {})
    assert file.startswith(
        "evidence/l04/amdgpu: the recorded bundle is refused: missing-file:"
    )
    assert folder.startswith(
        "evidence/l04/cpu: the recorded bundle is refused: files: "
    )


def test_the_folder_of_another_lesson_and_a_link_are_refused(book, courses_pages):
    lessons = book / "evidence"
    (lessons / "l04").rename(lessons / "l05")
    assert "lesson is l04, expected l05" in recorded_status(book, "l05", "cpu").reason
    (lessons / "l04").symlink_to(lessons / "l05")
    status = recorded_status(book, "l04", "cpu")
    assert (status.state, status.code, status.manifest) == ("refused", "path", None)
    assert "evidence/l04 is a link" in status.reason


def test_a_bundle_without_the_claims_is_inconclusive(
    book, courses_pages, undecided, experiment
):
    status = recorded_status(book, "l04", "cpu")
    assert (status.state, status.badge) == ("inconclusive", "cpu-inconclusive")
    assert status.manifest is not None
    speeds = ((case, experiment.metrics[case].peak_speed) for case in ("G1", "G2"))
    values = ", ".join(f"{case} {speed:.6g} rad/s" for case, speed in speeds)
    claim = f"peak_speed higher in G2 than in G1 is within the margin ({values})"
    assert claim in status.reason
    assert "overshoot higher in G2 than in G1" in status.reason
    assert "rise_time no later in G2" not in status.reason
    assert status.summary in status.sentence
    assert refused_records(book, {}) == []


importer = "(MJCF) Approximating tendon."
IMPORTED = both(
    log("Approximating tendon.", importer), predicate(warnings=[importer]), seal
)


@pytest.mark.parametrize(
    ("spoil", "code", "said"),
    [
        (lambda f: None, "copy", "a run on the CPU has its run_id 01234567"),
        (own_run_id, "copy", "all its arrays of baseline, G1, G2, G3, expected"),
        (
            both(own_run_id, rewrite(internal_force=last_bit)),
            "copy",
            "arrays of baseline, G2, G3",
        ),
        (
            measured_elsewhere,
            "log",
            "missing warnings of the model importer is (MJCF) Approx",
        ),
        (both(measured_elsewhere, IMPORTED), None, ""),
    ],
)
@pytest.mark.parametrize("where", ["recorded", "built"])
def test_an_accelerator_s_run_is_its_own(
    folder, tmp_path, courses_pages, spoil, code, said, where
):
    lesson = tmp_path / "book" / "evidence" / "l04"
    here = Path(shutil.copytree(folder, lesson / "cpu"))
    spoil(here)
    here = on("amdgpu")(here)
    IMPORTED(folder)
    lab = (
        Path(shutil.copytree(folder, lesson / "cpu")) if where == "recorded" else folder
    )
    labs = {"l04": lab if where == "built" else None}
    status = recorded_status(tmp_path / "book", "l04", "amdgpu", labs=labs)
    assert (status.state, status.code) == ("refused" if code else "verified", code)
    assert said in status.reason
    refused = refused_records(tmp_path / "book", {"l04": lab})
    assert len(refused) == (1 if code else 0)


OTHERS = [
    drop_case,
    both(part("engine", version="1.2.0"), seal),
    lambda f: shutil.rmtree(f),
]


@pytest.mark.parametrize("spoil", OTHERS)
def test_a_run_on_the_cpu_that_cannot_be_compared_is_ignored(folder, tmp_path, spoil):
    here = on("amdgpu")(Path(shutil.copytree(folder, tmp_path / "other" / "cpu")))
    assert bundle_status(here, cpu_runs=[folder]).code == "copy"
    spoil(folder)
    assert bundle_status(here, cpu_runs=[folder]).state == "verified"
