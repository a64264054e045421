"""Runs without the engine for most tests; one real engine and one built scene for the rest."""

import io
import os
import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import settings
from matplotlib.figure import Figure

from robo_genesis.build import stages
from robo_genesis.core import plotting, project
from robo_genesis.core.free_fall import summed_drop
from robo_genesis.core.scene import (
    CAMERA,
    DT,
    FRAME_SHAPE,
    FRANKA_MJCF,
    JOINT_NAMES,
    Q_START,
    SUBSTEPS,
    per_joint,
)
from robo_genesis.core.trace import BodyTrace, Trace
from robo_genesis.lessons.l04 import checks as step_checks
from robo_genesis.lessons.l04 import plots, study_spec
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04 import study as studies
from robo_genesis.lessons.l04.metrics import measure
from robo_genesis.sim import joints as robot_model
from robo_genesis.sim import mujoco_joints, session
from robo_genesis.sim.joints import JointMap
from robo_genesis.sim.rigid_bodies import Drop

pytest_plugins = ("bundles", "built_site")

# Tests send it to the commands they start; a shell that starts pytest with & has it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time, and no time limit: shared machines stall.
settings.register_profile("course", derandomize=True, deadline=None)
settings.load_profile("course")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave tests of more than half an hour out unless `-m` names their marker."""
    named = config.option.markexpr
    left_out = [
        item
        for item in items
        if any(mark not in named and item.get_closest_marker(mark) for mark in ("repin", "slow"))
    ]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


LINKS = ("link0", "link4", "hand")
# Natural frequency [rad/s] and damping ratio of each synthetic case.
SHAPES = {"baseline": (20.0, 1.2), "G1": (20.0, 0.8), "G2": (28.0, 0.5), "G3": (28.0, 1.3)}


@pytest.fixture(scope="session")
def second_order() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Unit step response of y″ + 2ζω y′ + ω² y = ω² from rest, and its slope."""

    def response(t: np.ndarray, omega: float, zeta: float) -> tuple[np.ndarray, np.ndarray]:
        decay = np.exp(-zeta * omega * t)
        if zeta == 1:
            return 1 - decay * (1 + omega * t), omega**2 * t * decay
        r = omega * np.sqrt(complex(zeta**2 - 1))
        y = 1 - decay * (np.cosh(r * t) + zeta * omega / r * np.sinh(r * t))
        return y.real, (omega**2 / r * decay * np.sinh(r * t)).real

    return response


@pytest.fixture(scope="session")
def make_trace() -> Callable[..., Trace]:
    """Build a run of one joint from its positions; what is not given is zero."""

    def build(
        q: Any,
        target: Any,
        *,
        dt: float = DT,
        qd: Any = 0.0,
        control_force: Any = 0.0,
        effort_limit: float = 87.0,
    ) -> Trace:
        q = np.asarray(q)[:, None]
        n = len(q) - 1

        def column(values: Any) -> np.ndarray:
            return np.broadcast_to(np.asarray(values, dtype=float), (n,))[:, None]

        return Trace(
            t=np.arange(n + 1) * dt,
            q=q,
            qd=column(qd),
            target=column(target),
            control_force=column(control_force),
            internal_force=column(0.0),
            start_control_force=np.zeros(1),
            start_qd=np.zeros(1),
            effort_limit=np.array([effort_limit]),
            link_pos=np.zeros((n + 1, 1, 3)),
            link_quat=np.zeros((n + 1, 1, 4)),
        )

    return build


@pytest.fixture(scope="session")
def joints() -> JointMap:
    """The Franka's map as the engine reports it."""
    return JointMap(
        names=JOINT_NAMES,
        types=l04.EXPECTED_TYPES,
        dofs_idx_local=np.arange(9),
        qs_idx_local=np.arange(9),
        lower=per_joint(-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973, 0, 0),
        upper=per_joint(2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973, 0.04, 0.04),
    )


@pytest.fixture(scope="session")
def make_run(second_order) -> Callable[..., Trace]:
    """Make a synthetic run of a case of L04: float32 as from the engine, efforts clipped."""

    def run(name: str, omega: float, zeta: float) -> Trace:
        case, t = l04.CASES[name], np.arange(l04.STEPS + 1) * DT
        y, yd = second_order(t, omega, zeta)
        step = case.q_target - case.q_start
        q = (case.q_start + y[:, None] * step).astype(np.float32)
        qd = (yd[:, None] * step).astype(np.float32)
        demand = case.kp * (case.q_target - q) - case.kv * qd
        effort = np.clip(demand, -case.effort_limit, case.effort_limit).astype(np.float32)
        link_pos = np.zeros((len(t), len(LINKS), 3), np.float32)
        link_pos[:, 1:, 2] = 0.5
        link_pos[:, 2, 0] = y
        return Trace(
            t=t,
            q=q,
            qd=qd[1:],
            target=np.tile(case.q_target, (l04.STEPS, 1)),
            control_force=effort[1:],
            internal_force=effort[1:] / 2,
            start_control_force=effort[0],
            start_qd=qd[0],
            effort_limit=case.effort_limit.astype(np.float32),
            link_pos=link_pos,
            link_quat=np.tile(np.float32([1, 0, 0, 0]), (len(t), len(LINKS), 1)),
        )

    return run


@pytest.fixture(scope="session")
def traces(make_run) -> dict[str, Trace]:
    """Synthetic runs of the four cases of L04."""
    return {name: make_run(name, *SHAPES[name]) for name in l04.CASES}


@pytest.fixture(scope="session")
def make_drop() -> Callable[[Drop], BodyTrace]:
    """Build a dropped box that follows the stepped formula in float32."""

    def build(case: Drop) -> BodyTrace:
        t = np.arange(case.steps + 1) * case.dt
        position = np.zeros((len(t), 1, 3), np.float32)
        n = case.substeps * np.arange(len(t))
        position[:, 0, 2] = case.height - summed_drop(case.h, n, case.gravity)
        velocity = np.zeros_like(position)
        velocity[:, 0, 2] = -case.gravity * t
        upright = np.zeros((len(t), 1, 4), np.float32)
        upright[..., 0] = 1
        return BodyTrace(t, position, upright, velocity, np.zeros_like(position))

    return build


@pytest.fixture(scope="session")
def frames() -> dict[str, np.ndarray]:
    """Two different pictures of the course's shape."""
    initial = np.arange(np.prod(FRAME_SHAPE), dtype=np.uint32).astype(np.uint8).reshape(FRAME_SHAPE)
    final = initial.copy()
    final[200:300] += 1
    return {"initial": initial, "final": final}


@pytest.fixture(scope="session")
def experiment(joints, traces, frames) -> step_checks.StepExperiment:
    """A synthetic L04 run that passes every check."""
    return step_checks.StepExperiment(
        joints=joints,
        model=l04.EXPECTED_MODEL,
        cases=l04.CASES,
        traces=traces,
        metrics=measure(traces, l04.CASES, joints.entry(l04.STEPPED_JOINT)),
        posture="camera",
        frames=frames,
    )


@pytest.fixture(scope="session")
def study_runs(joints) -> studies.Studies:
    """The studies of L04 in order, with MuJoCo in the place of both engines.

    Genesis is played at a fine step, and G2's overshoot is made to fall with the substeps.
    """
    k = joints.entry(l04.STEPPED_JOINT)
    cases = l04.CASES | study_spec.STEP_CASES
    traces = {name: mujoco_joints.run_case(case, LINKS, 0.0005) for name, case in cases.items()}
    for name, run in study_spec.SECOND_RUNS.items():
        case = l04.CASES[run.case]
        traces[name] = mujoco_joints.run_case(case, LINKS, run.timestep, run.integrator)
    falling = (0.06, 0.05, 0.04, 0.03, 0.025, 0.023)
    for n, overshoot in zip(study_spec.SUBSTEPS_STUDIED, falling, strict=True):
        q = np.array(traces["G2"].q)
        q[q[:, k].argmax(), k] = traces["G2"].target[0, k] + overshoot
        traces[studies.run_name("Genesis", "G2", n)] = replace(traces["G2"], q=q)
    inertia, gravity = (float(v[k]) for v in mujoco_joints.at_rest(l04.G1, Q_START))
    return studies.Studies(
        joints=joints,
        traces=traces,
        inertia=dict.fromkeys(("Genesis", "MuJoCo"), inertia),
        gravity_at_start=dict.fromkeys(("Genesis", "MuJoCo"), gravity),
        passive_damping=1.0,
        gravity={
            name: float(mujoco_joints.at_rest(case, traces[name].q[-1])[1][k])
            for name, case in l04.CASES.items()
        },
    )


@pytest.fixture(scope="module")
def real_engine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SimpleNamespace]:
    """Real engine, started in this process.

    It holds the lock of builds: one that starts meanwhile would take the engine's lock files for
    stale. Module scope gives the lock back before the tests of the site build theirs.
    """
    contract = session.Contract("cpu", True, tmp_path_factory.mktemp("outputs"))
    with stages.only_build(project.CACHE), pytest.MonkeyPatch.context() as patch:
        for name, value in project.engine_cache_environment().items():
            patch.setitem(os.environ, name, value)
        engine = session.start(contract)
        import genesis as gs

        yield SimpleNamespace(gs=gs, contract=contract, engine=engine)
        gs.destroy()  # saves the compiled kernels while the log can still be written


@pytest.fixture(scope="module")
def lab(real_engine: SimpleNamespace) -> SimpleNamespace:
    """The scene of L04's lab, built once."""
    gs = real_engine.gs
    scene = gs.Scene(sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False)
    scene.add_entity(gs.morphs.Plane())
    franka = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    camera = scene.add_camera(**CAMERA)
    scene.build()
    return SimpleNamespace(
        **vars(real_engine),
        scene=scene,
        franka=franka,
        camera=camera,
        joints=robot_model.resolve_joints(franka, JOINT_NAMES),
    )


@pytest.fixture
def draw_svg(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., bytes]]:
    """Draw the response of joint4 in the course's style, as the bytes of an SVG file."""
    monkeypatch.setitem(sys.modules, "matplotlib_inline.backend_inline", None)

    def draw(traces: dict[str, Trace], joints: JointMap) -> bytes:
        figure, stream = Figure(), io.BytesIO()
        plots.response(figure.subplots(3, 1), traces, joints, l04.STEPPED_JOINT)
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
        return stream.getvalue()

    with mpl.rc_context():
        plotting.use_course_style()
        yield draw


@pytest.fixture
def no_file(tmp_path: Path) -> Path:
    """A path that nobody may create, root included: its parent is a regular file."""
    (tmp_path / "file").write_text("")
    return tmp_path / "file" / "below"
