"""Every step of the doctor broken in turn, and all steps on the real engine."""

import ctypes
import functools
import json
import os
import signal
import subprocess
import sys
import venv
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import psutil
import pytest

from robo_genesis import doctor
from robo_genesis.core import project
from robo_genesis.core import scene as course
from robo_genesis.doctor import main, shareable, table
from robo_genesis.sim import diagnosis, session
from robo_genesis.sim.arm import franka, joint_control
from robo_genesis.sim.diagnosis import BASELINE, STEPS

NAMES = [step.__name__ for step in STEPS]


def fail(*args):
    raise OSError("no such library")


@pytest.fixture
def steps_run(monkeypatch):
    """Names of the steps that really ran, in order."""
    ran: list[str] = []

    def counted(step):
        @functools.wraps(step)
        def run(bench):
            ran.append(step.__name__)
            return step(bench)

        return run

    monkeypatch.setattr(diagnosis, "STEPS", tuple(counted(step) for step in STEPS))
    monkeypatch.setattr(doctor, "reports", doctor.examine)  # in this process
    monkeypatch.setattr(
        project, "engine_cache_environment", dict
    )  # no variable outlives a test
    for variable in (
        "ROBO_GENESIS_BACKEND",
        "ROBO_GENESIS_RENDER",
        "ROBO_GENESIS_OUTPUTS_DIR",
    ):
        monkeypatch.delenv(variable, raising=False)
    return ran


def assert_broken(steps_run, capsys, step, *words):
    """The command stops at `step`, says `words`, runs nothing later and exits with 1."""
    place = NAMES.index(step)
    assert main(["--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert steps_run == NAMES[: place + 1]
    assert found["broken"] == step
    states = ["ok"] * place + ["broken"] + ["not run"] * (len(NAMES) - place - 1)
    assert [(f["step"], f["state"]) for f in found["steps"]] == [
        *zip(NAMES, states, strict=True)
    ]
    assert [word for word in words if word not in found["steps"][place]["found"]] == []


@pytest.mark.parametrize(
    ("step", "spoiled", "words"),
    [
        (
            "version",
            (project, "installed_version", lambda package: "0.0.1"),
            ("genesis-world 0.0.1", "pip install -r"),
        ),
        (
            "version",
            (
                diagnosis,
                "requires",
                lambda package: ["numpy>=99", "numpy<2; extra == 'x'"],
            ),
            ("numpy>=99 is required, installed is", "pip install -r"),
        ),
        ("libraries", (ctypes, "CDLL", fail), ("libGL.so.1", "apt install libegl1")),
    ],
)
def test_a_broken_machine_is_found(
    steps_run, capsys, monkeypatch, step, spoiled, words
):
    monkeypatch.setattr(*spoiled)
    assert_broken(steps_run, capsys, step, *words)


class StandIn:
    """The built scene of the lab, in place of the one that the doctor would build."""

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
    """The lab's scene for steps that start no second engine and build no second scene."""
    scene = StandIn(lab)
    gs = SimpleNamespace(
        Scene=lambda **_: scene, options=lab.gs.options, morphs=lab.gs.morphs
    )
    monkeypatch.setattr(session, "start", lambda contract: lab.engine)
    monkeypatch.setattr(session, "import_engine", lambda: gs)
    return scene


BLIND = SimpleNamespace(render=lambda **_: [np.zeros(course.FRAME_SHAPE, np.uint8)])
UNREACHABLE = np.where(np.equal(franka.JOINT_NAMES, "joint4"), 1.0, franka.Q_START)
NOT_FINITE = (np.full(9, np.nan),) * 6
WEAK = replace(BASELINE, effort_limit=np.full(9, 0.5))


NO_MODEL = ("no model 'xml/no_robot.xml'", "pip install")
FAULTS = [
    ("model_file", franka, "FRANKA_MJCF", "xml/no_robot.xml", NO_MODEL),
    ("build", None, "build", fail, ("OSError: no such library", "--json")),
    ("render", None, "camera", BLIND, ("empty picture",)),
    ("names", franka, "JOINT_NAMES", ("joint1", "elbw"), ("Joint 'elbw'", "Available: joint1")),
    ("names", franka, "MODEL_COUNTS", franka.MODEL_COUNTS | {"links": 12}, ("'links': 11",)),
    ("target", diagnosis, "BASELINE", replace(BASELINE, q_target=UNREACHABLE), ("is 1 rad",)),
    ("reset", diagnosis, "BASELINE", replace(BASELINE, dt=0.02), ("dt=0.02", "Restart")),
    ("stamps", joint_control, "read", lambda robot, *of: NOT_FINITE, ("q is not finite",)),
    ("saturation", diagnosis, "BASELINE", WEAK, ("120 of 120 samples", "Check limit")),
]  # fmt: skip


@pytest.mark.engine
@pytest.mark.parametrize(("step", "module", "name", "value", "words"), FAULTS)
def test_a_broken_step_is_found(
    steps_run, capsys, monkeypatch, scene, step, module, name, value, words
):
    monkeypatch.setattr(module or scene, name, value)
    assert_broken(steps_run, capsys, step, *words)


@pytest.mark.engine
def test_without_rendering_the_picture_is_skipped(
    steps_run, capsys, monkeypatch, scene
):
    monkeypatch.setenv("ROBO_GENESIS_RENDER", "0")
    assert main(["--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is True
    assert found["broken"] is None
    picture = next(f for f in found["steps"] if f["step"] == "render")
    assert picture["found"] == "SKIP: ROBO_GENESIS_RENDER=0, no camera"
    assert found["environment"]["ROBO_GENESIS_RENDER"] == "0"


def test_the_report_has_stable_fields_and_names_no_user(steps_run, capsys, monkeypatch):
    monkeypatch.setattr(project, "installed_version", lambda package: "0.0.1")
    for name, value in (
        ("HOME", "/home/alice"),
        ("USER", "alice"),
        ("GS_FOLDER", "/home/alice/cache"),
        ("QD_FOLDER", "/srv/people/alice/data"),
        ("ROBO_GENESIS_OUTPUTS_DIR", "/dev/null/alice/out"),
    ):
        monkeypatch.setenv(name, value)
    main(["--json"])
    output = capsys.readouterr().out
    assert "alice" not in output
    found = json.loads(output)
    fields = "ok broken steps machine versions environment warnings"
    assert list(found) == fields.split()
    assert found["versions"]["genesis-world"] == "0.0.1"
    assert found["environment"]["GS_FOLDER"] == "~/cache"


@pytest.mark.parametrize(
    ("text", "shared"),
    [
        (f"{project.ROOT}/book/x.md", "book/x.md"),
        (f"{sys.prefix}/bin/python", "…/bin/python"),
        ("cannot open /home/alice", "cannot open ~"),
        ("-I/home/bob/inc", "-I~/inc"),
        ("see https://host/a/b and N·m/rad", "see https://host/a/b and N·m/rad"),
        ("xml/franka_emika_panda/panda.xml", "xml/franka_emika_panda/panda.xml"),
        ("/usr/share/glvnd/egl_vendor.d", "/usr/share/glvnd/egl_vendor.d"),
    ],
)
def test_folders_are_taken_out_and_nothing_else(text, shared, monkeypatch):
    assert shareable(text) == shared
    monkeypatch.setenv("HOME", "/")
    assert shareable("a / b") == "a / b"


def rows(*states, found=""):
    return [
        {"step": n, "state": s, "found": found}
        for n, s in zip(NAMES, states, strict=False)
    ]


def test_the_table_is_aligned_fits_80_columns_and_grows():
    lines = table(rows("ok", "broken", "not run", found="word " * 60)).splitlines()
    assert max(map(len, lines)) <= doctor.WIDTH <= 80
    assert all(line[27] == " " != line[28] for line in lines if "word" in line)
    assert (
        lines[-1] == "DOCTOR: step 2, libraries, is broken; fix it and run this again"
    )
    begun = table(rows("ok", "not run", found="a\nb\x1b[2J"))
    assert begun.endswith("a b\\x1b[2J\n 2/2   libraries   ")
    assert table(rows("ok", "ok", found="a\nb\x1b[2J")).startswith(begun)


def started(folder, changed=None, python=sys.executable):
    """Start the doctor in a folder, with changed variables of the environment; None unsets one."""
    paths = ":".join(
        [*(changed or {}).get("PYTHONPATH", "").split(), str(project.ROOT)]
    )
    given = os.environ | (changed or {}) | {"PYTHONPATH": paths}
    return subprocess.Popen(
        [str(python), "-m", "robo_genesis.doctor"],
        cwd=folder,
        text=True,
        env={name: value for name, value in given.items() if value is not None},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


GENESIS, MINUTES = "genesis.py", "The first start of the engine takes minutes.\n"
DIES = "import os, signal\nos.kill(os.getpid(), signal.{})".format
CACHE = "QD_OFFLINE_CACHE_FILE_PATH"
MACHINES = [
    ({"__EGL_VENDOR_LIBRARY_DIRS": "."}, {}, "libraries", "of 0 devices libegl-mesa0 __EGL_"),
    ({"PYOPENGL_PLATFORM": "osmesa"}, {}, "libraries", "PYOPENGL_PLATFORM='osmesa' unset"),
    ({"HOME": None}, {}, "backend", "HOME export"),
    ({CACHE: "f/x"}, {"f": ""}, "backend", CACHE),
    ({"ROBO_GENESIS_BACKEND": "µ", "PYTHONIOENCODING": "ascii"}, {}, "backend", "\\xb5 auto, cpu"),
    ({}, {GENESIS: "import genesis\ngenesis.cpu"}, "backend", "genesis.py rename"),
    ({}, {"random.py": "raise SystemExit"}, "version", "random.py rename"),
    ({"PYTHONPATH": "ros"}, {"ros/numpy/__init__.py": "raise ImportError"}, "version",
     "PYTHONPATH names ros, another numpy. Unset"),
    ({"LD_LIBRARY_PATH": "old"}, {"old/libEGL.so.1": "no library"}, "libraries",
     "LD_LIBRARY_PATH names old, another libEGL.so.1. Unset"),
    ({}, {GENESIS: DIES("SIGKILL")}, "backend", "SIGKILL memory"),
    ({}, {GENESIS: DIES("SIGBUS")}, "backend", "SIGBUS disk kernels"),
]  # fmt: skip


@pytest.mark.parametrize(("changed", "files", "step", "words"), MACHINES)
def test_a_machine_with_one_fault_is_named_with_its_step(
    tmp_path, changed, files, step, words
):
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    doctor = started(tmp_path, changed)
    said, error = doctor.communicate()
    assert f"DOCTOR: step {NAMES.index(step) + 1}, {step}, is broken" in said
    assert [word for word in words.split() if word not in said] == []
    assert (doctor.returncode, error) == (1, MINUTES)


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_end_by_signal_ends_the_step_that_was_begun(tmp_path, sent):
    (tmp_path / GENESIS).write_text("import time\ntime.sleep(60)")
    process = started(tmp_path)
    begun = ""
    while not begun.endswith(" 3/11  backend  "):  # written before the step ends
        begun += process.stdout.read(1)
    below = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(sent)
    said, error = process.communicate()
    assert "DOCTOR: step 3, backend, is broken" in said
    assert sent.name in said
    assert (process.returncode, error) == (1, MINUTES)
    assert len(below) == len(psutil.wait_procs(below, timeout=5)[0]) == 1


def test_a_python_without_packages_is_named_with_the_right_one(tmp_path):
    venv.create(tmp_path / "bare", symlinks=True)
    said, error = started(tmp_path, python=tmp_path / "bare/bin/python").communicate()
    assert "ModuleNotFoundError" in said
    assert ".venv/bin/python, or run" in " ".join(said.split())
    assert error == MINUTES
