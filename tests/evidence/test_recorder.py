import base64
import hashlib
import json
import re
import subprocess
from dataclasses import asdict, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from robo_genesis.evidence import bundle
from robo_genesis.evidence import recorder as record
from robo_genesis.evidence.bundle import read_manifest, read_metrics
from robo_genesis.evidence.recorder import (
    PACKAGE,
    Recorder,
    files_match_wheel,
    git_record,
    host_record,
)
from robo_genesis.lessons.l04 import MODULES, STUDY_MODULES
from robo_genesis.sim import session


@pytest.fixture
def predicate(pristine):
    return read_manifest(pristine).predicate


def files(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def test_a_bundle_stands_below_lesson_page_and_backend(recorder, measured):
    written = recorder.write(measured)
    assert written == recorder.contract.outputs / "l04" / "lab" / "cpu"
    assert files(written) == [
        "arrays.json",
        *(f"arrays/{case}.npz" for case in ("G1", "G2", "G3", "baseline")),
        "frames/final.png",
        "frames/initial.png",
        "log.txt",
        "manifest.json",
        "metrics.json",
    ]


def test_the_manifest_lists_every_other_file_with_its_digest(pristine):
    listed = {s.name: s.digest.sha256 for s in read_manifest(pristine).subject}
    assert {*listed, "manifest.json"} == {*files(pristine)}
    assert all(bundle.sha256(pristine / name) == digest for name, digest in listed.items())


def test_metrics_are_written_as_measured_and_null_is_not_observed(recorder, measured):
    metrics = {**measured.metrics, "G1": dict(measured.metrics["G1"])}
    metrics["G1"]["rise_time"] = {**metrics["G1"]["rise_time"], "value": None}
    written = recorder.write(replace(measured, metrics=metrics))
    assert json.loads((written / "metrics.json").read_text()) == metrics
    assert read_metrics(written)["G1"]["rise_time"].value is None


def test_frames_come_back_as_they_were_with_the_run_id(pristine, frames, predicate):
    for name, frame in frames.items():
        with Image.open(pristine / "frames" / f"{name}.png") as picture:
            assert (np.asarray(picture) == frame).all()
            assert picture.info["run_id"] == predicate.run_id


def test_the_engines_log_and_its_warnings_are_kept(pristine, predicate, engine):
    assert (pristine / "log.txt").read_text() == engine.log.text()
    assert predicate.warnings == ["Approximating tendon."]


def test_engine_backend_and_renderer_are_recorded(predicate, engine, backend):
    assert predicate.engine.version == engine.version
    assert (predicate.backend.requested, predicate.backend.actual) == ("cpu", "cpu")
    assert predicate.backend.torch_version == backend.torch_version
    assert (predicate.render.mode, predicate.render.renderer) == ("camera", "llvmpipe")
    assert predicate.render.software is True
    assert predicate.environment == {}


def test_the_switches_that_were_set_are_recorded_without_a_home(quiet, tmp_path, engine, measured):
    home = Path.home()
    switches = {"GS_ENABLE_ZEROCOPY": "0", "LIBGL_DRIVERS_PATH": f"/usr/lib:{home}/mesa"}
    contract = session.Contract("cpu", True, tmp_path)
    recorder = Recorder("l04", "lab", contract, replace(engine, switches=switches))
    found = read_manifest(recorder.write(measured)).predicate.environment
    assert found == {"GS_ENABLE_ZEROCOPY": "0", "LIBGL_DRIVERS_PATH": "/usr/lib:~/mesa"}


def test_the_backend_is_probed_again_at_the_end(recorder, measured, backend, monkeypatch):
    moved = replace(backend, actual="cuda")
    monkeypatch.setattr(session, "probe", lambda requested: moved)
    assert read_manifest(recorder.write(measured)).predicate.backend.actual_at_end == "cuda"


def test_without_a_camera_there_are_no_frames(recorder, measured):
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(measured, frames={}, renderer=None))
    render = read_manifest(written).predicate.render
    assert render == bundle.RenderRecord(mode="skip", vendor=None, renderer=None, software=None)
    assert not (written / "frames").exists()


@pytest.mark.parametrize("render", [True, False])
def test_a_page_that_does_not_follow_the_contract_is_refused(recorder, measured, render):
    recorder.contract = replace(recorder.contract, render=render)
    wrong = replace(measured, frames={}, renderer=None) if render else measured
    with pytest.raises(session.ContractError, match="ROBO_GENESIS_RENDER asks for"):
        recorder.write(wrong)
    assert not recorder.folder.exists()


def test_checks_are_recorded_in_order(predicate, measured):
    assert [c.model_dump() for c in predicate.checks] == [asdict(c) for c in measured.checks]


def test_the_build_names_run_command_and_page(quiet, tmp_path, engine, measured):
    names = {"RUN_ID": "f" * 32, "COMMAND": "make book", "PAGE_SHA256": "a" * 64}
    for name, value in names.items():
        quiet.setenv(f"ROBO_GENESIS_{name}", value)
    recorder = Recorder("l04", "lab", session.Contract("cpu", True, tmp_path), engine)
    found = read_manifest(recorder.write(measured)).predicate
    assert [found.run_id, found.command, found.source.page] == list(names.values())


def test_a_run_by_hand_has_an_id_of_its_own(quiet, tmp_path, engine):
    contract = session.Contract("cpu", True, tmp_path)
    ids = {Recorder("l04", "lab", contract, engine).run_id for _ in range(2)}
    assert len(ids) == 2
    assert all(re.fullmatch("[0-9a-f]{32}", run_id) for run_id in ids)


def test_a_new_bundle_replaces_the_old_one(recorder, measured):
    (recorder.write(measured) / "stray.txt").write_text("old")
    assert "stray.txt" not in files(recorder.write(measured))
    assert files(recorder.contract.outputs) == [f"l04/lab/cpu/{n}" for n in files(recorder.folder)]


def unwritable(measured):
    metrics = {**measured.metrics, "model": {"links": {"value": float("nan")}}}
    return replace(measured, metrics=metrics)


def bad_frame(measured):
    return replace(measured, frames={"initial": np.zeros((2, 2, 7), np.uint8)})


def bad_parameter(measured):
    return replace(measured, parameters={"x": {1, 2}})


@pytest.mark.parametrize("spoil", [unwritable, bad_frame, bad_parameter])
def test_a_write_that_fails_leaves_nothing_or_the_old_bundle(recorder, measured, spoil):
    outputs = recorder.contract.outputs
    with pytest.raises((TypeError, ValueError)):
        recorder.write(spoil(measured))
    assert list(outputs.iterdir()) == []
    recorder.write(measured)
    before = {name: (outputs / name).read_bytes() for name in files(outputs)}
    with pytest.raises((TypeError, ValueError)):
        recorder.write(spoil(measured))
    assert {name: (outputs / name).read_bytes() for name in files(outputs)} == before


def test_what_an_earlier_failure_left_does_not_enter(recorder, measured):
    partial = recorder.contract.outputs / f".l04-lab-{recorder.run_id}.partial"
    partial.mkdir(parents=True)
    (partial / "stray.txt").write_text("old")
    assert "stray.txt" not in files(recorder.write(measured))
    assert not partial.exists()


@pytest.mark.parametrize(
    ("page", "names"), [("lab", MODULES), ("lecture", (*MODULES, *STUDY_MODULES))]
)
def test_each_computing_module_of_a_page_is_digested(
    quiet, tmp_path, engine, measured, page, names
):
    recorder = Recorder("l04", page, session.Contract("cpu", True, tmp_path), engine)
    digests = {
        name: hashlib.sha256((PACKAGE / f"{name.replace('.', '/')}.py").read_bytes()).hexdigest()
        for name in names
    }
    assert read_manifest(recorder.write(measured)).predicate.source.modules == digests


@pytest.fixture
def wheel(tmp_path, monkeypatch):
    """A distribution with one recorded digest, and one file without any."""
    digest = base64.urlsafe_b64encode(hashlib.sha256(b"x = 1\n").digest()).rstrip(b"=").decode()
    hashes = {"module.py": SimpleNamespace(mode="sha256", value=digest), "RECORD": None}
    listed = [
        SimpleNamespace(hash=known, suffix=Path(name).suffix, locate=lambda n=name: tmp_path / n)
        for name, known in hashes.items()
    ]
    found = SimpleNamespace(files=listed)
    monkeypatch.setattr(record.importlib.metadata, "distribution", lambda name: found)
    return tmp_path / "module.py"


@pytest.mark.parametrize(
    ("content", "match"), [(b"x = 1\n", True), (b"x = 2\n", False), (None, False)]
)
def test_changed_or_deleted_files_do_not_match_their_wheel(wheel, content, match):
    if content:
        wheel.write_bytes(content)
    assert files_match_wheel("engine") is match


def test_a_package_without_digests_does_not_match(wheel):
    record.importlib.metadata.distribution("engine").files.pop(0)
    assert files_match_wheel("engine") is False


def test_the_host_lists_its_packages():
    host = host_record("a CPU")
    assert bundle.HostRecord.model_validate(host)
    assert host["cpu"] == "a CPU"
    assert {"numpy", "genesis-world"} <= set(host["packages"])


def test_commit_and_changes_are_recorded(tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setattr(record, "PACKAGE", tmp_path / "robo_genesis")

    def git(*arguments):
        identity = ("-c", "user.name=t", "-c", "user.email=t@example.org")
        command = ["git", "-C", str(tmp_path), *identity, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    assert git_record() is None
    git("init", "--quiet")
    git("commit", "--quiet", "--allow-empty", "--message", "first")
    commit = git("rev-parse", "HEAD")
    assert git_record() == {"commit": commit, "dirty": False}
    (tmp_path / "new").write_text("")
    assert git_record() == {"commit": commit, "dirty": True}
