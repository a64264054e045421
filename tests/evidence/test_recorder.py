import base64
import hashlib
import json
import re
import subprocess
from dataclasses import replace
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
    source_record,
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


def test_metrics_are_written_as_measured(pristine, measured):
    assert json.loads((pristine / "metrics.json").read_text()) == measured.metrics


def test_not_observed_is_written_as_null(recorder, measured):
    metrics = {**measured.metrics, "G1": dict(measured.metrics["G1"])}
    metrics["G1"]["rise_time"] = {**metrics["G1"]["rise_time"], "value": None}
    written = recorder.write(replace(measured, metrics=metrics))
    assert read_metrics(written)["G1"]["rise_time"].value is None


def test_frames_come_back_as_they_were_with_the_runs_stamp(pristine, frames, predicate):
    for name, frame in frames.items():
        with Image.open(pristine / "frames" / f"{name}.png") as picture:
            assert (np.asarray(picture) == frame).all()
            assert picture.info["run_id"] == predicate.run_id


def test_the_engines_log_and_its_warnings_are_kept(pristine, predicate, engine):
    assert (pristine / "log.txt").read_text() == engine.log.text()
    assert predicate.warnings == ["Approximating tendon."]


def test_who_computed_and_drew_is_recorded(predicate, engine, backend):
    assert predicate.engine.version == engine.version
    assert (predicate.backend.requested, predicate.backend.actual) == ("cpu", "cpu")
    assert predicate.backend.torch_version == backend.torch_version
    assert (predicate.render.mode, predicate.render.renderer) == ("camera", "llvmpipe")
    assert predicate.render.software is True


def test_the_switches_that_were_set_are_recorded_without_a_home(quiet, tmp_path, engine, measured):
    home = Path.home()
    switches = {"GS_ENABLE_ZEROCOPY": "0", "LIBGL_DRIVERS_PATH": f"/usr/lib:{home}/mesa"}
    contract = session.Contract("cpu", True, tmp_path)
    recorder = Recorder("l04", "lab", contract, replace(engine, switches=switches))
    found = read_manifest(recorder.write(measured)).predicate.environment
    assert found == {"GS_ENABLE_ZEROCOPY": "0", "LIBGL_DRIVERS_PATH": "/usr/lib:~/mesa"}


def test_where_none_was_set_none_is_recorded(predicate):
    assert predicate.environment == {}


def test_the_backend_is_probed_again_at_the_end(recorder, measured, backend, monkeypatch):
    moved = replace(backend, actual="cuda")
    monkeypatch.setattr(session, "probe", lambda requested: moved)
    assert read_manifest(recorder.write(measured)).predicate.backend.actual_at_end == "cuda"


def test_without_a_camera_there_are_no_frames(recorder, measured):
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(measured, frames={}, renderer=None))
    render = read_manifest(written).predicate.render
    assert render.model_dump() == {
        "mode": "skip", "vendor": None, "renderer": None, "software": None,
    }  # fmt: skip
    assert not (written / "frames").exists()


@pytest.mark.parametrize("asked", [True, False])
def test_a_page_that_renders_otherwise_than_asked_is_refused(recorder, measured, asked):
    recorder.contract = replace(recorder.contract, render=asked)
    handed = measured if not asked else replace(measured, frames={}, renderer=None)
    with pytest.raises(session.ContractError, match="ROBO_GENESIS_RENDER asks for"):
        recorder.write(handed)
    assert not recorder.folder.exists()


def test_times_are_utc_and_in_order(predicate):
    assert re.fullmatch(r"\d{4}(-\d\d){2}T\d\d(:\d\d){2}\.\d{6}Z", predicate.started)
    assert predicate.started <= predicate.ended


def test_checks_are_recorded_in_order(predicate, measured):
    found = [(c.name, c.passed, c.detail) for c in predicate.checks]
    assert found == [(c.name, c.passed, c.detail) for c in measured.checks]


@pytest.mark.parametrize(
    ("variable", "value", "read"),
    [
        ("RUN_ID", "f" * 32, lambda p: p.run_id),
        ("COMMAND", "make book", lambda p: p.command),
        ("PAGE_SHA256", "a" * 64, lambda p: p.source.page),
    ],
)
def test_the_build_names_run_command_and_page(
    quiet, tmp_path, engine, measured, monkeypatch, variable, value, read
):
    monkeypatch.setenv(f"ROBO_GENESIS_{variable}", value)
    recorder = Recorder("l04", "lab", session.Contract("cpu", True, tmp_path), engine)
    assert read(read_manifest(recorder.write(measured)).predicate) == value


def test_a_run_by_hand_has_an_id_of_its_own(quiet, tmp_path, engine, monkeypatch):
    monkeypatch.delenv("ROBO_GENESIS_RUN_ID", raising=False)
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
def test_a_write_that_fails_leaves_nothing(recorder, measured, spoil):
    with pytest.raises((TypeError, ValueError)):
        recorder.write(spoil(measured))
    assert list(recorder.contract.outputs.iterdir()) == []


@pytest.mark.parametrize("spoil", [unwritable, bad_frame, bad_parameter])
def test_a_write_that_fails_keeps_the_old_bundle(recorder, measured, spoil):
    written = recorder.write(measured)
    before = {name: (written / name).read_bytes() for name in files(written)}
    with pytest.raises((TypeError, ValueError)):
        recorder.write(spoil(measured))
    assert {name: (written / name).read_bytes() for name in files(written)} == before
    assert [path.name for path in recorder.contract.outputs.iterdir()] == ["l04"]


def test_what_an_earlier_failure_left_does_not_enter(recorder, measured):
    partial = recorder.contract.outputs / f".l04-lab-{recorder.run_id}.partial"
    partial.mkdir(parents=True)
    (partial / "stray.txt").write_text("old")
    assert "stray.txt" not in files(recorder.write(measured))
    assert not partial.exists()


@pytest.mark.parametrize(
    ("page", "names"),
    [("lab", MODULES), ("lecture", (*MODULES, *STUDY_MODULES))],
)
def test_the_source_record_digests_each_computing_module_of_its_page(page, names):
    def path_of(name):
        return f"{name.replace('.', '/')}.py"

    assert source_record("l04", page)["modules"] == {
        name: hashlib.sha256((PACKAGE / path_of(name)).read_bytes()).hexdigest() for name in names
    }


@pytest.fixture
def wheel(tmp_path, monkeypatch):
    """A distribution of one file, and of one that its wheel has no digest of."""

    def entry(name, digest):
        return SimpleNamespace(hash=digest, locate=lambda: tmp_path / name)

    (tmp_path / "module.py").write_bytes(b"x = 1\n")
    digest = base64.urlsafe_b64encode(hashlib.sha256(b"x = 1\n").digest()).rstrip(b"=").decode()
    listed = [
        entry("module.py", SimpleNamespace(mode="sha256", value=digest)),
        entry("RECORD", None),
    ]
    monkeypatch.setattr(
        record.importlib.metadata, "distribution", lambda name: SimpleNamespace(files=listed)
    )
    return tmp_path


def test_untouched_files_match_their_wheel(wheel):
    assert files_match_wheel("engine") is True


def test_one_changed_byte_does_not_match(wheel):
    (wheel / "module.py").write_bytes(b"x = 2\n")
    assert files_match_wheel("engine") is False


def test_a_deleted_file_does_not_match(wheel):
    (wheel / "module.py").unlink()
    assert files_match_wheel("engine") is False


def test_the_host_lists_its_packages():
    host = host_record("a CPU")
    assert bundle.HostRecord.model_validate(host)
    assert host["cpu"] == "a CPU"
    assert {"numpy", "genesis-world"} <= set(host["packages"])


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setattr(record, "PACKAGE", tmp_path / "robo_genesis")

    def git(*arguments):
        identity = ("-c", "user.name=t", "-c", "user.email=t@example.org")
        command = ["git", "-C", str(tmp_path), *identity, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    return SimpleNamespace(path=tmp_path, git=git)


def test_outside_a_checkout_there_is_no_commit(checkout):
    assert git_record() is None


def test_commit_and_changes_are_recorded(checkout):
    checkout.git("init", "--quiet")
    checkout.git("commit", "--quiet", "--allow-empty", "--message", "first")
    commit = checkout.git("rev-parse", "HEAD")
    assert git_record() == {"commit": commit, "dirty": False}
    (checkout.path / "new").write_text("")
    assert git_record() == {"commit": commit, "dirty": True}
