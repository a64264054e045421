import base64
import hashlib
import logging
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from bundles import RENDERER
from tiny_book import commit, contents, git

from robo_genesis.evidence import recorder as record
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.evidence.reader import read_frames
from robo_genesis.evidence.recorder import Recorder, RecordError
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.pages.sources import measuring_modules, running_modules
from robo_genesis.sim import session
from robo_genesis.sim.camera.frames import FrameError
from robo_genesis.sim.engine_log import EngineLog
from robo_genesis.sim.visual_shape import FILE, Part, load_shape


def test_frames_and_shape_come_back_as_they_were(recorder, experiment, frames):
    part = Part("hand", (1, 2, 3), np.eye(3, dtype=np.float32), np.arange(3)[None])
    written = recorder.write(experiment, RENDERER, [part])
    found = read_frames(written, frames)
    assert all((found[name] == frame).all() for name, frame in frames.items())
    [shape] = load_shape(written / FILE)
    assert (shape.link, shape.rgb) == (part.link, part.rgb)
    assert FILE in read_manifest(written).files


def test_backend_renderer_log_and_host_are_recorded(
    recorder, experiment, backend, monkeypatch
):
    switches = {
        "GS_ENABLE_ZEROCOPY": "0",
        "LIBGL_DRIVERS_PATH": f"/usr/lib:{Path.home()}/mesa",
    }
    recorder.engine = replace(recorder.engine, switches=switches)
    monkeypatch.setattr(
        session, "probe", lambda requested: replace(backend, actual="cuda")
    )
    written = recorder.write(experiment, RENDERER)
    found = read_manifest(written)
    assert (written / "log.txt").read_text() == recorder.engine.log.text()
    assert found.backend.torch_version == backend.torch_version
    assert (found.backend.actual, found.backend.actual_at_end) == ("cpu", "cuda")
    assert found.render.renderer == "llvmpipe"
    assert found.environment == switches | {"LIBGL_DRIVERS_PATH": "/usr/lib:~/mesa"}
    assert found.host.cpu == "a CPU"
    assert {"numpy", "genesis-world"} <= set(found.host.packages)


def test_the_build_names_run_command_and_page(quiet, tmp_path, engine, experiment):
    contract = session.Contract("cpu", True, tmp_path)
    by_hand = {Recorder("l04", "lab", contract, engine, {}).run_id for _ in range(2)}
    assert len(by_hand) == 2
    assert all(re.fullmatch("[0-9a-f]{32}", run_id) for run_id in by_hand)
    names = {"RUN_ID": "f" * 32, "COMMAND": "make book", "PAGE_SHA256": "a" * 64}
    for name, value in names.items():
        quiet.setenv(f"ROBO_GENESIS_{name}", value)
    recorder = Recorder("l04", "lab", contract, engine, {})
    found = read_manifest(recorder.write(experiment, RENDERER))
    assert [found.run_id, found.command, found.source.page] == list(names.values())


def test_a_new_bundle_replaces_an_old_one_and_what_an_earlier_failure_left(
    recorder, experiment
):
    outputs = recorder.contract.outputs
    written = recorder.write(experiment, RENDERER)
    for left in (written, written.with_name(f".{written.name}.next")):
        left.mkdir(exist_ok=True)
        (left / "stray.txt").write_text("old")
    recorder.write(experiment, RENDERER)
    found = contents(written)
    assert "stray.txt" not in found
    assert contents(outputs) == {
        f"l04/lab/cpu/{name}": of for name, of in found.items()
    }


@pytest.mark.parametrize(
    ("spoil", "error", "said"),
    [
        (
            lambda e: {"traces": {n: t for n, t in e.traces.items() if n != "G2"}},
            RecordError,
            "the runs G1, G3, baseline; its declaration names G1, G2, G3, baseline. Run each",
        ),
        (
            lambda e: {
                "readings": e.readings
                | {"model": e.readings["model"] | {"links": np.nan}}
            },
            RecordError,
            "Not finite: model.links.",
        ),
        (
            lambda e: {"frames": {"initial": np.zeros((2, 2, 7), np.uint8)}},
            FrameError,
            "shape",
        ),
    ],
)
def test_a_failed_write_leaves_nothing_or_the_old_bundle(
    recorder, experiment, spoil, error, said
):
    outputs, spoiled = (
        recorder.contract.outputs,
        replace(experiment, **spoil(experiment)),
    )
    for _ in range(2):
        before = contents(outputs)
        with pytest.raises(error, match=re.escape(said)):
            recorder.write(spoiled, RENDERER)
        assert contents(outputs) == before
        recorder.write(experiment, RENDERER)


def test_a_message_of_the_engine_is_a_warning_of_the_manifest(recorder, experiment):
    log = EngineLog()
    message = {"levelname": "WARNING", "msg": "red b"}
    log.emit(logging.makeLogRecord(message))
    recorder.engine = replace(recorder.engine, log=log)
    folder = recorder.write(experiment, RENDERER)
    assert verify_bundle(folder).warnings == ["red b"]


def test_modules_of_the_lesson_and_imports_of_the_page_are_digested(quiet):
    names = "robo_genesis.sim.bodies.contacts robo_genesis.core.plotting"
    quiet.setenv("ROBO_GENESIS_PAGE_IMPORTS", names)
    found = running_modules("l04")
    expected = measuring_modules("l04", ["robo_genesis.sim.bodies.contacts"])
    assert found == expected != measuring_modules("l04", [])


@pytest.mark.parametrize(
    ("content", "has_digest", "match"),
    [
        (b"x = 1\n", True, True),
        (b"x = 2\n", True, False),
        (None, True, False),  # the file is missing
        (b"x = 1\n", False, False),
    ],
)
def test_files_without_their_digest_match_no_wheel(
    tmp_path, monkeypatch, content, has_digest, match
):
    digest = base64.urlsafe_b64encode(hashlib.sha256(b"x = 1\n").digest())
    value = digest.rstrip(b"=").decode()
    path = tmp_path / "module.py"
    file = SimpleNamespace(suffix=".py", locate=lambda: path)
    file.hash = SimpleNamespace(mode="sha256", value=value) if has_digest else None
    monkeypatch.setattr(record.metadata, "files", lambda name: [file])
    if content is not None:
        path.write_bytes(content)
    assert record.files_match_wheel("engine") is match


def test_the_driver_is_that_of_the_backend(tmp_path):
    for module, text in (("amdgpu", "6.16\n"), ("nvidia", "580.1\n")):
        (tmp_path / "sys/module" / module).mkdir(parents=True)
        (tmp_path / "sys/module" / module / "version").write_text(text)
    found = {
        of: record.driver_version(of, tmp_path)
        for of in ("amdgpu", "cuda", "cpu", "metal")
    }
    assert found == {"amdgpu": "6.16", "cuda": "580.1", "cpu": None, "metal": None}
    assert record.driver_version("cuda", tmp_path / "elsewhere").startswith(
        "of the kernel "
    )


def test_commit_and_changes_are_recorded(tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setattr(record, "PACKAGE", tmp_path / "robo_genesis")
    assert record.git_record() is None
    (tmp_path / "old").touch()
    commit(tmp_path)
    head = git(tmp_path, "rev-parse", "HEAD").strip()
    recorded = tmp_path / "book" / "evidence" / "l02" / "amdgpu" / "log.txt"
    recorded.parent.mkdir(parents=True)
    recorded.touch()  # of a lab that was recorded before
    assert record.git_record() == {"commit": head, "dirty": False}
    (tmp_path / "new").touch()
    assert record.git_record() == {"commit": head, "dirty": True}
