"""The studies of L04 without Genesis."""

import io
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.core.scene import Q_START
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import plots, study_spec
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04 import study as studies
from robo_genesis.sim import mujoco_joints
from robo_genesis.sim.joints import JointMap

LINKS = ("link0", "link4", "hand")


@pytest.fixture(scope="session")
def study_runs(joints) -> studies.Studies:
    """Studies of L04 that pass every check, with MuJoCo in the place of both engines.

    Runs with a fine step replace those of Genesis. The overshoot of G2 falls with the substeps.
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
