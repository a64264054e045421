"""Named checks of L04's studies: theory, gravity, solver step, second engine, grid of steps."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.orderings import HELD
from robo_genesis.core.quantities import format_value
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.batch import Sweep
from robo_genesis.lessons.l04.metrics import is_saturated, step_metrics
from robo_genesis.lessons.l04.theory import overshoot_share
from robo_genesis.sim.joint_control import differences
from robo_genesis.sim.joints import JointMap


def study_factors(run: Experiment) -> Iterator[str]:
    """Each study case differs from its compared case in one factor: target or substeps."""
    cases = study_spec.STEP_CASES | study_spec.SUBSTEP_CASES
    for name, case in cases.items():
        compared = name.split("_")[0]
        step = name in study_spec.STEP_CASES
        expected = [f"q_target[{spec.STEPPED_JOINT}]" if step else "substeps"]
        found = differences(study_spec.COMPARED[compared], case, run.joints)
        if found != expected:
            yield f"{compared} → {name} changes {found}, expected {expected}"
        if (run.traces[name].target != case.q_target).any():
            yield f"{name} was not commanded its own target"


def same_model(run: Experiment) -> Iterator[str]:
    """Both engines give the same inertia and gravity effort for the stepped joint at the start."""
    of = run.readings[study.GROUP]
    for what, name in (("inertia", "inertia"), ("gravity effort", "gravity_at_start")):
        first, second = of[f"{name}_Genesis"], of[f"{name}_MuJoCo"]
        if not abs(first - second) <= study_spec.SAME_MODEL * abs(second):
            yield f"{what}: Genesis {first:.4f}, MuJoCo {second:.4f}"


def small_step_unsaturated(run: Experiment) -> Iterator[str]:
    """No effort of the small steps and of the hold runs reaches the saturation threshold."""
    for name in study_spec.STEP_CASES:
        trace = run.traces[name]
        start = trace.start_control_force[spec.ENTRY]
        efforts = np.append(start, trace.control_force[:, spec.ENTRY])
        if is_saturated(efforts, trace.effort_limit[spec.ENTRY]).any():
            yield f"{name}: effort reaches {np.abs(efforts).max():.1f} N·m"


def theory_small_step(run: Experiment) -> Iterator[str]:
    """Theory predicts a small step's overshoot, and its curve better than a large step's."""
    for case in study_spec.SMALL_STEPPED:
        ideal = study.ideal(run, case)
        small, large = study.share(run, case, "small"), study.share(run, case)
        difference = abs(overshoot_share(small) - ideal.overshoot)
        if not difference <= study_spec.SMALL_STEP_TOLERANCE:
            yield f"{case}: overshoot is {difference:.3f} of the step off the ideal one"
        response = ideal.response(run.traces[case].t)
        if not np.abs(small - response).max() < np.abs(large - response).max():
            yield f"{case}: the small step's curve is not nearer to the ideal one"


def gravity_support(run: Experiment) -> Iterator[str]:
    """Where a case ends nearly at rest, KP × final error agrees with the gravity effort."""
    ends = {case: run.metrics[case] for case in spec.CASES}
    at_rest = [case for case, m in ends.items() if abs(m.final_velocity) <= study_spec.AT_REST]
    for case in at_rest:
        support = float(spec.CASES[case].kp[spec.ENTRY]) * ends[case].final_error
        effort = run.readings[study.GROUP][f"gravity_{case}"]
        if not abs(support - effort) <= study_spec.GRAVITY_AGREEMENT * abs(effort):
            yield f"{case}: {support:.2f} N·m of support, gravity {effort:.2f} N·m"
    if not at_rest:
        yield "no case ends nearly at rest, so nothing could be compared"


def convergence(run: Experiment) -> Iterator[str]:
    """G2's overshoot in Genesis falls with each refinement of the solver's step."""
    overshoot = study.overshoot_by_substeps(run, "Genesis")
    written = {n: format_value(value, "rad") for n, value in overshoot.items()}
    for coarse, fine in pairwise(overshoot):
        if not overshoot[coarse] - overshoot[fine] > spec.RESOLUTION["rad"]:
            yield f"{fine} substeps give {written[fine]}, {coarse} give {written[coarse]}"


def one_limit(run: Experiment) -> Iterator[str]:
    """With a finer solver step, all engines and integrators approach the same overshoot of G2."""
    at = {engine: study.overshoot_by_substeps(run, engine) for engine in study.ENGINES}
    declared, finest = (
        max(v[n] for v in at.values()) - min(v[n] for v in at.values())
        for n in (spec.G2.substeps, max(study_spec.SUBSTEPS_STUDIED))
    )
    if not finest <= study_spec.SPREAD_SHARE * declared:
        yield f"the spread is {finest:.4f} rad at the finest step, {declared:.4f} at the lesson's"


def second_engine_order(run: Experiment) -> Iterator[str]:
    """Every ordering that the lesson claims holds in Genesis and in MuJoCo, both integrators."""
    for engine, relation in product(study.ENGINES, spec.RELATIONS):
        (first, second), metric, order, _ = relation
        state, text = study.relation_outcome(run, engine, relation)
        if state != HELD:
            yield f"{engine}: {metric}, {second} {order} than {first}: {state}, {text}"


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


def grid_matches_cases(grid: Grid) -> Iterator[str]:
    """G1, G2 and G3 give the same results in the batch as alone, within the declared margins."""
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
            if not np.allclose(a, b, rtol=0, atol=study_spec.AGREEMENT[unit], equal_nan=True):
                limit = f"{study_spec.AGREEMENT[unit]:g} {unit}"
                yield f"{name}: {what} differs by more than {limit}"


def grid_within_gains(grid: Grid) -> Iterator[str]:
    """Every run stays within the compared cases' gains and step, and varies nothing else."""
    varied = {f"{field}[{spec.STEPPED_JOINT}]" for field in ("kp", "kv", "q_target")}
    for case in grid.found.cases:
        point = study_spec.point_of(case)
        for name, (low, high) in study_spec.BOUNDS.items():
            value = getattr(point, name)
            if not low <= value <= high:
                yield f"{name} = {value:g} is outside [{low:g}, {high:g}]"
        others = set(differences(spec.G1, case, grid.joints)) - varied
        if others:
            yield f"{point} changes {sorted(others)}"


def run_grid_checks(grid: Grid) -> tuple[Check, ...]:
    """Run both checks on the grid."""
    return evaluate((grid_matches_cases, grid_within_gains), grid)
