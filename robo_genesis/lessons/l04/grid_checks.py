"""Named checks of lesson L04's grid: as the single runs say, and nowhere more violent."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import grid_spec, spec
from robo_genesis.lessons.l04.batch import Sweep
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.sim.joint_control import differences
from robo_genesis.sim.joints import JointMap


@dataclass(frozen=True, slots=True)
class Grid:
    """What the grid's checks look at: the sweep, and G1 to G3 run alone, by name."""

    found: Sweep
    alone: Mapping[str, Trace]
    joints: JointMap


def grid_matches_cases(grid: Grid) -> list[str]:
    """G1, G2 and G3 in the batch are what they are when run alone, within the declared margins."""
    k, found, problems = grid.joints.entry(spec.STEPPED_JOINT), grid.found, []
    for name, point in grid_spec.CASE_POINTS.items():
        alone, number = grid.alone[name], found.at(point)
        pairs: list[tuple[str, Any, Any, str]] = [
            ("position", found.q[number], alone.q[:, k], "rad"),
            ("control force", found.control_force[number], alone.control_force[:, k], "N·m"),
        ]
        measured = step_metrics(alone, k)
        for (metric, a, unit), (_, b, _) in zip(
            found.metrics[number].items(), measured.items(), strict=True
        ):
            pairs.append((metric, np.nan if a is None else a, np.nan if b is None else b, unit))
        problems += [
            f"{name}: {what} differs by more than {grid_spec.AGREEMENT[unit]:g} {unit}"
            for what, a, b, unit in pairs
            if not np.allclose(a, b, rtol=0, atol=grid_spec.AGREEMENT[unit], equal_nan=True)
        ]
    return problems


def grid_within_gains(grid: Grid) -> list[str]:
    """Every run keeps to the compared cases' gains and step, and varies nothing beside them."""
    joint, problems = spec.STEPPED_JOINT, []
    varied = {f"{field}[{joint}]" for field in ("kp", "kv", "q_target")}
    for case in grid.found.cases:
        point = grid_spec.point_of(case)
        for name, (low, high) in grid_spec.BOUNDS.items():
            value = getattr(point, name)
            if not low <= value <= high:
                problems.append(f"{name} = {value:g} is outside [{low:g}, {high:g}]")
        others = set(differences(spec.G1, case, grid.joints)) - varied
        if others:
            problems.append(f"{point} changes {sorted(others)}")
    return problems


CHECKS: tuple[Callable[[Grid], list[str]], ...] = (grid_matches_cases, grid_within_gains)


def run_checks(grid: Grid) -> tuple[Check, ...]:
    """Run both checks."""
    return evaluate(CHECKS, grid)
