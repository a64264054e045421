"""Named checks of lesson L04's grid: as the single runs say, and nowhere more violent."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis import l04, l04_grid
from robo_genesis.checks import Check, evaluate
from robo_genesis.joint_control import differences
from robo_genesis.metrics import step_metrics
from robo_genesis.robot_model import JointMap
from robo_genesis.sweep import Sweep
from robo_genesis.trace import Trace


@dataclass(frozen=True, slots=True)
class Grid:
    """What the grid's checks look at: the sweep, and G1 to G3 run alone, by name."""

    found: Sweep
    alone: Mapping[str, Trace]
    joints: JointMap


def grid_matches_cases(grid: Grid) -> list[str]:
    """G1, G2 and G3 in the batch are what they are when run alone, within the declared margins."""
    k, found, problems = grid.joints.entry(l04.STEPPED_JOINT), grid.found, []
    for name, point in l04_grid.CASE_POINTS.items():
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
            f"{name}: {what} differs by more than {l04_grid.AGREEMENT[unit]:g} {unit}"
            for what, a, b, unit in pairs
            if not np.allclose(a, b, rtol=0, atol=l04_grid.AGREEMENT[unit], equal_nan=True)
        ]
    return problems


def grid_within_gains(grid: Grid) -> list[str]:
    """Every run keeps to the compared cases' gains and step, and varies nothing beside them."""
    joint, problems = l04.STEPPED_JOINT, []
    varied = {f"{field}[{joint}]" for field in ("kp", "kv", "q_target")}
    for case in grid.found.cases:
        point = l04_grid.point_of(case)
        for name, (low, high) in l04_grid.BOUNDS.items():
            value = getattr(point, name)
            if not low <= value <= high:
                problems.append(f"{name} = {value:g} is outside [{low:g}, {high:g}]")
        others = set(differences(l04.G1, case, grid.joints)) - varied
        if others:
            problems.append(f"{point} changes {sorted(others)}")
    return problems


CHECKS: tuple[Callable[[Grid], list[str]], ...] = (grid_matches_cases, grid_within_gains)


def run_checks(grid: Grid) -> tuple[Check, ...]:
    """Run both checks."""
    return evaluate(CHECKS, grid)
