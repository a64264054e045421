"""The steps between an installed course and a measured run, in the order of a diagnosis."""

import os
import platform
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import requires
from pathlib import Path
from typing import Any, Literal

import numpy as np
from packaging.requirements import Requirement

from robo_genesis.core import project, scene
from robo_genesis.core.project import RENDER
from robo_genesis.core.text import format_value
from robo_genesis.core.trace import TraceError

from . import session
from .arm import franka, joint_control, model
from .arm import joints as robot_model
from .camera import frames as camera

# The joint that the run commands, and by how much [rad]
STEPPED_JOINT, ANGLE = "joint4", 0.25

BASELINE = joint_control.ControlCase(
    q_target=franka.Q_START + ANGLE * np.equal(franka.JOINT_NAMES, STEPPED_JOINT),
    steps=120,
)

AT_LIMIT = 0.99  # Share of the effort limit from which a sample counts as clipped


class StepError(RuntimeError):
    """A step failed; the message says what was found and what to do."""


@dataclass(slots=True)
class Bench:
    """The objects that the steps have made so far; later steps use them."""

    environ: Mapping[str, str]
    contract: Any = None
    engine: Any = None
    scene: Any = None
    robot: Any = None
    camera: Any = None
    joints: Any = None
    trace: Any = None


State = Literal["ok", "broken", "not run"]


@dataclass(frozen=True, slots=True)
class StepResult:
    """What one step found."""

    step: str
    state: State
    found: str


def version(bench: Bench) -> str:
    """The pinned engine is the installed one, with packages in the versions that it requires."""
    pin = project.require_pinned_engine()
    lines = [line for line in requires(project.ENGINE) or () if "extra ==" not in line]
    for need in map(Requirement, lines):
        found = project.installed_version(need.name)
        if found and not need.specifier.contains(found, prereleases=True):
            raise StepError(
                f"{need.name}{need.specifier} is required, installed is {found}. "
                f"Run {project.install_command()}"
            )
    return f"{project.ENGINE} {pin}, as pinned; Python {platform.python_version()}"


def libraries(bench: Bench) -> str:
    """OpenGL and EGL can be loaded, and EGL starts: the engine needs them even without a camera."""
    if sys.platform != "linux":
        return f"not checked on {sys.platform}"
    if (given := os.environ.get("PYOPENGL_PLATFORM", "egl")) != "egl":
        raise StepError(
            f"PYOPENGL_PLATFORM={given!r} does not work with the engine: unset it."
        )
    session.require_display(session.require_libraries())
    return f"{' and '.join(session.LIBRARIES)} can be loaded, and EGL starts"


def backend(bench: Bench) -> str:
    """The environment variables are valid, and the engine starts on the requested backend."""
    bench.contract = session.read_contract(bench.environ)
    if project.in_checkout():
        # reuse the kernels that `make book` compiled
        for name, value in project.engine_cache_environment().items():
            os.environ.setdefault(name, value)
    if not (os.environ.get("HOME") or os.environ.get("XDG_CACHE_HOME")):
        raise StepError(
            "HOME is not set, and the compiler ends without it: export HOME=folder"
        )
    for name, folder in project.cache_folders().items():
        session.require_writable(name, Path(folder))
    bench.engine = session.start(bench.contract)
    found = bench.engine.backend
    return f"asked for {found.requested}, found {found.actual} ({found.device_name})"


def model_file(bench: Bench) -> str:
    """The robot's model is where the engine looks for it."""
    model.model_file(franka.FRANKA_MJCF)
    return franka.FRANKA_MJCF


def build(bench: Bench) -> str:
    """Entities and camera come before build, joint calls after it."""
    gs = session.import_engine()
    bench.scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=scene.DT, substeps=scene.SUBSTEPS),
        show_viewer=False,
    )
    bench.scene.add_entity(gs.morphs.Plane())
    bench.robot = bench.scene.add_entity(gs.morphs.MJCF(file=franka.FRANKA_MJCF))
    bench.camera = (
        bench.scene.add_camera(**scene.CAMERA) if bench.contract.render else None
    )
    bench.scene.build()
    count, substeps = len(bench.scene.entities), scene.SUBSTEPS
    return f"scene of {count} entities built, dt {scene.DT:g} s, {substeps} substeps"


def render(bench: Bench) -> str:
    """The camera, if there is one, returns a usable picture."""
    if bench.camera is None:
        return f"SKIP: {RENDER}=0, no camera"
    shape = camera.capture(bench.camera).shape
    renderer = camera.read_renderer(bench.scene)
    how = "in software" if renderer.software else "on a GPU"
    return f"frame of shape {shape}, drawn {how} by {renderer.name}"


def names(bench: Bench) -> str:
    """Nine joints are found by name, with the expected DOFs and types."""
    robot = bench.robot
    bench.joints = robot_model.resolve_joints(robot, franka.JOINT_NAMES)
    model = robot_model.read_counts(robot)
    if model != franka.MODEL_COUNTS or bench.joints.types != franka.JOINT_TYPES:
        raise StepError(
            f"The model has {model} and joints {', '.join(bench.joints.types)}; expected "
            f"{franka.MODEL_COUNTS} and {', '.join(franka.JOINT_TYPES)}. Check model and version."
        )
    return f"{len(franka.JOINT_NAMES)} joints by name, {model['dofs']} DOFs"


def target(bench: Bench) -> str:
    """Start, target, gains and limits have one valid value for each joint."""
    joint_control.validate(BASELINE, bench.joints)
    return "baseline: one finite value for each joint, start and target within limits"


def reset(bench: Bench) -> str:
    """After a reset the engine reads back what was set, at rest."""
    joint_control.reset(bench.scene, bench.robot, bench.joints, BASELINE)
    return "gains, effort range and start read back as set, velocity zero"


def stamps(bench: Bench) -> str:
    """A run gives finite arrays with one time for each state."""
    try:
        bench.trace = joint_control.run_case(
            bench.scene, bench.robot, bench.joints, BASELINE
        )
    except TraceError as error:
        raise StepError(
            f"{error} Check reset, start, gains and dt before the getters."
        ) from error
    t = bench.trace.t
    return f"{bench.trace.steps} steps, {len(t)} states from {t[0]:g} to {t[-1]:g} s, all finite"


def saturation(bench: Bench) -> str:
    """The baseline approaches its target, and its effort is not clipped at every sample."""
    trace, k = bench.trace, bench.joints.entry(STEPPED_JOINT)
    error = np.abs(trace.target[0, k] - trace.q[:, k])  # (n+1,)
    # (n,)
    at_limit = np.abs(trace.control_force[:, k]) >= AT_LIMIT * trace.effort_limit[k]
    clipped = f"{at_limit.sum()} of {trace.steps} samples at the effort limit"
    errors = " to ".join(format_value(e, "rad") for e in error[[0, -1]])
    if error[-1] >= error[0] or at_limit.all():
        raise StepError(
            f"{clipped}; error of {STEPPED_JOINT} from {errors}. The joint does not approach "
            "its target in this window, or every sample is clipped. Check limit, gains and reset "
            "before you lengthen the window."
        )
    return (
        f"{clipped}; error of {STEPPED_JOINT} from {errors} in {bench.trace.t[-1]:g} s"
    )


# In the order of the lesson: each step comes after the steps that it needs.
STEPS = (
    version,
    libraries,
    backend,
    model_file,
    build,
    render,
    names,
    target,
    reset,
    stamps,
    saturation,
)


def run_steps(
    steps: Sequence[Callable[[Any], str]], subject: Any
) -> Iterator[StepResult]:
    """Run steps in order and yield the result of each; after a broken one, run none.

    Args:
        steps: each returns what it found, or raises an error that says what to do.
        subject: what all steps look at, and where they leave what later steps need.
    """
    state: State = "ok"
    for step in steps:
        found = ""
        if state != "ok":
            state = "not run"
        else:
            try:
                found = step(subject)
            except Exception as error:  # any error is reported
                state, found = "broken", advice(error)
        yield StepResult(step.__name__, state, found)


def advice(error: Exception) -> str:
    """Return the message of an error and what to do; the course's own messages say both."""
    if type(error).__module__.startswith("robo_genesis."):
        return str(error)
    name = f"{type(error).__name__}: {error}"
    if project.hidden_modules():
        return f"{name}. {project.import_advice()}"
    return (
        f"{name}. The course does not know this error: search for its "
        "text among the engine's issues, and report it with the output of --json."
    )
