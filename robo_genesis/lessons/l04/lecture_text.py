"""Tables and sentences of the lecture alone: what was set, the force limit, a longer window."""

from itertools import groupby

from robo_genesis.core import tables
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import bullets
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics, is_saturated
from robo_genesis.lessons.l04.study import same_beginning


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
    """Compare the first demand of the PD equation with control force and limit."""
    trace, case, k = run.traces["baseline"], spec.BASELINE, spec.ENTRY
    demand = float(case.kp[k] * (case.q_target[k] - trace.q[0, k]))
    values = {
        "demand by the PD equation": demand,
        "control force at t = 0 (before the first step, not counted)": float(
            trace.start_control_force[k]
        ),
        "limit, read back": float(trace.effort_limit[k]),
    }
    unit = run.joints.effort_units[k]
    return tables.markdown(
        [
            {f"{spec.STEPPED_JOINT}, baseline": name, unit: f"{value:.1f}"}
            for name, value in values.items()
        ]
    )


def predictions(run: Experiment) -> str:
    """Return the predictions, which were written down before the runs."""
    nouns = StepMetrics.about("noun")
    return bullets(
        f"{one} → {other}: {nouns[metric]} {order}"
        for (one, other), claims in spec.PREDICTIONS.items()
        for metric, order in claims
    )


def saturation_of_g2(run: Experiment) -> str:
    """Describe each stretch of saturated samples of G2."""
    return bullets(saturated_stretches(run.traces["G2"], spec.ENTRY))


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
