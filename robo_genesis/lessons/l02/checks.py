"""Named checks of a dropped box: all pass, or the exact invariant that failed is named."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate, wrong_counts, wrong_masses, wrong_times
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.metrics import DropMetrics, fallen
from robo_genesis.sim import end_state
from robo_genesis.sim.rigid_bodies import START_TOLERANCE, Drop

SPEED_SHARE = 1e-5
"""Tolerance of a speed against g t, as a share of the last speed: float32."""


@dataclass(frozen=True, slots=True)
class DropExperiment:
    """The data that the checks of a drop examine.

    `model` counts the scene's entities and the box's links, geoms, joints, dofs and qpos, as the
    engine reports them; `mass` is the engine's [kg]. `end_state` names the evidence of the first
    and the last state: `camera` or `schematic`.
    """

    model: Mapping[str, int]
    mass: float
    cases: Mapping[str, Drop]
    traces: Mapping[str, BodyTrace]
    metrics: Mapping[str, DropMetrics]
    end_state: str
    frames: Mapping[str, np.ndarray]


def structure(run: DropExperiment) -> list[str]:
    """The scene has two entities; the box is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return wrong_counts(run.model, spec.EXPECTED_MODEL)


def mass(run: DropExperiment) -> list[str]:
    """The engine's mass is density times volume."""
    return wrong_masses({"box": run.mass}, {"box": spec.BASELINE.mass})


def start(run: DropExperiment) -> list[str]:
    """Each run begins with the box at rest at the height of its case."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        height = float(trace.link_pos[0, 0, 2])
        if abs(height - case.height) > START_TOLERANCE:
            problems.append(f"{name} starts at {height:g} m, expected {case.height:g} m")
        if trace.link_vel[0].any() or trace.link_ang[0].any():
            problems.append(f"{name} starts with velocity {trace.link_vel[0, 0].tolist()} m/s")
    return problems


def stamps(run: DropExperiment) -> list[str]:
    """The record has one state at t = 0 and one after each outer step, at the times k · dt."""
    return wrong_times(run.cases, run.traces)


def falls(run: DropExperiment) -> list[str]:
    """The box is lower after every step than before it, and faster."""
    problems = []
    for name, trace in run.traces.items():
        lower, faster = np.diff(fallen(trace)) > 0, np.diff(-trace.link_vel[:, 0, 2]) > 0
        for change, observed in (("lower", lower), ("faster", faster)):
            if not observed.all():
                problems.append(f"{name} is not {change} after step {int(np.argmin(observed)) + 1}")
    return problems


def clear_of_ground(run: DropExperiment) -> list[str]:
    """The box's underside stays above the ground: the run measures the fall, not a contact."""
    lowest = {
        name: float(run.traces[name].link_pos[:, 0, 2].min()) - case.size / 2
        for name, case in run.cases.items()
    }
    return [f"{name}: the underside reaches {z:g} m" for name, z in lowest.items() if z <= 0]


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
        error = float(np.abs(-trace.link_vel[:, 0, 2] - case.gravity * trace.t).max())
        if not error <= SPEED_SHARE * case.gravity * trace.t[-1]:
            problems.append(f"{name} is up to {error:g} m/s off g t")
    return problems


def straight_down(run: DropExperiment) -> list[str]:
    """The box moves vertically and keeps its orientation."""
    problems = []
    for name, of in run.metrics.items():
        quat = run.traces[name].link_quat[:, 0]
        unit = np.abs(np.linalg.norm(quat, axis=1) - 1).max() <= spec.AT_REST
        same = np.abs(quat - quat[0]).max() <= spec.AT_REST
        if not (of.sideways <= spec.AT_REST and of.turning <= spec.AT_REST):
            problems.append(f"{name} moves {of.sideways:g} m sideways and turns at up to "
                            f"{of.turning:g} rad/s")  # fmt: skip
        if not (unit and same):
            problems.append(f"{name} does not keep its orientation {quat[0].tolist()}")
    return problems


def posture(run: DropExperiment) -> list[str]:
    """The evidence of the first and the last state is complete and shows the box in two places."""
    return end_state.problems(run.end_state, run.frames, run.traces["baseline"].link_pos)


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


CHECKS: tuple[Callable[[DropExperiment], list[str]], ...] = (
    structure, mass, start, stamps, falls, clear_of_ground, stepped_formula, speed, straight_down,
    posture,
)  # fmt: skip


def run_checks(run: DropExperiment) -> tuple[Check, ...]:
    """Run all checks; the detail of each is what it found, or what it verified if it passed."""
    return evaluate(CHECKS, run)
