"""Named checks of the studies around lesson L04: theory, gravity, solver step, second engine."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.orderings import HELD
from robo_genesis.core.quantities import format_value
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import SATURATION_THRESHOLD
from robo_genesis.lessons.l04.study import ENGINES, Studies, relation_outcome
from robo_genesis.lessons.l04.text import AT_REST
from robo_genesis.lessons.l04.theory import overshoot_share
from robo_genesis.sim.joint_control import ControlCase, differences


def study_factors(run: Studies) -> list[str]:
    """Step cases differ from theirs in the stepped joint's target alone, others in substeps."""
    expected: dict[tuple[str, str], list[str]] = {
        (name.split("_")[0], name): [f"q_target[{spec.STEPPED_JOINT}]"]
        for name in study_spec.STEP_CASES
    } | {("G2", name): ["substeps"] for name in study_spec.SUBSTEP_CASES}
    cases: dict[str, ControlCase] = study_spec.STEP_CASES | study_spec.SUBSTEP_CASES
    problems = []
    for (one, other), entries in expected.items():
        found = differences(study_spec.COMPARED[one], cases[other], run.joints)
        if found != entries:
            problems.append(f"{one} → {other} changes {found}, expected {entries}")
        if (run.traces[other].target != cases[other].q_target).any():
            problems.append(f"{other} was not commanded its own target")
    return problems


def same_model(run: Studies) -> list[str]:
    """Both engines give one inertia and one gravity effort for the stepped joint at the start."""
    problems = []
    for what, values in (("inertia", run.inertia), ("gravity effort", run.gravity_at_start)):
        first, second = values["Genesis"], values["MuJoCo"]
        if not abs(first - second) <= study_spec.SAME_MODEL * abs(second):
            problems.append(f"{what}: Genesis {first:.4f}, MuJoCo {second:.4f}")
    return problems


def small_step_unsaturated(run: Studies) -> list[str]:
    """No effort of the small steps and of the runs that hold reaches the saturation threshold."""
    problems = []
    for name in study_spec.STEP_CASES:
        trace = run.traces[name]
        limit = SATURATION_THRESHOLD * trace.effort_limit[run.entry]
        start = trace.start_control_force[run.entry]
        efforts = np.abs(np.append(start, trace.control_force[:, run.entry]))
        if (efforts >= limit).any():
            problems.append(f"{name}: effort reaches {efforts.max():.1f} N·m")
    return problems


def theory_small_step(run: Studies) -> list[str]:
    """Theory gives a small step's overshoot, and its curve better than a large step's."""
    problems = []
    for case in study_spec.SMALL_STEPPED:
        ideal = run.ideal(case)
        small, large = run.share(case, "small"), run.share(case)
        apart = abs(overshoot_share(small) - ideal.overshoot)
        if not apart <= study_spec.SMALL_STEP_TOLERANCE:
            problems.append(f"{case}: overshoot is {apart:.3f} of the step off the ideal one")
        response = ideal.response(run.traces[case].t)
        if not np.abs(small - response).max() < np.abs(large - response).max():
            problems.append(f"{case}: the small step's curve is no nearer to the ideal one")
    return problems


def gravity_support(run: Studies) -> list[str]:
    """Where a case ends nearly at rest, KP × final error agrees with gravity, read apart."""
    problems, told = [], 0
    for case, effort in run.gravity.items():
        m = run.measure(case)
        if abs(m.final_velocity) > AT_REST:
            continue
        told += 1
        support = float(spec.CASES[case].kp[run.entry]) * m.final_error
        if not abs(support - effort) <= study_spec.GRAVITY_AGREEMENT * abs(effort):
            problems.append(f"{case}: {support:.2f} N·m of support, gravity {effort:.2f} N·m")
    return problems if told else ["no case ends nearly at rest, so nothing could be compared"]


def convergence(run: Studies) -> list[str]:
    """G2's overshoot in Genesis falls with each refinement of the solver's step."""
    values = run.overshoot_by_substeps("Genesis")
    counts = list(values)
    return [
        f"{fine} substeps give {format_value(values[fine], 'rad')}, "
        f"{coarse} give {format_value(values[coarse], 'rad')}"
        for coarse, fine in pairwise(counts)
        if not values[coarse] - values[fine] > spec.RESOLUTION["rad"]
    ]


def one_limit(run: Studies) -> list[str]:
    """With a finer solver step both engines and all integrators approach one overshoot of G2."""
    at = {engine: run.overshoot_by_substeps(engine) for engine in ENGINES}
    spread = {
        n: max(v[n] for v in at.values()) - min(v[n] for v in at.values())
        for n in (spec.G2.substeps, max(study_spec.SUBSTEPS_STUDIED))
    }
    declared, finest = spread.values()
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
    study_factors,
    same_model,
    small_step_unsaturated,
    theory_small_step,
    gravity_support,
    convergence,
    one_limit,
    second_engine_order,
)


def run_checks(run: Studies) -> tuple[Check, ...]:
    """Run every check; one that fails says what it found, one that passes what it held."""
    return evaluate(CHECKS, run)
