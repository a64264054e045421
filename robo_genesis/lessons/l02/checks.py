"""Named checks of a dropped box: all pass, or the exact invariant that failed is named."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import (
    Finding,
    above,
    at_most,
    equal,
    masses,
    model_counts,
    noted,
)
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import spec
from robo_genesis.sim.bodies.free_fall import fallen
from robo_genesis.sim.bodies.laws import free_fall
from robo_genesis.sim.common_checks import posture, stamps, start


def speeds(trace: BodyTrace) -> FloatArray:
    """Return the speed downwards at each state, (n+1,) [m/s]."""
    return -trace.link_vel[:, 0, 2]


def structure(run: Experiment) -> Iterator[Finding]:
    """The scene has two entities; the box is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return model_counts(run.readings["model"], spec.EXPECTED_MODEL)


def mass(run: Experiment) -> Iterator[Finding]:
    """The engine's mass is density times volume."""
    return masses({"box": run.readings["body"]["mass"]}, {"box": spec.BASELINE.mass})


def falls(run: Experiment) -> Iterator[Finding]:
    """The box is lower after every step than before it, and faster."""
    for name, trace in run.traces.items():
        for what, values in (("lower", fallen(trace)), ("faster", speeds(trace))):
            not_more = int((np.diff(values) <= 0).sum())
            yield equal(f"{name}.steps_not_{what}", not_more, 0)


def clear_of_ground(run: Experiment) -> Iterator[Finding]:
    """The box's underside stays above the ground: the run measures the fall, not a contact."""
    for name, case in run.cases.items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min()) - case.size / 2
        yield above(f"{name}.clearance_m", lowest, 0)


def stepped_formula(run: Experiment) -> Iterator[Finding]:
    """At every sample the box has fallen g h² n (n + 1) / 2, to within float32."""
    for name, of in run.metrics.items():
        yield at_most(
            f"{name}.formula_error_m", of.formula_error, spec.FORMULA_TOLERANCE
        )


def speed(run: Experiment) -> Iterator[Finding]:
    """At every sample the velocity is g t, downwards: one outer step is dt long."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        expected = case.gravity * trace.t
        error = float(np.abs(speeds(trace) - expected).max())
        yield noted(f"{name}.after_one_step_m_s", float(trace.link_vel[1, 0, 2]))
        yield at_most(f"{name}.speed_error_m_s", error, spec.SPEED_SHARE * expected[-1])


def straight_down(run: Experiment) -> Iterator[Finding]:
    """The box moves vertically and keeps its orientation."""
    for name, of in run.metrics.items():
        quat = run.traces[name].link_quat[:, 0].astype(np.float64)
        length_error = np.abs(np.linalg.norm(quat, axis=1) - 1).max()
        yield at_most(f"{name}.sideways_m", of.sideways, spec.AT_REST)
        yield at_most(f"{name}.turning_rad_s", of.turning, spec.AT_REST)
        yield at_most(f"{name}.quaternion_length_error", length_error, spec.AT_REST)
        yield at_most(
            f"{name}.quaternion_change", np.abs(quat - quat[0]).max(), spec.AT_REST
        )


CHECKS = (
    structure,
    mass,
    start,
    stamps,
    falls,
    clear_of_ground,
    stepped_formula,
    speed,
    straight_down,
    free_fall,
    posture,
)
