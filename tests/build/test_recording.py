import json
from pathlib import Path
from types import SimpleNamespace

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.build import recording
from robo_genesis.build.recording import Recording, RecordingError, record
from robo_genesis.build.stages import BuildError, only_build
from robo_genesis.core.project import ProjectError
from robo_genesis.evidence.bundle import BundleRefused

# A lab's cell that leaves what a recording looks at, as if it had run on ACTUAL.
LAB = """\
import json, os, pathlib
asked, actual = os.environ["ROBO_GENESIS_BACKEND"], {actual!r}
folder = pathlib.Path(os.environ["ROBO_GENESIS_OUTPUTS_DIR"], "l04", "lab", actual)
folder.mkdir(parents=True)
camera = os.environ["ROBO_GENESIS_RENDER"] == "1"
facts = dict(
    run_id=os.environ["ROBO_GENESIS_RUN_ID"],
    command=os.environ["ROBO_GENESIS_COMMAND"],
    backend=dict(requested=asked, actual=actual, device_name="a device", torch_version="2.13.0"),
    engine=dict(version="1.2.3", quadrants_version="0.9"),
    render=dict(mode="camera" if camera else "skip", renderer="llvmpipe", software=True),
    checks=[dict(passed=True), dict(passed=True)],
    warnings=["Approximating tendon."],
    git={git},
)
(folder / "manifest.json").write_text(json.dumps(dict(predicate=facts)))
(folder / "log.txt").write_text("new")"""

DIRTY = '{"commit": "0123456789abcdef", "dirty": True}'
CLEAN = '{"commit": "0123456789abcdef", "dirty": False}'


def accept(folder: Path, run_id: str) -> SimpleNamespace:
    """Stand in for the verification of evidence, which needs the engine's records."""
    text = (folder / "manifest.json").read_text()
    manifest = json.loads(text, object_hook=lambda fields: SimpleNamespace(**fields))
    assert manifest.predicate.run_id == run_id
    return manifest


def refuse(folder: Path, run_id: str) -> SimpleNamespace:
    raise BundleRefused("metrics", "metrics.json g1.rise_time is not what the arrays say.")


def lab(actual: str, git: str = CLEAN, more: str = "") -> str:
    return notebook(cell(LAB.format(actual=actual, git=git) + more), front=LAB_FRONT)


def run(folder: Path, page: str, expected: str | None = None, **settings) -> list[str]:
    """Record the tiny book's lab into `folder/kept`; Torch sees what the test says."""
    book = make_book(folder, lab=page)
    settings = {
        "lesson": "l04",
        "verify": accept,
        "foresee": lambda: expected or "cuda",
        "say": lambda line: None,
        "to": folder / "kept",
    } | settings
    return record(Recording(book=book, cache=folder / "cache", expected=expected, **settings))


def old_bundle(folder: Path, backend: str) -> Path:
    """Put an older bundle in place and return a file that a refused recording must leave."""
    place = folder / "kept" / "l04" / backend
    place.mkdir(parents=True)
    (place / "manifest.json").write_text("{}")
    (place / "log.txt").write_text("old")
    (place / "of the old one.txt").touch()
    return place / "log.txt"


@pytest.mark.parametrize("backend", ["amdgpu", "cuda", "cpu"])
def test_the_backend_that_was_expected_is_recorded_under_its_own_name(tmp_path, backend):
    old = old_bundle(tmp_path, backend)
    said: list[str] = []
    last = run(tmp_path, lab(backend), backend, say=said.append)
    place = tmp_path / "kept/l04" / backend
    assert sorted(path.name for path in place.iterdir()) == ["log.txt", "manifest.json"]
    assert old.read_text() == "new"
    asked = "cpu" if backend == "cpu" else "auto"
    assert last[:2] == [
        f"Recorded: {place}",
        f"Backend: requested {asked}, actual {backend}, device a device",
    ]
    stages = list(dict.fromkeys(line.split("] ")[1].split()[0] for line in said))
    assert stages == ["probe"] * (asked == "auto") + ["execute", "verify", "record"]


def test_the_last_lines_say_engine_camera_checks_size_and_what_to_look_at(tmp_path):
    last = run(tmp_path, lab("cuda"))
    assert last[2:6] == [
        "Engine: genesis-world 1.2.3, quadrants 0.9, torch 2.13.0",
        "Camera: llvmpipe (drawn in software)",
        "Checks passed: 2 of 2. Engine warnings kept: 1.",
        "Files: 2, 0.0 MB",
    ]
    assert last[6] == "Checkout: clean, commit 0123456789ab"
    assert last[7].startswith("Before you commit: look at both pictures")


@pytest.mark.parametrize(
    ("git", "said"),
    [(DIRTY, "Checkout: changed since commit 0123456789ab"), ("None", "Checkout: no git here")],
)
def test_a_checkout_that_names_no_exact_sources_is_recorded_and_mentioned(tmp_path, git, said):
    last = run(tmp_path, lab("cuda", git))
    assert any(line.startswith(said) and "a release refuses that" in line for line in last)


def test_without_another_root_the_bundle_stands_in_the_book(tmp_path):
    run(tmp_path, lab("cuda"), to=None)
    assert (tmp_path / "book/evidence/l04/cuda/manifest.json").is_file()


@pytest.mark.parametrize(
    ("expected", "actual", "said"),
    [
        ("amdgpu", "cuda", "Expected backend: amdgpu; ROBO_GENESIS_BACKEND=auto finds 'cuda'"),
        ("cuda", "amdgpu", "record amdgpu on purpose with BACKEND=amdgpu"),
        ("amdgpu", "cpu", "record cpu on purpose with BACKEND=cpu"),
        ("cpu", "cuda", "Expected backend: cpu; ROBO_GENESIS_BACKEND=cpu finds 'cuda'"),
        (None, "cpu", "none given, so one of amdgpu, cuda; .* with BACKEND=cpu"),
        (None, "metal", "finds 'metal'. .* Check driver, device and Torch build\\."),
    ],
)
def test_another_backend_than_expected_is_refused_and_the_old_bundle_stands(
    tmp_path, expected, actual, said
):
    old = old_bundle(tmp_path, actual)
    with pytest.raises(RecordingError, match=said):
        run(tmp_path, lab(actual), expected)
    assert old.read_text() == "old"
    assert [path.name for path in (tmp_path / "kept/l04").iterdir()] == [actual]


def test_a_folder_that_names_another_backend_than_its_manifest_is_refused(tmp_path):
    relabelled = '\nfolder.rename(folder.with_name("amdgpu"))'
    with pytest.raises(RecordingError, match=r"Expected backend: amdgpu; .* finds 'cuda'"):
        run(tmp_path, lab("cuda", more=relabelled), "amdgpu")
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize(
    ("expected", "seen"), [(None, "cpu"), ("amdgpu", "cpu"), ("amdgpu", "cuda"), ("cuda", "amdgpu")]
)
def test_what_torch_already_shows_is_refused_before_the_run(tmp_path, expected, seen):
    said: list[str] = []
    with pytest.raises(RecordingError, match=f"finds '{seen}'"):
        run(tmp_path, lab(seen), expected, foresee=lambda: seen, say=said.append)
    assert [line.split("] ")[1].split()[0] for line in said] == ["probe"]


@pytest.mark.parametrize(
    ("page", "settings", "said"),
    [
        (lab("cuda", more="\n1 / 0"), {}, "ZeroDivisionError: division by zero"),
        (notebook(cell("1"), front=LAB_FRONT), {}, "BundleMissing"),
        (lab("cuda"), {"verify": refuse}, "bundle of this run is refused: metrics: metrics.json"),
        (lab("cuda").replace('"camera" if camera', '"skip" if camera'), {}, "'render.mode': 'skip"),
        (lab("cuda").replace('["ROBO_GENESIS_COMMAND"]', '["HOME"]'), {}, "'make evidence'"),
    ],
    ids=["raising cell", "no bundle", "refused bundle", "no camera", "another command"],
)
def test_a_run_that_is_not_accepted_leaves_the_old_bundle(tmp_path, page, settings, said):
    old = old_bundle(tmp_path, "cuda")
    with pytest.raises(RecordingError, match=said):
        run(tmp_path, page, **settings)
    assert old.read_text() == "old"
    assert not (tmp_path / "cache/recording").exists()


def test_an_earlier_execution_is_never_used_again(tmp_path):
    run_ids = []
    for _ in range(2):
        run(tmp_path, lab("cuda"))
        manifest = json.loads((tmp_path / "kept/l04/cuda/manifest.json").read_text())
        run_ids.append(manifest["predicate"]["run_id"])
    assert run_ids[0] != run_ids[1]


def test_engine_switches_reach_the_lab_and_the_user_s_contract_does_not(tmp_path, monkeypatch):
    monkeypatch.setenv("GS_ENABLE_ZEROCOPY", "0")
    monkeypatch.setenv("ROBO_GENESIS_BACKEND", "cpu")
    monkeypatch.setenv("ROBO_GENESIS_RENDER", "0")
    environment = recording.kernel_environment(Recording("l04", cache=tmp_path))
    assert environment["GS_ENABLE_ZEROCOPY"] == "0"
    assert environment["ROBO_GENESIS_BACKEND"] == "auto"
    assert environment["ROBO_GENESIS_RENDER"] == "1"
    assert environment["ROBO_GENESIS_COMMAND"] == "make evidence"


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"lesson": "l05"}, "LESSON='l05' is not valid. Lessons with a lab: l04."),
        ({"lesson": ""}, "LESSON='' is not valid. Lessons with a lab: l04."),
        ({"expected": "rocm"}, "BACKEND='rocm' is not valid. Choices: amdgpu, cuda, cpu;"),
        ({"expected": "auto"}, "BACKEND='auto' is not valid. Choices: amdgpu, cuda, cpu;"),
    ],
)
def test_unknown_lessons_and_backends_are_refused_with_the_valid_ones(tmp_path, settings, said):
    with pytest.raises(RecordingError) as refused:
        run(tmp_path, lab("cuda"), **settings)
    assert said in str(refused.value)


def test_a_place_that_cannot_hold_evidence_is_refused_before_the_run(tmp_path, no_file):
    said: list[str] = []
    with pytest.raises(ProjectError, match=f"{no_file.parent} is no folder .* TO=folder"):
        run(tmp_path, lab("cuda"), to=no_file, say=said.append)
    assert said == []


def test_another_installed_engine_stops_the_recording(tmp_path, monkeypatch):
    monkeypatch.setattr("robo_genesis.core.project.installed_version", lambda name: "0.0.1")
    with pytest.raises(ProjectError, match=r"Installed is genesis-world 0\.0\.1, pinned"):
        run(tmp_path, lab("cuda"))


def test_a_recording_beside_a_build_is_refused(tmp_path):
    with only_build(tmp_path / "cache"), pytest.raises(BuildError, match="Another build"):
        run(tmp_path, lab("cuda"))


def test_the_next_command_brings_back_what_a_kill_left_aside(tmp_path):
    old = old_bundle(tmp_path, "cuda")
    old.parent.rename(old.parents[1] / ".cuda.old")
    with pytest.raises(RecordingError):
        run(tmp_path, lab("cuda"), foresee=lambda: "cpu")
    assert old.read_text() == "old"
