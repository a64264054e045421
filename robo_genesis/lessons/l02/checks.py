"""Named checks of a dropped box: all pass, or the exact invariant that failed is named."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate, wrong_stamps
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.metrics import DropMetrics, fallen
from robo_genesis.sim import end_state as postures
from robo_genesis.sim.rigid_bodies import START_TOLERANCE, Drop

MASS_SHARE = 1e-5
"""What the engine's mass may differ from density times volume by, as a share: float32."""

SPEED_SHARE = 1e-5
"""What a speed may differ from g t by, as a share of the last: float32."""


@dataclass(frozen=True, slots=True)
class DropExperiment:
    """All that the checks of a drop look at.

    `model` counts entities of the scene, and links, geoms, joints, dofs and qpos of the box, as the
    engine reports them; `mass` is the engine's [kg]; `posture` says what shows the run's ends.
    """

    model: Mapping[str, int]
    mass: float
    cases: Mapping[str, Drop]
    traces: Mapping[str, BodyTrace]
    metrics: Mapping[str, DropMetrics]
    posture: str
    frames: Mapping[str, np.ndarray]


def structure(run: DropExperiment) -> list[str]:
    """The scene has two entities; the box is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    if dict(run.model) == spec.EXPECTED_MODEL:
        return []
    return [f"the model has {dict(run.model)}, expected {spec.EXPECTED_MODEL}"]


def mass(run: DropExperiment) -> list[str]:
    """The engine's mass is density times volume."""
    expected = spec.BASELINE.mass
    if abs(run.mass - expected) <= MASS_SHARE * expected:
        return []
    return [f"the engine's mass is {run.mass:g} kg, density times volume {expected:g} kg"]


def start(run: DropExperiment) -> list[str]:
    """Each run begins with the box at rest at the height that was asked for."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        height = float(trace.link_pos[0, 0, 2])
        if abs(height - case.height) > START_TOLERANCE:
            problems.append(f"{name} starts at {height:g} m, asked for {case.height:g} m")
        if trace.link_vel[0].any() or trace.link_ang[0].any():
            problems.append(f"{name} starts with velocity {trace.link_vel[0, 0].tolist()} m/s")
    return problems


def stamps(run: DropExperiment) -> list[str]:
    """The record has a state for t = 0 and for each outer step asked for, stamped k · dt."""
    return wrong_stamps(run.cases, run.traces)


def falls(run: DropExperiment) -> list[str]:
    """The box is lower after every step than before it, and faster."""
    problems = []
    for name, trace in run.traces.items():
        lower, faster = np.diff(fallen(trace)) > 0, np.diff(-trace.link_vel[:, 0, 2]) > 0
        for what, held in (("lower", lower), ("faster", faster)):
            if not held.all():
                problems.append(f"{name} is not {what} after step {int(np.argmin(held)) + 1}")
    return problems


def clear_of_ground(run: DropExperiment) -> list[str]:
    """The box's underside stays above the ground: what is measured is fall, not contact."""
    problems = []
    for name, case in run.cases.items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min()) - case.size / 2
        if lowest <= 0:
            problems.append(f"{name}: the underside comes down to {lowest:g} m")
    return problems


def stepped_formula(run: DropExperiment) -> list[str]:
    """At every sample the box has fallen g h² n (n + 1) / 2, to within float32."""
    return [
        f"{name} is up to {of.formula_error:g} m off, allowed are {spec.FORMULA_TOLERANCE:g} m"
        for name, of in run.metrics.items()
        if not of.formula_error <= spec.FORMULA_TOLERANCE
    ]


def speed(run: DropExperiment) -> list[str]:
    """At every sample the velocity is g t, downwards: one outer step is dt long."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        apart = float(np.abs(-trace.link_vel[:, 0, 2] - case.gravity * trace.t).max())
        if not apart <= SPEED_SHARE * case.gravity * trace.t[-1]:
            problems.append(f"{name} is up to {apart:g} m/s off g t")
    return problems


def straight_down(run: DropExperiment) -> list[str]:
    """Nothing pushes the box aside, and nothing turns it: its orientation stays the same."""
    problems = []
    for name, of in run.metrics.items():
        turned = run.traces[name].link_quat[:, 0]
        whole = np.abs(np.linalg.norm(turned, axis=1) - 1).max() <= spec.AT_REST
        same = np.abs(turned - turned[0]).max() <= spec.AT_REST
        if not (of.sideways <= spec.AT_REST and of.turning <= spec.AT_REST):
            problems.append(f"{name} moves {of.sideways:g} m aside and turns at up to "
                            f"{of.turning:g} rad/s")  # fmt: skip
        if not (whole and same):
            problems.append(f"{name} does not keep its orientation {turned[0].tolist()}")
    return problems


def posture(run: DropExperiment) -> list[str]:
    """The evidence of both ends says what it is, and shows the box in two places."""
    return postures.problems(run.posture, run.frames, run.traces["baseline"].link_pos)


def same_fall(ends: Mapping[str, float]) -> Check:
    """Return the check that boxes of other colour or density fall alike.

    Args:
        ends: height of each at the end [m].
    """
    first = next(iter(ends.values()))
    apart = [f"{name} ended {end - first:g} m from the first" for name, end in ends.items()
             if end != first]  # fmt: skip
    held = "Boxes of other colour or density fall alike, to the last bit."
    return Check("same_fall", not apart, "; ".join(apart) or held)


CHECKS: tuple[Callable[[DropExperiment], list[str]], ...] = (
    structure,
    mass,
    start,
    stamps,
    falls,
    clear_of_ground,
    stepped_formula,
    speed,
    straight_down,
    posture,
)


def run_checks(run: DropExperiment) -> tuple[Check, ...]:
    """Run every check; one that fails says what it found, one that passes what it held."""
    return evaluate(CHECKS, run)
