"""The steps between an installed course and a measured run, in the order of a diagnosis."""

import os
import platform
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

import numpy as np

from robo_genesis.core import project
from robo_genesis.core.quantities import format_value
from robo_genesis.core.scene import (
    CAMERA,
    DT,
    EFFORT_LIMIT,
    FRANKA_MJCF,
    FRANKA_MODEL,
    FRANKA_TYPES,
    JOINT_NAMES,
    KP_BASELINE,
    KV_BASELINE,
    Q_START,
    SUBSTEPS,
)
from robo_genesis.core.trace import TraceError
from robo_genesis.sim import joint_control, session
from robo_genesis.sim import joints as robot_model

STEPPED_JOINT, STEP = "joint4", 0.25
"""The joint that the run commands, and by how much [rad]."""

BASELINE = joint_control.ControlCase(
    q_start=Q_START,
    q_target=Q_START + STEP * np.equal(JOINT_NAMES, STEPPED_JOINT),
    kp=KP_BASELINE,
    kv=KV_BASELINE,
    effort_limit=EFFORT_LIMIT,
    steps=120,
)

AT_LIMIT = 0.99
"""Share of the effort limit from which a sample counts as clipped."""


class LinkError(RuntimeError):
    """A link of the chain is broken; the message says what was found and what to do."""


@dataclass(slots=True)
class Bench:
    """What the links have made so far; each fills in what later ones look at."""

    environ: Mapping[str, str]
    contract: Any = None
    engine: Any = None
    scene: Any = None
    robot: Any = None
    camera: Any = None
    joints: Any = None
    trace: Any = None


@dataclass(frozen=True, slots=True)
class Finding:
    """What came of one link: `state` is ok, broken or not run."""

    link: str
    state: str
    found: str


def version(bench: Bench) -> str:
    """The pinned engine is the installed one."""
    pin = project.require_pinned_engine()
    return f"{project.ENGINE} {pin}, as pinned; Python {platform.python_version()}"


def libraries(bench: Bench) -> str:
    """EGL and OpenGL can be loaded, which the engine needs even without a camera."""
    if sys.platform != "linux":
        return f"not looked for on {sys.platform}"
    names = ("libEGL.so.1", "libGL.so.1")
    session.require_libraries(*names)
    return f"{' and '.join(names)} can be loaded"


def backend(bench: Bench) -> str:
    """The environment asks for something valid, and the engine starts there."""
    bench.contract = session.read_contract(bench.environ)
    for name, value in project.engine_cache_environment().items():
        os.environ.setdefault(name, value)  # what `make book` compiled need not be compiled again
    bench.engine = session.start(bench.contract)
    found = bench.engine.backend
    return f"asked for {found.requested}, found {found.actual} ({found.device_name})"


def model_file(bench: Bench) -> str:
    """The robot's model is where the engine looks for it."""
    place = f"genesis/assets/{FRANKA_MJCF}"
    if not Path(str(distribution(project.ENGINE).locate_file(place))).is_file():
        pin = project.engine_pin()
        raise LinkError(
            f"{project.ENGINE} has no file {place}. "
            f"Install it again: {sys.executable} -m pip install --force-reinstall --no-deps "
            f"{project.ENGINE}=={pin}"
        )
    return FRANKA_MJCF


def build(bench: Bench) -> str:
    """Entities and camera come before build, joint calls after it."""
    gs = session.import_engine()
    bench.scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False
    )
    bench.scene.add_entity(gs.morphs.Plane())
    bench.robot = bench.scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    bench.camera = bench.scene.add_camera(**CAMERA) if bench.contract.render else None
    bench.scene.build()
    if not bench.scene.is_built:
        raise LinkError("scene.build() returned, but the scene is not built. Restart Python.")
    return f"scene of {len(bench.scene.entities)} entities built, dt {DT:g} s, {SUBSTEPS} substeps"


def render(bench: Bench) -> str:
    """A camera gives a usable picture; without one, nothing is looked at."""
    if bench.camera is None:
        return "SKIP: ROBO_GENESIS_RENDER=0, no camera"
    shape = session.capture(bench.camera).shape
    renderer = session.read_renderer(bench.scene)
    how = "in software" if renderer.software else "on a GPU"
    return f"frame of shape {shape}, drawn {how} by {renderer.name}"


def names(bench: Bench) -> str:
    """Nine joints are found by name, with the expected DOFs, types and limits."""
    robot = bench.robot
    bench.joints = robot_model.resolve_joints(robot, JOINT_NAMES)
    counts = (robot.n_links, robot.n_joints, robot.n_dofs, robot.n_qs)
    model = dict(zip(FRANKA_MODEL, counts, strict=True))
    if model != FRANKA_MODEL or bench.joints.types != FRANKA_TYPES:
        raise LinkError(
            f"The model has {model} and joints {', '.join(bench.joints.types)}; expected "
            f"{FRANKA_MODEL} and {', '.join(FRANKA_TYPES)}. Check model and version."
        )
    lower, upper = bench.joints.lower, bench.joints.upper
    if not (np.isfinite(lower).all() and np.isfinite(upper).all() and (lower < upper).all()):
        raise LinkError(f"Limits {lower} to {upper} are no ranges. Check model and version.")
    return f"{len(JOINT_NAMES)} joints by name, {model['dofs']} DOFs, every limit a range"


def target(bench: Bench) -> str:
    """Start, target, gains and limits have one valid value for each joint."""
    joint_control.validate(BASELINE, bench.joints)
    return "baseline: one finite value for each joint, start and target within limits"


def reset(bench: Bench) -> str:
    """After a reset the engine reads back what was set, at rest."""
    joint_control.reset(bench.scene, bench.robot, bench.joints, BASELINE)
    return "gains, effort range and start read back as set, velocity zero"


def stamps(bench: Bench) -> str:
    """A run gives finite arrays with one stamp for each state."""
    try:
        bench.trace = joint_control.run_case(bench.scene, bench.robot, bench.joints, BASELINE)
    except TraceError as error:
        raise LinkError(
            f"{error} Look at reset, start, gains and dt before the reading."
        ) from error
    t = bench.trace.t
    return f"{bench.trace.steps} steps, {len(t)} states from {t[0]:g} to {t[-1]:g} s, all finite"


def saturation(bench: Bench) -> str:
    """The baseline comes nearer to its target, and is not clipped all the way."""
    trace, k = bench.trace, bench.joints.entry(STEPPED_JOINT)
    error = np.abs(trace.target[0, k] - trace.q[:, k])  # (n+1,)
    at_limit = np.abs(trace.control_force[:, k]) >= AT_LIMIT * trace.effort_limit[k]  # (n,)
    clipped = f"{at_limit.sum()} of {trace.steps} samples at the effort limit"
    errors = " to ".join(format_value(float(e), "rad") for e in error[[0, -1]])
    if error[-1] >= error[0] or at_limit.all():
        raise LinkError(
            f"{clipped}; error of {STEPPED_JOINT} from {errors}. It comes no nearer to its "
            "target in this window, or is clipped all the way: look at limit, gains and reset "
            "before you lengthen the window."
        )
    return f"{clipped}; error of {STEPPED_JOINT} from {errors} in {bench.trace.t[-1]:g} s"


LINKS: tuple[Callable[[Bench], str], ...] = (
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
"""In the lesson's order: what a link needs stands before it."""

OWN_ERRORS = (
    LinkError,
    project.ProjectError,
    session.ContractError,
    session.EngineError,
    session.FrameError,
    robot_model.JointError,
    joint_control.CaseError,
)
"""Errors whose message says what to do."""


def examine(bench: Bench) -> tuple[Finding, ...]:
    """Look at one link after the other; after a broken one, look at none."""
    findings: list[Finding] = []
    for link in LINKS:
        if findings and findings[-1].state != "ok":
            findings.append(Finding(link.__name__, "not run", ""))
            continue
        try:
            findings.append(Finding(link.__name__, "ok", shareable(link(bench))))
        except Exception as error:  # any error is what the doctor is here to find
            findings.append(Finding(link.__name__, "broken", shareable(advice(error))))
    return tuple(findings)


def advice(error: Exception) -> str:
    """Return what an error says and what to do about it."""
    if isinstance(error, OWN_ERRORS):
        return str(error)
    return (
        f"{type(error).__name__}: {error}. The course does not know this error: search for its "
        "text among the engine's issues, and report it with the output of --json."
    )


def shareable(text: str) -> str:
    """Take folders out of a text: they name users. What is in the course keeps its place there."""
    known = {project.ROOT: "<course>", Path(sys.prefix): "<environment>", Path.home(): "~"}
    for folder in sorted(known, key=lambda path: -len(str(path))):
        if folder != Path(folder.anchor):
            text = text.replace(str(folder), known[folder])
    text = re.sub(r"([/\\](?:home|Users)[/\\])[^/\\\s'\"]+", r"\1…", text)
    return re.sub(r"(?<![\w.~>/-])/(?:[^/\s'\"]+/)+", "…/", text)
