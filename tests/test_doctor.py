"""Every link of the doctor's chain broken in turn, and the whole chain on the real engine."""

import ctypes
import functools
import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis import doctor
from robo_genesis.core import project
from robo_genesis.doctor import main, table
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.sim import diagnosis, joint_control, session
from robo_genesis.sim.diagnosis import LINKS, Finding, shareable

NAMES = [link.__name__ for link in LINKS]


def refuse(*args, **kwargs):
    raise OSError("no such library")


@pytest.fixture
def looked_at(monkeypatch):
    """Names of the links that really ran, in order."""
    ran: list[str] = []

    def counted(link):
        @functools.wraps(link)
        def run(bench):
            ran.append(link.__name__)
            return link(bench)

        return run

    monkeypatch.setattr(diagnosis, "LINKS", tuple(counted(link) for link in LINKS))
    monkeypatch.setattr(project, "engine_cache_environment", dict)  # no variable outlives a test
    for variable in ("ROBO_GENESIS_BACKEND", "ROBO_GENESIS_RENDER", "ROBO_GENESIS_OUTPUTS_DIR"):
        monkeypatch.delenv(variable, raising=False)
    return ran


def assert_broken(ran, capsys, link, *words):
    """The command stops at `link`, says `words`, runs nothing later and exits with 1."""
    place = NAMES.index(link)
    assert main(["--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert ran == NAMES[: place + 1]
    assert found["broken"] == link
    assert [f["link"] for f in found["links"]] == NAMES
    states = ["ok"] * place + ["broken"] + ["not run"] * (len(NAMES) - place - 1)
    assert [f["state"] for f in found["links"]] == states
    assert [word for word in words if word not in found["links"][place]["found"]] == []


def test_another_engine_version_is_found(looked_at, capsys, monkeypatch):
    monkeypatch.setattr(project, "installed_version", lambda package: "0.0.1")
    assert_broken(looked_at, capsys, "version", "genesis-world 0.0.1", "pip install -r")


def test_a_missing_library_is_found(looked_at, capsys, monkeypatch):
    monkeypatch.setattr(ctypes, "CDLL", refuse)
    assert_broken(looked_at, capsys, "libraries", "libEGL.so.1", "apt install libegl1")


@pytest.mark.parametrize(
    ("variable", "value", "words"),
    [
        ("ROBO_GENESIS_BACKEND", "banana", "Choose one of: auto, cpu."),
        ("ROBO_GENESIS_RENDER", "yes", "Choose one of: 0, 1."),
    ],
)
def test_a_wrong_variable_is_found(looked_at, capsys, monkeypatch, variable, value, words):
    monkeypatch.setenv(variable, value)
    assert_broken(looked_at, capsys, "backend", f"{variable}={value!r}", words)


def test_an_outputs_folder_that_cannot_be_written_is_found(looked_at, capsys, monkeypatch, no_file):
    monkeypatch.setenv("ROBO_GENESIS_OUTPUTS_DIR", str(no_file))
    assert_broken(looked_at, capsys, "backend", "ROBO_GENESIS_OUTPUTS_DIR", "below' cannot be")


def test_a_missing_model_is_found(looked_at, capsys, monkeypatch):
    backend = SimpleNamespace(requested="cpu", actual="cpu", device_name="a processor")
    log = session.EngineLog()
    started = SimpleNamespace(backend=backend, log=log)
    monkeypatch.setattr(session, "start", lambda contract: started)
    monkeypatch.setattr(diagnosis, "FRANKA_MJCF", "xml/no_robot.xml")
    assert_broken(looked_at, capsys, "model_file", "genesis/assets/xml/no_robot.xml", "pip install")


class StandIn:
    """The lab's built scene where the doctor would build its own."""

    def __init__(self, lab):
        self.lab = lab
        self.camera = lab.camera
        self.entities = [lab.franka]
        self.is_built = True

    def __getattr__(self, name):
        return getattr(self.lab.scene, name)

    def add_entity(self, morph):
        return self.lab.franka

    def add_camera(self, **options):
        return self.camera

    def build(self):
        pass


@pytest.fixture
def scene(lab, monkeypatch):
    """A chain that starts no second engine and builds no second scene."""
    scene = StandIn(lab)
    gs = SimpleNamespace(
        Scene=lambda **options: scene, options=lab.gs.options, morphs=lab.gs.morphs
    )
    monkeypatch.setattr(session, "start", lambda contract: lab.engine)
    monkeypatch.setattr(session, "import_engine", lambda: gs)
    return scene


@pytest.mark.engine
def test_an_error_of_the_engine_is_named_with_what_to_do(looked_at, capsys, monkeypatch, scene):
    def build():
        raise RuntimeError("EGL is required")

    monkeypatch.setattr(scene, "build", build)
    assert_broken(looked_at, capsys, "build", "RuntimeError: EGL is required", "--json")


@pytest.mark.engine
def test_a_scene_that_is_not_built_is_found(looked_at, capsys, scene):
    scene.is_built = False
    assert_broken(looked_at, capsys, "build", "is not built", "Restart")


@pytest.mark.engine
def test_an_empty_picture_is_found(looked_at, capsys, scene):
    empty = np.zeros(session.FRAME_SHAPE, np.uint8)
    scene.camera = SimpleNamespace(render=lambda: [empty])
    assert_broken(looked_at, capsys, "render", "empty picture")


@pytest.mark.engine
def test_an_unknown_joint_is_found(looked_at, capsys, monkeypatch, scene):
    monkeypatch.setattr(diagnosis, "JOINT_NAMES", ("joint1", "elbw"))
    assert_broken(looked_at, capsys, "names", "Joint 'elbw'", "Available: joint1")


@pytest.mark.engine
def test_another_model_is_found(looked_at, capsys, monkeypatch, scene):
    monkeypatch.setattr(diagnosis, "FRANKA_MODEL", {"links": 12, "joints": 9, "dofs": 9, "qpos": 9})
    assert_broken(looked_at, capsys, "names", "'links': 11", "'links': 12")


@pytest.mark.engine
def test_a_target_past_its_limit_is_found(looked_at, capsys, monkeypatch, scene):
    monkeypatch.setattr(
        diagnosis,
        "BASELINE",
        replace(diagnosis.BASELINE, q_target=l04.with_entry(l04.Q_START, 1.0)),
    )
    assert_broken(looked_at, capsys, "target", "q_target[joint4] is 1 rad", "none is clipped")


@pytest.mark.engine
def test_a_reset_that_does_not_fit_the_scene_is_found(looked_at, capsys, monkeypatch, scene):
    monkeypatch.setattr(diagnosis, "BASELINE", replace(diagnosis.BASELINE, dt=0.02))
    assert_broken(looked_at, capsys, "reset", "dt=0.02", "Restart")


@pytest.mark.engine
def test_values_that_are_not_finite_are_found(looked_at, capsys, monkeypatch, scene):
    nothing = np.full(9, np.nan)
    monkeypatch.setattr(joint_control, "read_step", lambda robot, dofs: (nothing,) * 3)
    assert_broken(looked_at, capsys, "stamps", "qd is not finite", "reset")


@pytest.mark.engine
def test_a_joint_that_does_not_come_nearer_is_found(looked_at, capsys, monkeypatch, scene):
    weak = np.full(9, 0.5)
    monkeypatch.setattr(diagnosis, "BASELINE", replace(diagnosis.BASELINE, effort_limit=weak))
    assert_broken(looked_at, capsys, "saturation", "120 of 120 samples", "look at limit")


@pytest.mark.engine
def test_a_healthy_machine_passes_with_a_scene_of_its_own(looked_at, capsys, monkeypatch, lab):
    monkeypatch.setattr(session, "start", lambda contract: lab.engine)
    assert main([]) == 0
    output = capsys.readouterr().out
    assert looked_at == NAMES
    assert output.count("  ok  ") == len(NAMES)
    assert f"genesis-world {lab.engine.version}, as pinned" in output
    assert output.splitlines()[-1] == f"DOCTOR: all {len(NAMES)} links hold"


@pytest.mark.engine
def test_without_rendering_the_picture_is_skipped_and_said_so(
    looked_at, capsys, monkeypatch, scene
):
    monkeypatch.setenv("ROBO_GENESIS_RENDER", "0")
    assert main(["--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is True
    assert found["broken"] is None
    picture = next(f for f in found["links"] if f["link"] == "render")
    assert picture["found"] == "SKIP: ROBO_GENESIS_RENDER=0, no camera"
    assert found["environment"]["ROBO_GENESIS_RENDER"] == "0"


def test_the_report_has_stable_fields_and_versions(looked_at, capsys, monkeypatch):
    monkeypatch.setattr(project, "installed_version", lambda package: "0.0.1")
    main(["--json"])
    found = json.loads(capsys.readouterr().out)
    fields = "format ok broken links versions platform environment warnings"
    assert list(found) == fields.split()
    assert found["format"] == doctor.REPORT_FORMAT == 1
    assert found["versions"]["genesis-world"] == "0.0.1"
    assert set(found["platform"]) == {"system", "release", "machine", "cpus"}


def test_the_report_names_no_user(looked_at, capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", "/home/alice")
    monkeypatch.setenv("USER", "alice")
    monkeypatch.setenv("GS_CACHE_FILE_PATH", "/home/alice/cache")
    monkeypatch.setenv("QD_FOLDER", "/srv/people/alice/data")
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ROBO_GENESIS_OUTPUTS_DIR", str(tmp_path / "file" / "alice" / "out"))
    main(["--json"])
    output = capsys.readouterr().out
    assert "alice" not in output
    assert json.loads(output)["environment"]["GS_CACHE_FILE_PATH"] == "~/cache"


@pytest.mark.parametrize(
    ("text", "shared"),
    [
        (f"{project.ROOT}/book/x.md", "<course>/book/x.md"),
        ("'/data/alice/x.xml' is gone", "'…/x.xml' is gone"),
        ("cannot open /home/alice", "cannot open …/…"),
        ("file:///home/bob/x", "file:///home/…/x"),
        ("-I/home/bob/inc", "-I/home/…/inc"),
        (r"C:\Users\bob\x.py", r"C:\Users\…\x.py"),
        ("see https://host/a/b and N·m/rad", "see https://host/a/b and N·m/rad"),
        ("xml/franka_emika_panda/panda.xml", "xml/franka_emika_panda/panda.xml"),
    ],
)
def test_folders_are_taken_out_and_nothing_else(text, shared):
    assert shareable(text) == shared


def test_a_home_at_the_root_changes_no_text(monkeypatch):
    monkeypatch.setattr(Path, "home", lambda: Path("/"))
    assert shareable("a / b") == "a / b"


def test_the_table_is_aligned_and_fits_80_columns():
    findings = [
        Finding("a", "ok", "word " * 60),
        Finding("longer_name", "broken", "Choose another. " * 9),
        Finding("c", "not run", ""),
    ]
    lines = table(findings).splitlines()
    assert max(map(len, lines)) <= doctor.WIDTH <= 80
    texts = [line for line in lines if "word" in line or "Choose" in line]
    assert all(line[25] == " " != line[26] for line in texts)
    assert lines[-1] == "DOCTOR: link 2, longer_name, is broken; mend it and run this again"


def test_an_unknown_option_is_refused_with_usage(capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["--verbose"])
    assert stopped.value.code == 2
    assert "robo_genesis.doctor" in capsys.readouterr().err
