"""Named checks of L04's lecture: the compared cases, gravity and a longer window."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, below, equal, nearly, noted
from robo_genesis.core.comparison import HELD
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import format_value
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, is_saturated


def orders(run: Experiment, engine: str, substeps: int = spec.G1.substeps) -> Iterator[Finding]:
    """Require every ordering that the lesson claims of an engine's runs."""
    finer = f", {substeps} substeps" * (substeps != spec.G1.substeps)
    for relation in spec.RELATIONS:
        (first, second), metric, order, _ = relation
        state, values = study.relation_outcome(run, engine, relation, substeps)
        label = f"{engine}{finer}: {metric}, {second} {order} than {first}"
        yield Finding(label, state, state == HELD, f"{HELD}: {values}", recorded=False)


def claimed_orders(run: Experiment) -> Iterator[Finding]:
    """Every ordering that the lesson claims holds in the compared cases."""
    return orders(run, "Genesis")


def clipped_start(run: Experiment) -> Iterator[Finding]:
    """G1 and G2 get the same clipped effort and move alike until G1 leaves its limit, which is
    before G2 does. G2 and G3 get the same clipped effort until G2 leaves the limit, and then G3 is
    slower. G2 also brakes at a limit. The effort of G3 first brakes farther from the target.
    """
    g1, g2, g3 = (run.traces[case] for case in study_spec.COMPARED)
    until = [study.at_limit_until(trace) for trace in (g1, g2)]
    yield above("G1.at_limit_until_s", until[0], 0.0)
    yield above("G2.at_limit_until_s", until[1], until[0])
    pairs = {"G1_and_G2": (g1, g2, until[0]), "G2_and_G3": (g2, g3, until[1])}
    slower = {}
    for name, (one, other, end) in pairs.items():
        n = round(end / one.dt)
        efforts = (trace.control_force[:n, spec.ENTRY] for trace in (one, other))
        yield equal(f"{name}.same_efforts", bool(np.equal(*efforts).all()), True)
        slower[name] = float(one.qd[n - 1, spec.ENTRY] - other.qd[n - 1, spec.ENTRY])
    apart, noise = abs(slower["G1_and_G2"]), spec.RESOLUTION["rad/s"]
    yield at_most("G1_and_G2.speed_difference_rad_s", apart, noise)
    yield above("G3.slower_than_G2_rad_s", slower["G2_and_G3"], spec.MARGINS["peak_speed"])
    force, speed = g2.control_force[:, spec.ENTRY], g2.qd[:, spec.ENTRY]
    braking = is_saturated(force, g2.effort_limit[spec.ENTRY]) & (force * speed < 0)
    yield above("G2.braking_samples", int(braking.sum()), 0)
    left = [study.braking_error(trace) for trace in (g2, g3)]
    yield noted("G2.braking_error_rad", left[0])
    yield above("G3.braking_error_rad", left[1], left[0])


def gravity_support(run: Experiment) -> Iterator[Finding]:
    """Where a case ends nearly at rest, KP × final error agrees with the gravity effort."""
    at_rest = []
    for case in spec.CASES:
        (support, effort), velocity = study.supports(run, case), run.metrics[case].final_velocity
        label = f"{case}.support_Nm"
        yield noted(f"{case}.gravity_Nm", effort)
        yield noted(f"{case}.final_velocity_rad_s", velocity)
        if abs(velocity) <= study_spec.AT_REST:
            at_rest.append(case)
            yield nearly(label, support, effort, study_spec.GRAVITY_AGREEMENT)
        else:
            yield noted(label, support)
    yield Finding("cases_at_rest", at_rest, bool(at_rest), "at least one", recorded=False)


def ends_at_rest(run: Experiment) -> Iterator[Finding]:
    """The baseline and the compared cases end nearly at rest, inside the settling band."""
    for name in spec.CASES:
        m = run.metrics[name]
        yield at_most(f"{name}.final_speed_rad_s", abs(m.final_velocity), study_spec.AT_REST)
        yield below(f"{name}.share_of_band", m.final_error / SETTLING_BAND, 1.0)


def same_beginning(run: Experiment) -> Iterator[Finding]:
    """The longer run of G2 begins with exactly the samples of G2."""
    short, long = run.traces["G2"], run.traces[study_spec.LONGER]
    pairs = [[getattr(of, name) for of in (short, long)] for name in ("q", "qd", "control_force")]
    same = all(np.array_equal(one, other[: len(one)]) for one, other in pairs)
    yield equal("same_samples", same and long.steps > short.steps, True, recorded=False)


def same_metrics(run: Experiment) -> Iterator[Finding]:
    """The longer run of G2 has the metrics of G2, in the digits that are shown."""
    longer = run.metrics[study_spec.LONGER]
    for name, value, unit in run.metrics["G2"].items():
        found, expected = (format_value(of, unit) for of in (getattr(longer, name), value))
        yield equal(name, found, expected, recorded=False)


LECTURE = (
    claimed_orders, clipped_start, gravity_support, ends_at_rest, same_beginning, same_metrics,
)  # fmt: skip
