"""Tables and sentences of the lecture: first demand, predictions, gravity, a longer window."""

from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.comparison import HELD_BY, compare, order
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, format_value, listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study, study_spec, text
from robo_genesis.lessons.l04.metrics import SETTLING_BAND, StepMetrics, is_saturated
from robo_genesis.lessons.l04.study import same_beginning
from robo_genesis.lessons.l04.theory_text import share_text

MEASURES = False


def force_ranges(run: Experiment) -> str:
    """Return the gains and the force range of each joint in the baseline."""
    limits, joints = run.traces["baseline"].effort_limit, run.joints
    return tables.markdown(
        [
            {
                "joint": name,
                "KP [effort per rad or m]": float(spec.BASELINE.kp[k]),
                "KV [effort·s per rad or m]": float(spec.BASELINE.kv[k]),
                "range, read back": f"{-limits[k]:g} … {limits[k]:g} {joints.effort_units[k]}",
            }
            for k, name in enumerate(joints.names)
        ]
    )


def first_demand(run: Experiment) -> str:
    """Compare for each case the demand of the PD law at t = 0 with the clipped effort."""
    k, rows = spec.ENTRY, []
    for name, case in study_spec.COMPARED.items():
        trace = run.traces[name]
        demand = float(case.kp[k] * (case.q_target[k] - trace.q[0, k]))
        rows.append(
            {
                "case": name,
                "demand at t = 0": f"{demand:.0f} {run.joints.effort_units[k]}",
                "clipped effort": (
                    f"{float(trace.start_control_force[k]):.0f} {run.joints.effort_units[k]}"
                ),
                "at the same limit until": format_value(clipped_until(trace, k), "s"),
            }
        )
    return tables.markdown(rows)


def clipped_until(trace: Trace, entry: int) -> float | None:
    """Return the last time [s] to which the effort stays at the limit that it has at t = 0.

    None if the first effort is not clipped.
    """
    start, limit = trace.start_control_force[entry], trace.effort_limit[entry]
    if not is_saturated(float(start), float(limit)):
        return None
    force = trace.control_force[:, entry]
    held = np.append(is_saturated(force, limit) & (np.sign(force) == np.sign(start)), False)
    return float(trace.t[int(held.argmin())])


def shared_starts(run: Experiment) -> str:
    """Describe the motion of each compared pair while both have the same clipped effort."""
    changed, traces = text.changes(run), {name: run.traces[name] for name in study_spec.COMPARED}
    return bullets(
        f"{one} and {other}: "
        + text.start_sentence((one, other), traces, entries, spec.ENTRY, spec.RESOLUTION)
        + leaving_sentence(
            (one, other), [clipped_until(traces[c], spec.ENTRY) for c in (one, other)]
        )
        for (one, other), entries in changed.items()
    )


def leaving_sentence(names: tuple[str, str], until: list[float | None]) -> str:
    """Say which effort leaves its first limit earlier, with a space in front.

    Args:
        names: the two cases, in order.
        until: by case, from `clipped_until` [s].
    """
    a, b = until
    if a is None or b is None:
        return " At t = 0 at least one of the two efforts is below the limit."
    times = [format_value(time, "s") for time in (a, b)]
    if times[0] == times[1]:
        return f" Both efforts stay at the limit until {times[0]}."
    first, second = names if a < b else names[::-1]
    return (
        f" {first} leaves the limit before {second}: {names[0]} stays there until {times[0]}, "
        f"{names[1]} until {times[1]}."
    )


def compared_metrics(run: Experiment) -> str:
    """Return the metrics of G1 to G3."""
    return tables.metric_table({name: run.metrics[name] for name in study_spec.COMPARED})


CLOSE = "too close to call"
"""The outcome where two values differ by less than the margin."""


def outcomes_of_predictions(run: Experiment) -> str:
    """Return the outcome of each prediction of the lesson; a close one is too close to call."""
    rows = []
    for (one, other), metric, claim, margin in spec.RELATIONS:
        found = compare(metric, run.metrics[one], run.metrics[other], spec.RESOLUTION, margin)
        values = (format_value(v, found.unit) for v in (found.first, found.second))
        close = found.order == "equal" and found.first != found.second
        orders = {found.order, order(found.first, found.second, 0)}
        held = orders <= {*HELD_BY[claim]}
        if found.order is None:
            outcome = "cannot be judged"
        elif close:
            outcome = f"held ({CLOSE})" if held else CLOSE
        else:
            outcome = "held" if held else "**did not hold**"
        rows.append(
            {
                "prediction": f"{found.label}: {other} {claim} than {one}",
                "measured": " → ".join(values),
                "margin": format_margin(margin, found.unit),
                "outcome": outcome,
            }
        )
    return tables.markdown(rows)


def format_margin(margin: float, unit: str) -> str:
    """Write a margin with its unit."""
    return f"{margin:g} {'samples' if unit == '1' else unit}"


def gravity_table(run: Experiment) -> str:
    """Return KP × final error beside gravity for each case."""
    return tables.markdown(gravity_rows(*_balance(run)))


def gravity_conclusions(run: Experiment) -> str:
    """Return what the table of gravity supports."""
    return bullets(gravity_sentences(*_balance(run)))


def _balance(
    run: Experiment,
) -> tuple[dict[str, float], dict[str, StepMetrics], dict[str, float]]:
    """Return KP, metrics and gravity effort by case."""
    kp = {name: float(case.kp[spec.ENTRY]) for name, case in spec.CASES.items()}
    metrics = {name: run.metrics[name] for name in spec.CASES}
    gravity = {name: run.readings[study.GROUP][f"gravity_{name}"] for name in spec.CASES}
    return kp, metrics, gravity


def disagreement(support: float, effort: float) -> float:
    """Return the difference between support and gravity effort as a share of the effort."""
    return abs(support - effort) / abs(effort)


def gravity_rows(
    kp: Mapping[str, float], metrics: Mapping[str, StepMetrics], gravity: Mapping[str, float]
) -> list[dict[str, Any]]:
    """Return for each case its support at the last sample, the gravity effort, and how it ended.

    Args:
        kp: by case [N·m/rad].
        metrics: by case.
        gravity: by case, the effort that holds its end state [N·m].
    """
    return [
        {
            "case": name,
            "KP × final error": format_value(support, "N·m"),
            "gravity, engine": format_value(effort, "N·m"),
            "difference": share_text(disagreement(support, effort)),
            "final velocity": format_value(metrics[name].final_velocity, "rad/s"),
            "settled from": format_value(metrics[name].settling_time, "s"),
        }
        for name, effort in gravity.items()
        for support in [kp[name] * metrics[name].final_error]
    ]


def gravity_sentences(
    kp: Mapping[str, float], metrics: Mapping[str, StepMetrics], gravity: Mapping[str, float]
) -> Iterator[str]:
    """Say what the table of `gravity_rows` supports, and what it does not prove."""
    moving = [name for name in gravity if abs(metrics[name].final_velocity) > study_spec.AT_REST]
    agree = [
        name
        for name, effort in gravity.items()
        if disagreement(kp[name] * metrics[name].final_error, effort)
        <= study_spec.GRAVITY_AGREEMENT
        and name not in moving
    ]
    differ = [name for name in gravity if name not in (*agree, *moving)]
    limit = share_text(study_spec.GRAVITY_AGREEMENT)
    if agree:
        yield (
            f"{listed(agree)} ended nearly at rest, and KP × error is within {limit} of the "
            "gravity effort. A balance between the motor and gravity gives this result."
        )
    for name in [name for name in agree if name in study_spec.COMPARED][:1]:
        error = metrics[name].final_error
        yield (
            f"The final error of {name}, {format_value(error, 'rad')}, takes "
            f"{100 * abs(error) / SETTLING_BAND:.0f} % of the settling band, {SETTLING_BAND:g} rad."
        )
    if differ:
        yield (
            f"{listed(differ)} ended nearly at rest, but KP × error differs from the gravity "
            f"effort by more than {limit}. Gravity alone does not explain the error. Look at tail, "
            "saturation, contacts."
        )
    if moving:
        yield (
            f"{listed(moving)} still moved at the last sample. The error there belongs to the "
            "transient and supports nothing about gravity."
        )
    if agree or differ:
        yield (
            "This does not prove that the error would remain beyond this window, that nothing else "
            "contributes to it within this margin, or that the error is the same in another pose."
        )


def saturation_of_g2(run: Experiment) -> str:
    """Describe each stretch of saturated samples of G2."""
    return "The saturated samples of G2:\n\n" + bullets(
        saturated_stretches(run.traces["G2"], spec.ENTRY)
    )


def longer_window(run: Experiment) -> str:
    """List the metrics of G2 that changed because its record is longer."""
    names = ("G2", study_spec.LONGER)
    short, long = ((run.traces[name], run.metrics[name]) for name in names)
    return window_changes(short, long)


def window_changes(short: tuple[Trace, StepMetrics], long: tuple[Trace, StepMetrics]) -> str:
    """List the metrics that changed because a record is longer, as Markdown.

    `short` are trace and metrics of a case, `long` those of the same case with more steps.
    """
    (a, of_a), (b, of_b) = short, long
    seconds = [format_value(float(trace.t[-1]), "s") for trace in (a, b)]
    if not same_beginning(a, b):
        return (
            f"The record of {seconds[1]} does not begin with the samples of the record of "
            f"{seconds[0]}. It is another experiment, so no change can be attributed to the "
            "window. Find the state that was not reset."
        )
    labels, kept = of_a.about("label"), []
    lines = [
        f"- The first {seconds[0]} of both records are bit-identical: the physics did not change."
    ]
    for (name, x, unit), (_, y, _) in zip(of_a.items(), of_b.items(), strict=True):
        before, after = format_value(x, unit), format_value(y, unit)
        if before != after:
            lines.append(f"- The {labels[name]} went from {before} to {after}. {_why(name, x, y)}")
        elif name != "initial_error":
            kept.append(labels[name])
    observed = of_a.rise_time is not None
    lines += [
        f"- Unchanged in the digits written here: {'; '.join(kept)}."
        if kept
        else "- No metric stayed the same.",
        "- Could not change: the initial error, which depends only on the first sample"
        + (", and the rise time, which had already been observed." if observed else "."),
    ]
    return "\n".join(lines) + "\n"


def _why(name: str, short: float | None, long: float | None) -> str:
    """Explain how a longer record alone can change this metric."""
    if name in ("final_error", "final_velocity"):
        return "The last sample is another one."
    if short is None:
        return "It happened after the shorter record had ended."
    if name == "settling_time":
        return "The response left the band again after the shorter record had ended."
    if long is not None:
        return "A larger value, or further samples, came later."
    return "A longer record cannot undo an observation: inspect the definition."


def saturated_stretches(trace: Trace, entry: int) -> list[str]:
    """Describe each stretch of saturated samples of the joint in column `entry` of a run.

    A force with the sign of the velocity drives the motion; with the opposite sign it brakes.
    """
    force, speed = trace.control_force[:, entry], trace.qd[:, entry]
    effects = [
        f"{'positive' if f > 0 else 'negative'} and {'drives' if f * v > 0 else 'brakes'}"
        for f, v in zip(force, speed, strict=True)
    ]
    hits = is_saturated(force, trace.effort_limit[entry])
    stretches = []
    for (hit, effect), group in groupby(range(trace.steps), lambda n: (hits[n], effects[n])):
        if hit:
            samples = list(group)
            times = [format_value(float(trace.t_step[n]), "s") for n in (samples[0], samples[-1])]
            stretches.append(f"{times[0]} to {times[1]}: the force is {effect} the motion.")
    return stretches or ["No sample was at the limit."]
