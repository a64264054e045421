"""Named checks of a dropped box: all pass, or the exact invariant that failed is named."""

from collections.abc import Iterator, Mapping

import numpy as np

from robo_genesis.core.checks import Check, wrong_counts, wrong_masses, wrong_times
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.metrics import fallen
from robo_genesis.sim import end_state
from robo_genesis.sim.rigid_bodies import START_TOLERANCE

SPEED_SHARE = 1e-5
"""Tolerance of a speed against g t, as a share of the last speed: float32."""


def structure(run: Experiment) -> Iterator[str]:
    """The scene has two entities; the box is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return wrong_counts(run.readings["model"], spec.EXPECTED_MODEL)


def mass(run: Experiment) -> Iterator[str]:
    """The engine's mass is density times volume."""
    return wrong_masses({"box": run.readings["body"]["mass"]}, {"box": spec.BASELINE.mass})


def start(run: Experiment) -> Iterator[str]:
    """Each run begins with the box at rest at the height of its case."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        height = float(trace.link_pos[0, 0, 2])
        if abs(height - case.height) > START_TOLERANCE:
            yield f"{name} starts at {height:g} m, expected {case.height:g} m"
        if trace.link_vel[0].any() or trace.link_ang[0].any():
            yield f"{name} starts with velocity {trace.link_vel[0, 0].tolist()} m/s"


def stamps(run: Experiment) -> Iterator[str]:
    """The record has one state at t = 0 and one after each outer step, at the times k · dt."""
    return wrong_times(run.cases, run.traces)


def falls(run: Experiment) -> Iterator[str]:
    """The box is lower after every step than before it, and faster."""
    for name, trace in run.traces.items():
        lower, faster = np.diff(fallen(trace)) > 0, np.diff(-trace.link_vel[:, 0, 2]) > 0
        for change, observed in (("lower", lower), ("faster", faster)):
            if not observed.all():
                yield f"{name} is not {change} after step {int(np.argmin(observed)) + 1}"


def clear_of_ground(run: Experiment) -> Iterator[str]:
    """The box's underside stays above the ground: the run measures the fall, not a contact."""
    for name, case in run.cases.items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min()) - case.size / 2
        if lowest <= 0:
            yield f"{name}: the underside reaches {lowest:g} m"


def stepped_formula(run: Experiment) -> Iterator[str]:
    """At every sample the box has fallen g h² n (n + 1) / 2, to within float32."""
    allowed = spec.FORMULA_TOLERANCE
    for name, of in run.metrics.items():
        if not of.formula_error <= allowed:
            yield f"{name} is up to {of.formula_error:g} m off, allowed are {allowed:g} m"


def speed(run: Experiment) -> Iterator[str]:
    """At every sample the velocity is g t, downwards: one outer step is dt long."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        error = float(np.abs(-trace.link_vel[:, 0, 2] - case.gravity * trace.t).max())
        if not error <= SPEED_SHARE * case.gravity * trace.t[-1]:
            yield f"{name} is up to {error:g} m/s off g t"


def straight_down(run: Experiment) -> Iterator[str]:
    """The box moves vertically and keeps its orientation."""
    for name, of in run.metrics.items():
        quat = run.traces[name].link_quat[:, 0]
        unit = np.abs(np.linalg.norm(quat, axis=1) - 1).max() <= spec.AT_REST
        same = np.abs(quat - quat[0]).max() <= spec.AT_REST
        if not (of.sideways <= spec.AT_REST and of.turning <= spec.AT_REST):
            yield (
                f"{name} moves {of.sideways:g} m sideways and turns at up to {of.turning:g} rad/s"
            )
        if not (unit and same):
            yield f"{name} does not keep its orientation {quat[0].tolist()}"


def posture(run: Experiment) -> list[str]:
    """The evidence of the first and the last state is complete and shows the box in two places."""
    return end_state.problems(run.rendered, run.frames, run.traces["baseline"].link_pos)


def same_fall(ends: Mapping[str, float]) -> Check:
    """Check that boxes of different colour or density fall alike.

    Args:
        ends: final height of each box [m]; the first one is the reference.
    """
    first = next(iter(ends.values()))
    problems = [
        f"{name} ended {end - first:g} m from the first"
        for name, end in ends.items()
        if end != first
    ]
    passed = "Boxes of different colour or density fall alike, to the last bit."
    return Check("same_fall", not problems, "; ".join(problems) or passed)


CHECKS = (
    structure, mass, start, stamps, falls, clear_of_ground, stepped_formula, speed, straight_down,
    posture,
)  # fmt: skip
