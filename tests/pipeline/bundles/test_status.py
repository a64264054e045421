import shutil

import pytest
from bundles import QUADRANTS
from spoilers import SPOILED, facts, older_compiler, older_engine, seal

from robo_genesis.core import project
from robo_genesis.pipeline.bundles.status import (
    UNREADABLE,
    bundle_status,
    recorded_status,
    refused_records,
)


def test_a_sound_bundle_is_verified(folder):
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.reason) == ("verified", "")
    assert status.sentence.startswith("Lab run by hand, Genesis ")
    assert "checks passed, camera frames by llvmpipe, measured 20" in status.sentence


OLD_ENGINE = f"Genesis 1.2.0; this site uses {project.engine_pin()}."
OLD_COMPILER = f"Quadrants 1.2.9; this site uses {QUADRANTS}."
STATES = [
    ("missing", None, shutil.rmtree, ""),
    ("stale", "stale", older_compiler, OLD_COMPILER),
    ("stale", "stale", older_engine, OLD_ENGINE),
    ("stale", "stale", SPOILED["no page digest"][1], "The page's code changed since."),
    (
        "stale",
        "stale",
        SPOILED["another module"][1],
        "The course's code changed since.",
    ),
    (
        "stale",
        "older-schema",
        SPOILED["an earlier form"][1],
        "It was recorded in an older form of the bundle.",
    ),
    ("failed", "failed", SPOILED["a failed check"][1], "did not all pass."),
    ("refused", "files", SPOILED["no log"][1], UNREADABLE),
    # A bundle cannot set its own state.
    ("refused", "bad-schema", facts(state="verified"), UNREADABLE),
]


@pytest.mark.parametrize(("state", "code", "spoil", "summary"), STATES)
def test_each_state_comes_from_the_bundle_alone(folder, state, code, spoil, summary):
    spoil(folder)
    status = bundle_status(folder, "l04", "lab")
    assert (status.state, status.badge) == (state, f"cpu-{state}")
    assert status.reason.startswith(code or "")
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


def test_a_build_continues_with_what_is_sound_and_stops_at_the_rest(
    book, courses_pages
):
    cpu = book / "evidence" / "l04" / "cpu"
    for spoil, state in ((seal, "verified"), (older_compiler, "stale")):
        spoil(cpu)
        assert recorded_status(book, "l04", "cpu").state == state
        assert refused_records(book) == []
    (cpu / "log.txt").unlink()
    (folder,) = refused_records(book)
    assert folder.startswith(
        "evidence/l04/cpu: the recorded bundle is refused: files: "
    )


def test_the_folder_of_another_lesson_is_refused(book, courses_pages):
    lessons = book / "evidence"
    (lessons / "l04").rename(lessons / "l05")
    assert "lesson is l04, expected l05" in recorded_status(book, "l05", "cpu").reason


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
    assert refused_records(book) == []
