"""Named checks of L04's studies: theory, gravity, solver step, second engine, grid of steps."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.orderings import HELD
from robo_genesis.core.quantities import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.batch import Sweep
from robo_genesis.lessons.l04.metrics import is_saturated, step_metrics
from robo_genesis.lessons.l04.study import ENGINES, Studies, relation_outcome
from robo_genesis.lessons.l04.text import AT_REST
from robo_genesis.lessons.l04.theory import overshoot_share
from robo_genesis.sim.joint_control import differences
from robo_genesis.sim.joints import JointMap


def study_factors(run: Studies) -> list[str]:
    """Each study case differs from its compared case in one factor: target or substeps."""
    cases = study_spec.STEP_CASES | study_spec.SUBSTEP_CASES
    problems = []
    for name, case in cases.items():
        compared = name.split("_")[0]
        step = name in study_spec.STEP_CASES
        expected = [f"q_target[{spec.STEPPED_JOINT}]" if step else "substeps"]
        found = differences(study_spec.COMPARED[compared], case, run.joints)
        if found != expected:
            problems.append(f"{compared} → {name} changes {found}, expected {expected}")
        if (run.traces[name].target != case.q_target).any():
            problems.append(f"{name} was not commanded its own target")
    return problems


def same_model(run: Studies) -> list[str]:
    """Both engines give the same inertia and gravity effort for the stepped joint at the start."""
    problems = []
    for what, values in (("inertia", run.inertia), ("gravity effort", run.gravity_at_start)):
        first, second = values["Genesis"], values["MuJoCo"]
        if not abs(first - second) <= study_spec.SAME_MODEL * abs(second):
            problems.append(f"{what}: Genesis {first:.4f}, MuJoCo {second:.4f}")
    return problems


def small_step_unsaturated(run: Studies) -> list[str]:
    """No effort of the small steps and of the hold runs reaches the saturation threshold."""
    problems = []
    for name in study_spec.STEP_CASES:
        trace = run.traces[name]
        start = trace.start_control_force[run.entry]
        efforts = np.append(start, trace.control_force[:, run.entry])
        if is_saturated(efforts, trace.effort_limit[run.entry]).any():
            problems.append(f"{name}: effort reaches {np.abs(efforts).max():.1f} N·m")
    return problems


def theory_small_step(run: Studies) -> list[str]:
    """Theory predicts a small step's overshoot, and its curve better than a large step's."""
    problems = []
    for case in study_spec.SMALL_STEPPED:
        ideal = run.ideal(case)
        small, large = run.share(case, "small"), run.share(case)
        difference = abs(overshoot_share(small) - ideal.overshoot)
        if not difference <= study_spec.SMALL_STEP_TOLERANCE:
            problems.append(f"{case}: overshoot is {difference:.3f} of the step off the ideal one")
        response = ideal.response(run.traces[case].t)
        if not np.abs(small - response).max() < np.abs(large - response).max():
            problems.append(f"{case}: the small step's curve is not nearer to the ideal one")
    return problems


def gravity_support(run: Studies) -> list[str]:
    """Where a case ends nearly at rest, KP × final error agrees with the gravity effort."""
    problems, compared = [], 0
    for case, effort in run.gravity.items():
        m = run.measure(case)
        if abs(m.final_velocity) > AT_REST:
            continue
        compared += 1
        support = float(spec.CASES[case].kp[run.entry]) * m.final_error
        if not abs(support - effort) <= study_spec.GRAVITY_AGREEMENT * abs(effort):
            problems.append(f"{case}: {support:.2f} N·m of support, gravity {effort:.2f} N·m")
    return problems if compared else ["no case ends nearly at rest, so nothing could be compared"]


def convergence(run: Studies) -> list[str]:
    """G2's overshoot in Genesis falls with each refinement of the solver's step."""
    return [
        f"{fine} substeps give {format_value(lower, 'rad')}, "
        f"{coarse} give {format_value(upper, 'rad')}"
        for (coarse, upper), (fine, lower) in pairwise(run.overshoot_by_substeps("Genesis").items())
        if not upper - lower > spec.RESOLUTION["rad"]
    ]


def one_limit(run: Studies) -> list[str]:
    """With a finer solver step, all engines and integrators approach the same overshoot of G2."""
    at = {engine: run.overshoot_by_substeps(engine) for engine in ENGINES}
    declared, finest = (
        max(v[n] for v in at.values()) - min(v[n] for v in at.values())
        for n in (spec.G2.substeps, max(study_spec.SUBSTEPS_STUDIED))
    )
    if finest <= study_spec.SPREAD_SHARE * declared:
        return []
    return [f"the spread is {finest:.4f} rad at the finest step, {declared:.4f} at the lesson's"]


def second_engine_order(run: Studies) -> list[str]:
    """Every ordering that the lesson claims holds in Genesis and in MuJoCo, both integrators."""
    return [
        f"{engine}: {metric}, {pair[1]} {order} than {pair[0]}: {state}, {text}"
        for engine in ENGINES
        for pair, metric, order, margin in spec.RELATIONS
        for state, text in [relation_outcome(run, engine, (pair, metric, order, margin))]
        if state != HELD
    ]


CHECKS: tuple[Callable[[Studies], list[str]], ...] = (
    study_factors, same_model, small_step_unsaturated, theory_small_step, gravity_support,
    convergence, one_limit, second_engine_order,
)  # fmt: skip


def run_checks(run: Studies) -> tuple[Check, ...]:
    """Run every check on the studies."""
    return evaluate(CHECKS, run)


@dataclass(frozen=True, slots=True)
class Grid:
    """What the grid's checks read: the sweep, and G1 to G3 run alone, by name."""

    found: Sweep
    alone: Mapping[str, Trace]
    joints: JointMap


def grid_matches_cases(grid: Grid) -> list[str]:
    """G1, G2 and G3 give the same results in the batch as alone, within the declared margins."""
    k, found, problems = grid.joints.entry(spec.STEPPED_JOINT), grid.found, []
    for name, point in study_spec.CASE_POINTS.items():
        alone, number = grid.alone[name], found.at(point)
        pairs: list[tuple[str, Any, Any, str]] = [
            ("position", found.q[number], alone.q[:, k], "rad"),
            ("control force", found.control_force[number], alone.control_force[:, k], "N·m"),
        ]
        measured = step_metrics(alone, k)
        pairs += [
            (metric, value, getattr(measured, metric), unit)
            for metric, value, unit in found.metrics[number].items()
        ]
        for what, *values, unit in pairs:
            a, b = (np.array(value, dtype=float) for value in values)  # None becomes NaN
            if not np.allclose(a, b, rtol=0, atol=study_spec.AGREEMENT[unit], equal_nan=True):
                limit = f"{study_spec.AGREEMENT[unit]:g} {unit}"
                problems.append(f"{name}: {what} differs by more than {limit}")
    return problems


def grid_within_gains(grid: Grid) -> list[str]:
    """Every run stays within the compared cases' gains and step, and varies nothing else."""
    joint, problems = spec.STEPPED_JOINT, []
    varied = {f"{field}[{joint}]" for field in ("kp", "kv", "q_target")}
    for case in grid.found.cases:
        point = study_spec.point_of(case)
        for name, (low, high) in study_spec.BOUNDS.items():
            value = getattr(point, name)
            if not low <= value <= high:
                problems.append(f"{name} = {value:g} is outside [{low:g}, {high:g}]")
        others = set(differences(spec.G1, case, grid.joints)) - varied
        if others:
            problems.append(f"{point} changes {sorted(others)}")
    return problems


def run_grid_checks(grid: Grid) -> tuple[Check, ...]:
    """Run both checks on the grid."""
    return evaluate((grid_matches_cases, grid_within_gains), grid)
