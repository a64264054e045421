"""Recording labs: what is run, kept, refused and printed, with tiny books and made-up probes."""

import json
import re
import shutil
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
from spoilers import both, older_compiler, on, seal
from tiny_book import accept, cell, lab, make_book, notebook, old_bundle, refuse

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.recording import labs as recording
from robo_genesis.pipeline.recording.labs import Recording, record
from robo_genesis.pipeline.stages import build_lock
from robo_genesis.sim.diagnosis import StepResult


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
    book, said = make_book(folder, lab=page), list[str]()
    values = {"lesson": "l04", "verify": accept, "probe": PROBED, "say": said.append}
    values |= {"to": folder / "kept"} | settings
    status = record(
        Recording(book=book, cache=folder / "cache", expected=expected, **values)
    )
    return status, "\n".join(said)


def test_the_lab_is_recorded_anew_each_time_under_the_name_of_its_backend(
    tmp_path, monkeypatch
):
    for name, value in (
        ("BACKEND", "cpu"),
        ("RENDER", "0"),
    ):  # a user's, which no recording heeds
        monkeypatch.setenv(f"ROBO_GENESIS_{name}", value)
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
    assert "It names no commit, or a tree with changes" in said


def test_the_cpu_is_recorded_without_a_probe_and_by_default_in_the_book(tmp_path):
    assert run(tmp_path, lab("cpu"), "cpu", to=None, probe=None)[0] == 0
    assert (tmp_path / "book/evidence/l04/cpu/manifest.json").is_file()


@pytest.mark.parametrize(
    ("expected", "actual", "said"),
    [
        ("cpu", "cuda", "Expected backend: cpu; found 'cuda'"),
        (
            None,
            "cpu",
            "amdgpu or cuda; found 'cpu'.* record cpu on purpose with BACKEND=cpu",
        ),
    ],
)
def test_another_backend_than_expected_is_refused(expected, actual, said):
    with pytest.raises(ProjectError, match=said):
        recording.require_expected(Recording("l04", expected), actual)


NO_CAMERA = lab("cuda").replace('"camera" if camera', '"skip" if camera')
STOPPED = {"verify": Mock(side_effect=KeyboardInterrupt)}


@pytest.mark.parametrize(
    ("page", "settings", "reason"),
    [
        (
            lab("cuda", more="\n1 / 0"),
            {},
            "failed .*ZeroDivisionError: division by zero",
        ),
        (lab("amdgpu"), {}, "failed .*Expected backend: cuda; found 'amdgpu'"),
        (
            lab("cuda"),
            {"verify": refuse},
            "failed .*bundle of this run is refused: metrics",
        ),
        (NO_CAMERA, {}, "failed .*render.mode is skip, expected camera"),
        (lab("cuda"), STOPPED, "interrupted .*the older bundle is unchanged"),
    ],
    ids=["raises", "backend", "refused", "no camera", "stopped"],
)
def test_a_run_that_is_not_accepted_leaves_the_old_bundle(
    tmp_path, page, settings, reason
):
    old = old_bundle(tmp_path, "cuda")
    status, said = run(tmp_path, page, "cuda", **settings)
    assert status == (130 if settings is STOPPED else 1)
    assert re.search(f"^l04  cuda  {reason}", said, re.MULTILINE), said
    assert ("lab, code cell 1, line " in said) == ("Zero" in reason)
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
FOUND += [StepResult("torch", "warning", "c")]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (
            {"lesson": "l05"},
            r"^LESSON='l05' is not valid\. Lessons with a lab: l04; unset, all\.",
        ),
        ({"root": Path()}, r"Installed is genesis-world \S+, the course needs 0\.0\.1"),
        ({"probe": finds("cuda", *FOUND)}, r"^Broken: devices, kernel\. The lines"),
    ],
)
def test_what_cannot_be_recorded_is_refused_before_the_run(
    tmp_path, monkeypatch, settings, said
):
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    Path("pyproject.toml").write_text(
        '[project]\ndependencies = ["genesis-world==0.0.1"]\n'
    )
    lines: list[str] = []
    with pytest.raises(ProjectError, match=said):
        run(tmp_path, lab("cuda"), say=lines.append, **settings)
    probed = [
        r"probe devices broken a\nb",
        r"probe kernel broken a\nb",
        "probe torch warning c",
    ]
    found = [" ".join(line.split("] ")[1].split()) for line in lines]
    assert found == (probed if "probe" in settings else [])


def test_a_recording_beside_a_build_is_refused(tmp_path):
    with (
        build_lock(tmp_path / "cache"),
        pytest.raises(ProjectError, match="Another build"),
    ):
        run(tmp_path, lab("cuda"))


def test_the_next_command_brings_back_what_a_kill_left_aside(tmp_path):
    old = old_bundle(tmp_path, "cuda")
    old.parent.rename(old.parents[1] / ".cuda.old")
    with pytest.raises(ProjectError):
        run(tmp_path, lab("cuda"), lesson="l05")
    assert old.read_text() == "old"


MANIFEST = SimpleNamespace(
    backend=SimpleNamespace(device_name="a GPU\x1b[1m"),
    checks=[SimpleNamespace(passed=True), SimpleNamespace(passed=False)],
    git=SimpleNamespace(commit="0123456789abcdef", dirty=False),
)


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
    book, kept = (
        make_book(tmp_path, plain=notebook(cell("1")), **pages),
        tmp_path / "kept",
    )

    def run_labs(expected: str | None = "amdgpu", lesson: str = "", **fails):
        ran, said = list[str](), list[str]()

        def record_lab(recording, page, progress):
            ran.append(page.lesson)
            if error := fails.get(page.lesson):
                raise error
            return kept / page.lesson / "amdgpu", MANIFEST

        monkeypatch.setattr(recording, "record_lab", record_lab)
        places = {"to": kept, "book": book, "cache": tmp_path / "cache"}
        asked = Recording(lesson, expected, **places, probe=PROBED, say=said.append)
        return record(asked), ran, [line for text in said for line in text.split("\n")]

    return run_labs


@pytest.fixture
def recorded(folder, tmp_path):
    """Put a bundle of L04 that an accelerator left into the folder of recorded bundles."""

    def put(spoil=seal, backend="amdgpu"):
        there = on(backend)(folder)
        spoil(there)
        return shutil.copytree(there, tmp_path / "kept" / "l04" / backend)

    return put


def test_all_labs_are_recorded_in_the_order_of_the_book(labs, tmp_path):
    status, ran, said = labs()
    assert (status, ran) == (0, ["l02", "l03", "l04"])
    kept = tmp_path / "kept"
    row = rf"l03  amdgpu  recorded     {kept}/l03/amdgpu  1 of 2 checks, a GPU\x1b[1m"
    assert said[-3] == row
    assert f"look at both pictures in {kept}/*/amdgpu/frames, read log.txt" in said[-1]


@pytest.mark.parametrize(
    ("error", "status", "row"),
    [
        (ProjectError("E: no\n\nlab, cell 1"), 1, "failed       E: no"),
        (OSError(28, "No space left"), 1, "failed       [Errno 28] No space left"),
        (KeyboardInterrupt(), 130, "interrupted  the older bundle is unchanged"),
    ],
)
def test_a_failure_is_reported_at_once_and_only_ctrl_c_ends_the_command(
    labs, error, status, row
):
    result, ran, said = labs(l03=error)
    assert (result, ran) == (status, ["l02", "l03", *["l04"] * (status == 1)])
    assert f"l03  amdgpu  {row}" in said
    for line in str(error).splitlines()[-1:]:
        assert line in said


def test_an_accepted_bundle_is_kept_unless_its_lesson_is_given(labs, recorded):
    place = recorded()
    status, ran, said = labs()
    assert (status, ran) == (0, ["l02", "l03"])
    assert any("amdgpu-verified; LESSON=l04 records it again" in line for line in said)
    assert any(line.startswith(f"l04  amdgpu  kept         {place}") for line in said)
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
