"""Named checks of a dropped box: all pass, or the exact invariant that failed is named."""

from itertools import pairwise

import numpy as np

from robo_genesis.core.checks import (
    Finding,
    Findings,
    above,
    at_most,
    equal,
    factors,
    masses,
    nearly,
    noted,
)
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.checks import structure
from robo_genesis.sim.bodies.free_fall import ahead_of_continuous, fallen
from robo_genesis.sim.bodies.laws import free_fall
from robo_genesis.sim.common_checks import posture, stamps, start

from . import spec


def speeds(trace: BodyTrace) -> FloatArray:
    """Return the speed downwards at each state, (n+1,) [m/s]."""
    return -trace.link_vel[:, 0, 2]


def mass(run: Experiment) -> Findings:
    """The engine's mass is density times volume."""
    return masses({"box": run.readings["body"]["mass"]}, {"box": spec.BASELINE.mass})


def falls(run: Experiment) -> Findings:
    """The box is lower after every step than before it, and faster."""
    for name, trace in run.traces.items():
        for what, values in (("lower", fallen(trace)), ("faster", speeds(trace))):
            not_more = (np.diff(values) <= 0).sum()
            yield equal(f"{name}.steps_not_{what}", not_more, 0)


def clear_of_ground(run: Experiment) -> Findings:
    """The box's underside stays above the ground: the run measures the fall, not a contact."""
    for name, case in run.cases.items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min()) - case.size / 2
        yield above(f"{name}.clearance_m", lowest, 0)


def stepped_formula(run: Experiment) -> Findings:
    """At every sample the box has fallen g h² n (n + 1) / 2, to within float32."""
    for name, of in run.metrics.items():
        yield at_most(
            f"{name}.formula_error_m", of.formula_error, spec.FORMULA_TOLERANCE
        )


def speed(run: Experiment) -> Findings:
    """At every sample the velocity is g t, downwards: one outer step is dt long."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        expected = case.gravity * trace.t
        error = np.abs(speeds(trace) - expected).max()
        yield noted(f"{name}.after_one_step_m_s", trace.link_vel[1, 0, 2])
        yield at_most(f"{name}.speed_error_m_s", error, spec.SPEED_SHARE * expected[-1])


def straight_down(run: Experiment) -> Findings:
    """The box moves vertically and keeps its orientation."""
    for name, of in run.metrics.items():
        quat = run.traces[name].link_quat[:, 0].astype(np.float64)
        yield at_most(f"{name}.sideways_m", of.sideways, spec.AT_REST)
        yield at_most(f"{name}.turning_rad_s", of.turning, spec.AT_REST)
        yield at_most(
            f"{name}.quaternion_change", np.abs(quat - quat[0]).max(), spec.AT_REST
        )


# How far a stepped fall is from continuous free fall as the solver step shrinks


def by_step(run: Experiment) -> list[str]:
    """Return the names of the runs, from the largest solver step to the smallest."""
    return sorted(run.cases, key=lambda name: -run.cases[name].h)


def expected_gap(run: Experiment, name: str) -> float:
    """Return g h t / 2: how much farther than g t² / 2 the body of a run falls [m]."""
    case = run.cases[name]
    return ahead_of_continuous(case.h, run.metrics[name].duration, case.gravity)


def one_factor(run: Experiment) -> Findings:
    """The cases differ in their substeps alone."""
    first, *others = by_step(run)
    return factors(run.cases, {(first, name): ["substeps"] for name in others})


def shrinks(run: Experiment) -> Findings:
    """The gap to continuous free fall is smaller with every smaller solver step."""
    for coarse, fine in pairwise(by_step(run)):
        larger, gap = (run.metrics[name].continuous_gap for name in (coarse, fine))
        yield Finding(
            f"{fine}.gap_m", gap, 0 < gap < larger, f"between 0 and {larger:g}"
        )


def first_order(run: Experiment) -> Findings:
    """The gap is g h t / 2, so half the solver step leaves half of it."""
    for name in by_step(run):
        gap, expected = run.metrics[name].continuous_gap, expected_gap(run, name)
        yield nearly(f"{name}.gap_m", gap, expected, spec.FIRST_ORDER_SHARE)


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

# Those that the lecture has besides.
BY_STEP = (one_factor, shrinks, first_order)
