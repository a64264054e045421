"""Named checks of L04's studies: theory, gravity, solver step, second engine, grid of steps."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np

from robo_genesis.core.checks import (
    Check,
    Finding,
    above,
    at_most,
    below,
    equal,
    evaluate,
    noted,
    within,
)
from robo_genesis.core.orderings import HELD
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.batch import Sweep
from robo_genesis.lessons.l04.metrics import is_saturated, step_metrics
from robo_genesis.lessons.l04.theory import overshoot_share
from robo_genesis.sim.joint_control import differences
from robo_genesis.sim.joints import JointMap


def study_factors(run: Experiment) -> Iterator[Finding]:
    cases = study_spec.STEP_CASES | study_spec.SUBSTEP_CASES
    for name, case in cases.items():
        compared = name.split("_")[0]
        step = name in study_spec.STEP_CASES
        expected = [f"q_target[{spec.STEPPED_JOINT}]" if step else "substeps"]
        found = differences(study_spec.COMPARED[compared], case, run.joints)
        yield equal(f"difference of {compared} and {name}", found, expected, recorded=False)
        other = int((run.traces[name].target != case.q_target).any(axis=1).sum())
        yield equal(f"{name}.steps_with_another_target", other, 0)


def same_model(run: Experiment) -> Iterator[Finding]:
    of = run.readings[study.GROUP]
    for name in ("inertia", "gravity_at_start"):
        first, second = of[f"{name}_Genesis"], of[f"{name}_MuJoCo"]
        yield within(f"{name}_Genesis", first, second, study_spec.SAME_MODEL * abs(second))
        yield noted(f"{name}_MuJoCo", second)


def small_step_unsaturated(run: Experiment) -> Iterator[Finding]:
    for name in study_spec.STEP_CASES:
        trace = run.traces[name]
        start = trace.start_control_force[spec.ENTRY]
        efforts = np.append(start, trace.control_force[:, spec.ENTRY])
        saturated = is_saturated(efforts, trace.effort_limit[spec.ENTRY])
        yield equal(f"{name}.saturated_efforts", int(saturated.sum()), 0)


def theory_small_step(run: Experiment) -> Iterator[Finding]:
    for case in study_spec.SMALL_STEPPED:
        ideal = study.ideal(run, case)
        small, large = study.share(run, case, "small"), study.share(run, case)
        overshoot, allowed = overshoot_share(small), study_spec.SMALL_STEP_TOLERANCE
        yield within(f"{case}_small.overshoot_share", overshoot, ideal.overshoot, allowed)
        response = ideal.response(run.traces[case].t)
        off_small, off_large = (float(np.abs(of - response).max()) for of in (small, large))
        yield below(f"{case}_small.distance_to_theory", off_small, off_large)


def gravity_support(run: Experiment) -> Iterator[Finding]:
    at_rest = []
    for case, m in ((case, run.metrics[case]) for case in spec.CASES):
        support = float(spec.CASES[case].kp[spec.ENTRY]) * m.final_error
        effort = run.readings[study.GROUP][f"gravity_{case}"]
        label = f"{case}.support_Nm"
        yield noted(f"{case}.gravity_Nm", effort)
        yield noted(f"{case}.final_velocity_rad_s", m.final_velocity)
        if abs(m.final_velocity) <= study_spec.AT_REST:
            at_rest.append(case)
            yield within(label, support, effort, study_spec.GRAVITY_AGREEMENT * abs(effort))
        else:
            yield noted(label, support)
    yield Finding("cases_at_rest", at_rest, bool(at_rest), "at least one", recorded=False)


def convergence(run: Experiment) -> Iterator[Finding]:
    overshoot = study.overshoot_by_substeps(run, "Genesis")
    for coarse, fine in pairwise(overshoot):
        fall = overshoot[coarse] - overshoot[fine]
        yield above(f"fall_from_{coarse}_to_{fine}_substeps_rad", fall, spec.RESOLUTION["rad"])


def one_limit(run: Experiment) -> Iterator[Finding]:
    at = {engine: study.overshoot_by_substeps(run, engine) for engine in study.ENGINES}
    declared, finest = (
        max(v[n] for v in at.values()) - min(v[n] for v in at.values())
        for n in (spec.G2.substeps, max(study_spec.SUBSTEPS_STUDIED))
    )
    yield noted("spread_at_lesson_step_rad", declared)
    yield at_most("spread_at_finest_step_rad", finest, study_spec.SPREAD_SHARE * declared)


def second_engine_order(run: Experiment) -> Iterator[Finding]:
    for engine, relation in product(study.ENGINES, spec.RELATIONS):
        (first, second), metric, order, _ = relation
        state, values = study.relation_outcome(run, engine, relation)
        label = f"{engine}: {metric}, {second} {order} than {first}"
        yield Finding(label, state, state == HELD, f"{HELD}: {values}", recorded=False)


CHECKS = (
    study_factors, same_model, small_step_unsaturated, theory_small_step, gravity_support,
    convergence, one_limit, second_engine_order,
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Grid:
    """What the grid's checks read: the sweep, and G1 to G3 run alone, by name."""

    found: Sweep
    alone: Mapping[str, Trace]
    joints: JointMap


def grid_matches_cases(grid: Grid) -> Iterator[Finding]:
    k, found = grid.joints.entry(spec.STEPPED_JOINT), grid.found
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
            apart = np.where(np.isnan(a) & np.isnan(b), 0.0, np.abs(a - b)).max()
            label = f"{name}, difference of {what} [{unit}]"
            yield at_most(label, apart, study_spec.AGREEMENT[unit])


def grid_within_gains(grid: Grid) -> Iterator[Finding]:
    varied = {f"{field}[{spec.STEPPED_JOINT}]" for field in ("kp", "kv", "q_target")}
    for number, case in enumerate(grid.found.cases):
        point = study_spec.point_of(case)
        for name, (low, high) in study_spec.BOUNDS.items():
            value = getattr(point, name)
            expected = f"between {low:g} and {high:g}"
            yield Finding(f"run {number}, {name}", value, low <= value <= high, expected)
        others = set(differences(spec.G1, case, grid.joints)) - varied
        yield equal(f"run {number}, other changes", sorted(others), [])


def run_grid_checks(grid: Grid, claims: Mapping[str, str]) -> tuple[Check, ...]:
    """Run both checks on the grid; `claims` say by name what they require."""
    return evaluate((grid_matches_cases, grid_within_gains), grid, claims)
