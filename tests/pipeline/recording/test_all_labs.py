"""All labs in one command: what runs, what is kept, the table and the exit status."""

import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest
from spoilers import both, on, own_run_id, part, seal
from tiny_book import accept, cell, lab, make_book, notebook

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.recording.all_labs import record_all
from robo_genesis.pipeline.recording.one_lab import Recording, RecordingError
from robo_genesis.sim.diagnosis import Finding

GIT = SimpleNamespace(commit="0123456789abcdef", dirty=False)
FACTS = SimpleNamespace(
    backend=SimpleNamespace(device_name="a GPU\x1b[1m"),
    checks=[SimpleNamespace(passed=True), SimpleNamespace(passed=False)],
    git=GIT,
)


class Runner:
    """Records labs by their names in a moment, or fails as a test says."""

    def __init__(self, to: Path, **fails: BaseException) -> None:
        self.to, self.fails, self.ran = to, fails, list[str]()

    def __call__(self, recording, page, progress):
        self.ran.append(recording.lesson)
        assert recording.lesson == page.lesson
        if error := self.fails.get(recording.lesson):
            raise error
        return self.to / recording.lesson / "amdgpu", FACTS


@pytest.fixture
def labs(tmp_path, courses_pages):
    """A book with three labs, and what is said about recording them."""
    front = "robo_genesis: {{lesson: {}, page: lab}}\n"
    pages = {name: notebook(cell("1"), front=front.format(name)) for name in ("l02", "l03", "l04")}
    book, said = make_book(tmp_path, plain=notebook(cell("1")), **pages), list[str]()

    def record(expected: str | None = "amdgpu", probe=None, **fails):
        runner, kept = Runner(tmp_path / "kept", **fails), tmp_path / "kept"
        found = [Finding("torch", "ok", "2.13.0")]
        recording = Recording(
            lesson="",
            expected=expected,
            to=kept,
            book=book,
            cache=tmp_path / "cache",
            probe=probe or (lambda expected: (expected or "amdgpu", found)),
            say=said.append,
        )
        return record_all(recording, runner), runner.ran, said

    return record


@pytest.fixture
def recorded(folder, tmp_path):
    """Put a bundle of L04 that an accelerator left into the folder of recorded bundles."""

    def put(spoil=seal, backend="amdgpu"):
        there = on(backend)(folder)
        spoil(there)
        return shutil.copytree(there, tmp_path / "kept" / "l04" / backend)

    return put


def last(said: list[str]) -> list[str]:
    """Return the table and what follows it, with one space between the columns."""
    (head,) = (n for n, line in enumerate(said) if line.startswith("lab "))
    return [" ".join(line.split()) for line in said[head:]]


def test_all_labs_are_recorded_in_the_order_of_the_book(labs, tmp_path):
    status, ran, said = labs()
    assert (status, ran) == (0, ["l02", "l03", "l04"])
    kept = tmp_path / "kept"
    assert last(said) == [
        "lab backend device state checks seconds place or reason",
        *(
            rf"{name} amdgpu a GPU\x1b[1m recorded 1 of 2 0 {kept}/{name}/amdgpu"
            for name in ("l02", "l03", "l04")
        ),
        "Checkout: clean, commit 0123456789ab",
        f"Before you commit: look at both pictures in {kept}/*/amdgpu/frames, read log.txt, and "
        "check that manifest.json names nothing private of your machine.",
    ]


@pytest.mark.parametrize(
    ("error", "reason", "report"),
    [
        (RecordingError("1 of 1 pages failed.\n\nlab, cell 1", "E: no\nmore"), "E: no", "lab, ce"),
        (RecordingError("Refused.\nBecause."), "Refused.", "Because."),
        (ProjectError("No place.\nMove it."), "No place.", "Move it."),
        (OSError(28, "No space left"), "[Errno 28] No space left", "No space left"),
    ],
)
def test_a_failure_is_reported_at_once_and_the_next_lab_follows(labs, error, reason, report):
    status, ran, said = labs(l02=error)
    assert (status, ran) == (1, ["l02", "l03", "l04"])
    assert last(said)[1:3] == [f"l02 amdgpu – failed – 0 {reason}", last(said)[2]]
    assert " recorded " in last(said)[2]
    assert report in next(line for line in said if line.startswith("\n"))


def test_the_second_call_runs_only_what_is_not_accepted(labs, recorded):
    place = recorded()
    run = json.loads((place / "manifest.json").read_text())["predicate"]
    status, ran, said = labs(l03=RecordingError("no"))
    assert (status, ran) == (1, ["l02", "l03"])
    (line,) = (line.split("] ")[1] for line in said if "] keep" in line)
    assert (
        line
        == f"keep     l04  amdgpu-verified, run {run['run_id'][:8]}; LESSON=l04 records it again"
    )
    assert last(said)[3] == f"l04 amdgpu a GPU kept 12 of 12 – {place}"


STALE = both(part("engine", quadrants_version="1.2.9"), seal)


@pytest.mark.parametrize(
    ("spoil", "accelerator"),
    [
        (STALE, "amdgpu"),
        (both(part("source", page="0" * 64), seal), "amdgpu"),
        (lambda folder: (folder / "log.txt").unlink(), "amdgpu"),
        (seal, "cuda"),
    ],
    ids=["another engine", "another page", "damaged", "another backend"],
)
def test_a_bundle_that_is_not_accepted_for_this_backend_is_recorded_again(
    labs, recorded, spoil, accelerator
):
    recorded(spoil, accelerator)
    assert labs()[1] == ["l02", "l03", "l04"]


def test_a_copy_of_the_cpu_s_run_is_recorded_again(labs, recorded, folder, tmp_path):
    shutil.copytree(folder, tmp_path / "kept" / "l04" / "cpu")
    recorded(both(own_run_id, seal))
    assert labs()[1] == ["l02", "l03", "l04"]


@pytest.mark.parametrize(
    ("changed", "ran"), [(False, ["l02", "l03", "l04"]), (True, ["l02", "l03"])]
)
def test_a_run_of_changed_sources_is_recorded_again_from_a_commit(
    labs, recorded, monkeypatch, changed, ran
):
    now = {"commit": "0" * 40, "dirty": changed}
    monkeypatch.setattr("robo_genesis.pipeline.recording.all_labs.git_record", lambda: now)
    recorded(both(part("git", dirty=True), seal))
    assert labs()[1] == ran


def test_an_accepted_run_that_does_not_show_the_claims_is_kept(labs, recorded, undecided):
    recorded()
    _, ran, said = labs()
    assert ran == ["l02", "l03"]
    assert any("amdgpu-inconclusive" in line for line in said)


def test_without_a_name_the_backend_that_the_probe_finds_is_resumed(labs, recorded):
    recorded(backend="cuda")
    ran = labs(None, lambda expected: ("cuda", [Finding("torch", "ok", "2.13.0")]))[1]
    assert ran == ["l02", "l03"]


def test_an_interruption_ends_the_command_after_the_table(labs):
    status, ran, said = labs(l03=KeyboardInterrupt())
    assert (status, ran) == (130, ["l02", "l03"])
    assert last(said)[2:4] == [
        "l03 amdgpu – interrupted – 0 the older bundle is unchanged",
        "l04 amdgpu – not run – –",
    ]


@pytest.mark.parametrize(
    ("expected", "probe", "said"),
    [
        ("rocm", None, "BACKEND='rocm' is not valid"),
        ("amdgpu", lambda e: ("cpu", [Finding("devices", "broken", "none")]), "Broken: devices"),
    ],
)
def test_nothing_runs_on_a_machine_that_is_not_ready(labs, expected, probe, said):
    with pytest.raises(RecordingError, match=said):
        labs(expected, probe)


def test_a_lab_is_really_run_and_kept_whole(tmp_path):
    said: list[str] = []
    book = make_book(tmp_path, lab=lab("cpu"), more=lab("cpu", "\n1 / 0").replace("l04", "l03"))
    places = {"to": tmp_path / "kept", "book": book, "cache": tmp_path / "cache"}
    assert record_all(Recording("", "cpu", **places, verify=accept, say=said.append)) == 1
    place = tmp_path / "kept" / "l04" / "cpu"
    assert sorted(path.name for path in place.iterdir()) == ["log.txt", "manifest.json"]
    assert [path.name for path in (tmp_path / "kept").iterdir()] == ["l04"]
    rows = last(said)
    assert rows[1].startswith("l04 cpu a device recorded 2 of 2 ")
    assert rows[2].endswith(" ZeroDivisionError: division by zero")
    assert any("more, code cell 1, line " in line for line in said)
