import json
from pathlib import Path
from types import SimpleNamespace

import pytest
from tiny_book import accept, lab, make_book, old_bundle

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.pages.execute import kernel_environment
from robo_genesis.pipeline.pages.kernels import clean_environment
from robo_genesis.pipeline.recording import one_lab as recording
from robo_genesis.pipeline.recording.one_lab import Recording, RecordingError, record
from robo_genesis.pipeline.recording.report import checkout
from robo_genesis.pipeline.stages import BuildError, build_lock
from robo_genesis.sim.diagnosis import Finding


def refuse(folder: Path, run_id: str) -> SimpleNamespace:
    raise BundleRefused("metrics", "metrics.json g1.rise_time is not what the arrays say.")


def run(folder: Path, page: str, expected: str | None = None, **settings) -> list[str]:
    """Record the tiny book's lab into `folder/kept`; Torch sees what the test says."""
    book = make_book(folder, lab=page)
    settings = {
        "lesson": "l04",
        "verify": accept,
        "probe": lambda expected: (expected or "cuda", [Finding("torch", "ok", "2.13.0")]),
        "say": lambda line: None,
        "to": folder / "kept",
    } | settings
    return record(Recording(book=book, cache=folder / "cache", expected=expected, **settings))


def test_the_lab_is_recorded_anew_each_time_under_the_name_of_its_backend(tmp_path):
    old, run_ids = old_bundle(tmp_path, "cuda"), []
    place = tmp_path / "kept/l04/cuda"
    for _ in range(2):
        said: list[str] = []
        last = run(tmp_path, lab("cuda"), say=said.append)
        assert sorted(path.name for path in place.iterdir()) == ["log.txt", "manifest.json"]
        assert old.read_text() == "new"
        run_ids.append(json.loads((place / "manifest.json").read_text())["predicate"]["run_id"])
    assert run_ids[0] != run_ids[1]
    stages = list(dict.fromkeys(line.split("] ")[1].split()[0] for line in said))
    assert stages == ["probe", "execute", "verify", "record"]
    assert last[:7] == [
        f"Recorded: {place}",
        "Backend: requested auto, actual cuda, device a device",
        "Engine: genesis-world 1.2.3, quadrants 0.9, torch 2.13.0",
        "Camera: llvmpipe (drawn in software)",
        "Checks passed: 2 of 2. Engine warnings kept: 1.",
        "Files: 2, 0.0 MB",
        "Checkout: changed since commit 0123456789ab, and the manifest says so; a release refuses "
        "that. Commit or stash, then record each lab again with LESSON=name.",
    ]
    assert last[7].startswith("Before you commit: look at both pictures")


def test_the_cpu_is_recorded_without_a_probe_and_by_default_in_the_book(tmp_path):
    said: list[str] = []
    last = run(tmp_path, lab("cpu"), "cpu", to=None, probe=None, say=said.append)
    assert (tmp_path / "book/evidence/l04/cpu/manifest.json").is_file()
    assert last[1] == "Backend: requested cpu, actual cpu, device a device"


def test_the_last_lines_name_the_checkout():
    clean = SimpleNamespace(commit="0123456789abcdef", dirty=False)
    assert checkout(clean) == "Checkout: clean, commit 0123456789ab"
    assert checkout(None).startswith("Checkout: no git here, so no commit is recorded")


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
def test_another_backend_than_expected_is_refused(expected, actual, said):
    with pytest.raises(RecordingError, match=said):
        recording.require_expected(Recording("l04", expected), actual)


def test_a_folder_that_names_another_backend_than_its_manifest_is_refused(tmp_path):
    relabelled = '\nfolder.rename(folder.with_name("amdgpu"))'
    with pytest.raises(RecordingError, match=r"Expected backend: amdgpu; .* finds 'cuda'"):
        run(tmp_path, lab("cuda", more=relabelled), "amdgpu")
    assert not (tmp_path / "kept").exists()


NO_CAMERA = lab("cuda").replace('"camera" if camera', '"skip" if camera')
BY_HAND = lab("cuda").replace('["ROBO_GENESIS_COMMAND"]', '["HOME"]')


@pytest.mark.parametrize(
    ("page", "settings", "said"),
    [
        (lab("cuda", more="\n1 / 0"), {}, "ZeroDivisionError: division by zero"),
        (lab("amdgpu"), {}, "Expected backend: cuda; .* finds 'amdgpu'"),
        (lab("cuda"), {"verify": refuse}, "bundle of this run is refused: metrics: metrics.json"),
        (NO_CAMERA, {}, "render.mode is skip, expected camera"),
        (BY_HAND, {}, "command: manifest.json: command is .*, expected make evidence"),
    ],
    ids=["raising cell", "another backend", "refused bundle", "no camera", "another command"],
)
def test_a_run_that_is_not_accepted_leaves_the_old_bundle(tmp_path, page, settings, said):
    old = old_bundle(tmp_path, "cuda")
    with pytest.raises(RecordingError, match=said):
        run(tmp_path, page, "cuda", **settings)
    assert old.read_text() == "old"
    assert not (tmp_path / "cache/recording").exists()
    assert [path.name for path in (tmp_path / "kept/l04").iterdir()] == ["cuda"]


def test_engine_switches_reach_the_lab_and_the_user_s_contract_does_not(tmp_path, monkeypatch):
    monkeypatch.setenv("GS_ENABLE_ZEROCOPY", "0")
    monkeypatch.setenv("ROCM_PATH", "/opt/rocm-7.2.0")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/opt/hip")
    monkeypatch.setenv("ROBO_GENESIS_BACKEND", "cpu")
    monkeypatch.setenv("ROBO_GENESIS_RENDER", "0")
    recorded = recording.contract(Recording("l04"))
    environment = kernel_environment(ROOT, tmp_path, "make evidence", **recorded)
    environment = clean_environment(tmp_path, tmp_path, ROOT, environment)
    assert environment["GS_ENABLE_ZEROCOPY"] == "0"
    assert environment["ROCM_PATH"] == "/opt/rocm-7.2.0"
    assert environment["LD_LIBRARY_PATH"] == "/opt/hip"
    assert environment["ROBO_GENESIS_BACKEND"] == "auto"
    assert environment["ROBO_GENESIS_RENDER"] == "1"
    assert environment["ROBO_GENESIS_COMMAND"] == "make evidence"


FOUND = [Finding(name, "broken", "a b") for name in ("devices", "kernel")]
FOUND += [Finding("torch", "warning", "c")]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"lesson": "l05"}, r"^LESSON='l05' is not valid\. Lessons with a lab: l04; unset, all\."),
        ({"expected": "rocm"}, r"^BACKEND='rocm' is not valid\. Choices: amdgpu, cuda, cpu;"),
        ({"expected": "auto"}, r"^BACKEND='auto' is not valid\. Choices: amdgpu, cuda, cpu;"),
        ({"to": Path("file", "below")}, r"file is not a folder .* TO=folder"),
        ({"root": Path()}, r"Installed is genesis-world \S+, pinned in pyproject.toml is 0\.0\.1"),
        ({"probe": lambda expected: ("cuda", FOUND)}, r"^Broken: devices, kernel\. The lines"),
    ],
)
def test_what_cannot_be_recorded_is_refused_before_the_run(tmp_path, monkeypatch, settings, said):
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    Path("pyproject.toml").write_text('[project]\ndependencies = ["genesis-world==0.0.1"]\n')
    lines: list[str] = []
    with pytest.raises(ProjectError, match=said):
        run(tmp_path, lab("cuda"), **settings, say=lines.append)
    probed = ["probe devices broken a b", "probe kernel broken a b", "probe torch warning c"]
    found = [" ".join(line.split("] ")[1].split()) for line in lines]
    assert found == (probed if "probe" in settings else [])


def test_a_recording_beside_a_build_is_refused(tmp_path):
    with build_lock(tmp_path / "cache"), pytest.raises(BuildError, match="Another build"):
        run(tmp_path, lab("cuda"))


def test_the_next_command_brings_back_what_a_kill_left_aside(tmp_path):
    old = old_bundle(tmp_path, "cuda")
    old.parent.rename(old.parents[1] / ".cuda.old")
    with pytest.raises(RecordingError):
        run(tmp_path, lab("cuda"), lesson="l05")
    assert old.read_text() == "old"
