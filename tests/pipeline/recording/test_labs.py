"""Recording labs: what is run, kept, refused and printed, with tiny books and made-up probes."""

import json
import re
import shutil
from pathlib import Path

import pytest
from spoilers import both, older_compiler, on, seal
from tiny_book import accept, cell, lab, make_book, notebook, old_bundle, refuse

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.recording import labs as recording
from robo_genesis.pipeline.recording.labs import Recording, record
from robo_genesis.pipeline.stages import Build
from robo_genesis.sim.diagnosis import StepResult


@pytest.fixture(autouse=True)
def contract(monkeypatch):
    """A user's variables, which no recording heeds."""
    for name, value in (("BACKEND", "cpu"), ("RENDER", "0")):
        monkeypatch.setenv(f"ROBO_GENESIS_{name}", value)


def finds(backend: str | None = None, *steps: StepResult):
    """Return a probe that finds this backend, by default the expected one or cuda."""
    steps = steps or (StepResult("torch", "ok", "2.13.0"),)
    return lambda expected: (backend or expected or "cuda", [*steps])


PROBED = finds()


def run(
    folder: Path, page: str, expected: str | None = None, **settings
) -> tuple[int, str]:
    """Record the tiny book's lab into `folder/kept`, and return exit status and what was said.

    Torch sees what the test says.
    """
    said = settings.pop("said", list[str]())
    how = {"lesson": "l04", "evidence": folder / "kept", "probe": PROBED}
    how |= {name: settings.pop(name) for name in how.keys() & settings.keys()}
    settings = {"verify": accept, "say": said.append, **settings}
    places = {"book": make_book(folder, lab=page), "cache": folder / "cache"}
    build = Build(**places, jobs=1, **settings)
    return record(Recording(expected=expected, build=build, **how)), "\n".join(said)


def test_the_lab_is_recorded_anew_each_time_under_the_name_of_its_backend(tmp_path):
    old, run_ids = old_bundle(tmp_path, "cuda"), []
    place = tmp_path / "kept/l04/cuda"
    for _ in range(2):
        status, said = run(tmp_path, lab("cuda"))
        assert status == 0
        names = {path.name for path in place.iterdir()}
        assert names == {"log.txt", "manifest.json", "printed.json"}
        assert old.read_text() == "new"
        run_ids.append(json.loads((place / "manifest.json").read_text())["run_id"])
    assert run_ids[0] != run_ids[1]
    stages = re.findall(r"^\[.*\] (\w+)", said, re.MULTILINE)
    assert list(dict.fromkeys(stages)) == ["probe", "execute", "verify", "record"]
    assert f"\nl04  recorded: {place}, 2 of 2 checks, a device" in said
    assert "It names no commit, or a tree with changes" in said


def test_the_cpu_is_recorded_without_a_probe(tmp_path):
    assert run(tmp_path, lab("cpu"), "cpu", probe=None)[0] == 0
    assert (tmp_path / "kept/l04/cpu/manifest.json").is_file()


NO_CAMERA = lab("cuda").replace('"camera" if camera', '"skip" if camera')


@pytest.mark.parametrize(
    ("page", "settings", "reason"),
    [
        (lab("cuda", more="\n1 / 0"), {}, "lab, code cell 1(?s:.*)division by zero"),
        (lab("amdgpu"), {}, "Expected backend: cuda; found 'amdgpu'"),
        (lab("cpu"), {"expected": None}, "amdgpu or cuda; found 'cpu'.*=cpu"),
        (lab("cuda"), {"verify": refuse}, "the bundle .* is refused: metrics"),
        (NO_CAMERA, {}, "render.mode is skip, expected camera"),
    ],
    ids=["raises", "backend", "no accelerator", "refused", "no camera"],
)
def test_a_run_that_is_not_accepted_leaves_the_old_bundle(
    tmp_path, page, settings, reason
):
    old = old_bundle(tmp_path, "cuda")
    status, said = run(tmp_path, page, **{"expected": "cuda"} | settings)
    assert status == 1
    assert re.search(reason, said), said
    assert old.read_text() == "old"
    assert not (tmp_path / "cache/recording").exists()
    assert [path.name for path in (tmp_path / "kept/l04").iterdir()] == ["cuda"]


def test_engine_switches_reach_the_probe_and_the_user_s_contract_does_not(monkeypatch):
    switches = {
        "GS_ENABLE_ZEROCOPY": "0",
        "ROCM_PATH": "/opt/rocm",
        "LD_LIBRARY_PATH": "/opt/hip",
    }
    own = {
        "ROBO_GENESIS_BACKEND": "cpu",
        "ROBO_GENESIS_RENDER": "0",
        "PYTORCH_CACHING": "1",
    }
    for name, value in (switches | own).items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(
        recording.accelerator, "probe", lambda machine, expected: machine
    )
    probed = recording.probe_here(None).environ
    assert probed.items() >= switches.items()
    assert not probed.keys() & own.keys()


FOUND = [StepResult(name, "broken", "a\nb") for name in ("devices", "kernel")]
FOUND += [StepResult("torch", "ok", "c")]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (
            {"lesson": "l05"},
            r"^LESSON='l05' is not valid\. Lessons with a lab: l04; unset, all\.",
        ),
        ({"probe": finds("cuda", *FOUND)}, r"^Broken: devices, kernel\. The lines"),
    ],
)
def test_what_cannot_be_recorded_is_refused_before_the_run(tmp_path, settings, said):
    lines: list[str] = []
    with pytest.raises(ProjectError, match=said):
        run(tmp_path, lab("cuda"), said=lines, **settings)
    probed = [
        r"probe devices broken a\nb",
        r"probe kernel broken a\nb",
        "probe torch ok c",
    ]
    found = [" ".join(line.split("] ")[1].split()) for line in lines]
    assert found == (probed if "probe" in settings else [])


def test_the_next_command_brings_back_what_a_kill_left_aside(tmp_path):
    old = old_bundle(tmp_path, "cuda")
    old.parent.rename(old.parents[1] / ".cuda.old")
    with pytest.raises(ProjectError):
        run(tmp_path, lab("cuda"), lesson="l05")
    assert old.read_text() == "old"


@pytest.fixture
def labs(tmp_path, courses_pages, monkeypatch):
    """Record the three labs of a book in a moment, or let some fail as a test says.

    Returns the exit status, the lessons that ran, and what was said.
    """
    front = "robo_genesis: {{lesson: {}, page: lab}}\n"
    pages = {
        name: notebook(cell("1"), front=front.format(name))
        for name in ("l02", "l03", "l04")
    }
    book = make_book(tmp_path, plain=notebook(cell("1")), **pages)

    def run_labs(expected: str | None = "amdgpu", lesson: str = "", **fails):
        ran, said = list[str](), list[str]()

        def record_lab(recording, page, into, progress):
            ran.append(page.lesson)
            if error := fails.get(page.lesson):
                raise error
            return "recorded"

        monkeypatch.setattr(recording, "_record_lab", record_lab)
        build = Build(book=book, cache=tmp_path / "cache", say=said.append)
        asked = Recording(lesson, expected, tmp_path / "kept", build, PROBED)
        return record(asked), ran, "\n".join(said)

    return run_labs


@pytest.fixture
def recorded(folder, tmp_path):
    """Put a bundle of L04 that an accelerator left into the folder of recorded bundles."""

    def put(spoil=seal, backend="amdgpu"):
        there = on(backend)(folder)
        spoil(there)
        return shutil.copytree(there, tmp_path / "kept" / "l04" / backend)

    return put


@pytest.mark.parametrize(
    ("error", "status", "states"),
    [
        (None, 0, ("recorded", "recorded", "recorded")),
        (ProjectError("E: no"), 1, ("recorded", "failed", "recorded")),
        (KeyboardInterrupt(), 130, ("recorded", "not recorded", "not recorded")),
    ],
)
def test_the_last_lines_have_the_outcome_of_each_lab(labs, error, status, states):
    found, _, said = labs(l03=error)
    assert found == status
    lines = [f"l0{k}  {state}" for k, state in enumerate(states, start=2)]
    assert said.splitlines()[-4:-1] == lines
    assert status != 1 or f"\n{error}\n" in said


def test_an_accepted_bundle_is_kept_unless_its_lesson_is_given(labs, recorded):
    recorded()
    status, ran, said = labs()
    assert (status, ran) == (0, ["l02", "l03"])
    assert "amdgpu-verified; LESSON=l04 records it again" in said
    assert labs(lesson="l04")[1] == ["l04"]


NO_LOG = both(seal, lambda place: (place / "log.txt").unlink())


@pytest.mark.parametrize(
    ("spoil", "left_by", "asked", "again"),
    [
        (both(older_compiler, seal), "amdgpu", "amdgpu", True),
        (NO_LOG, "amdgpu", "amdgpu", True),
        (seal, "cuda", "amdgpu", True),
        (seal, "cuda", None, False),
    ],
    ids=["engine", "damaged", "another backend", "backend of the probe"],
)
def test_a_bundle_that_is_not_accepted_for_this_backend_is_recorded_again(
    labs, recorded, spoil, left_by, asked, again
):
    recorded(spoil, left_by)
    assert labs(asked)[1] == ["l02", "l03", *["l04"] * again]
