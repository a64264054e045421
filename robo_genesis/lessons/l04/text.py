"""Sentences from measured metrics and traces, correct for every outcome.

The numbers of the run choose and fill each sentence; nothing is copied from an earlier run.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.comparison import compare
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import Block, comparison_sentence, format_value, prediction_sentence
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.metrics import (
    SATURATION_THRESHOLD,
    SETTLING_BAND,
    StepMetrics,
    is_saturated,
)  # fmt: skip
from robo_genesis.lessons.l04.study_spec import AT_REST, COMPARED
from robo_genesis.sim.arm.joint_control import differences

MEASURES = False

INSPECT = (
    "Before blaming the model, inspect saturation, the time stamps, the initial states and "
    "the length of the window."
)

COMPARED_METRICS = ("rise_time", "peak_speed", "overshoot", "settling_time")
"""Metrics that the text compares between two cases."""


def model_table(run: Experiment) -> str:
    """Return the engine's counts of the robot."""
    return tables.markdown([run.readings["model"]])


def joint_table(run: Experiment) -> str:
    """Return the joints by name with their DOFs and limits."""
    return tables.markdown(run.joints.rows())


def metric_table(run: Experiment) -> str:
    """Return the metrics of all cases of the lab."""
    return tables.metric_table({name: run.metrics[name] for name in spec.CASES})


def conclusions(run: Experiment) -> str:
    """Return the sentences about the compared cases."""
    changed = changes(run)
    metrics = {name: run.metrics[name] for name in COMPARED}
    traces = {name: run.traces[name] for name in COMPARED}
    blocks = interpret(metrics, changed, spec.PREDICTIONS, spec.RESOLUTION, traces, spec.ENTRY)
    return "\n".join(block.markdown() for block in blocks)


def changes(run: Experiment) -> dict[tuple[str, str], list[str]]:
    """Return by compared pair the entries in which its configurations differ."""
    return {
        (one, other): differences(spec.CASES[one], spec.CASES[other], run.joints)
        for one, other in spec.ONE_FACTOR
    }


def pair_sentences(
    names: tuple[str, str],
    metrics: Mapping[str, StepMetrics],
    changed: Sequence[str],
    predictions: tuple[tuple[str, str], ...],
    resolution: Mapping[str, float],
) -> list[str]:
    """Compare two cases that should differ in one entry.

    Args:
        names: the two cases, in order.
        metrics: by case name.
        changed: the entries in which the configurations differ, from `joint_control.differences`.
        predictions: (metric, order) written down before the runs.
        resolution: by unit, the difference that counts as none.
    """
    of_metric = {
        metric: compare(
            metric, metrics[names[0]], metrics[names[1]], resolution, spec.MARGINS[metric]
        )
        for metric in (*COMPARED_METRICS, *(metric for metric, _ in predictions))
    }
    return [
        factor_sentence(names, changed),
        *(comparison_sentence(names, of_metric[metric]) for metric in COMPARED_METRICS),
        *(
            prediction_sentence(names, of_metric[metric], order, INSPECT)
            for metric, order in predictions
        ),
    ]


def factor_sentence(names: tuple[str, str], changed: Sequence[str]) -> str:
    """Name the entries in which two configurations differ."""
    if len(changed) == 1:
        return (
            f"Between {names[0]} and {names[1]} only `{changed[0]}` differs; every other entry of "
            "the two configurations is equal, compared field by field."
        )
    found = ", ".join(f"`{entry}`" for entry in changed) or "nothing"
    return (
        f"{names[0]} and {names[1]} differ in {found}, so no difference below can be attributed "
        "to one factor."
    )


def start_sentence(
    names: tuple[str, str],
    traces: Mapping[str, Trace],
    changed: Sequence[str],
    entry: int,
    resolution: Mapping[str, float],
) -> str:
    """Describe the motion of two cases while both were clipped to the same effort.

    Under the same effort, the controller cannot cause a difference in motion. The engine's implicit
    integrator adds substep length · KV to the inertia of a position-controlled DOF. This explains
    the difference only where KV is the only entry in `changed`.
    """
    one, other = (traces[name] for name in names)
    a, b = one.control_force[:, entry], other.control_force[:, entry]
    alike = np.append((a == b) & is_saturated(a, one.effort_limit[entry]), False)
    count = int(alike.argmin())  # leading samples with the same clipped effort
    if count == 0:
        return "The two runs were not clipped to the same effort at the start."
    speeds = [float(trace.qd[count - 1, entry]) for trace in (one, other)]
    values = " and ".join(
        f"{name} {format_value(v, 'rad/s')}" for name, v in zip(names, speeds, strict=True)
    )
    time = format_value(float(one.t_step[count - 1]), "s")
    lead = f"Up to {time} both were clipped to the same effort at each sample"
    if abs(speeds[0] - speeds[1]) <= resolution["rad/s"]:
        what = " and ".join(f"`{name}`" for name in changed) or "nothing"
        return (
            f"{lead}, and both moved at the same speed ({values}): up to there, the change of "
            f"{what} had no visible effect."
        )
    lead += f", but their speeds differ there ({values}), so the effort is not the reason"
    if not (len(changed) == 1 and changed[0].startswith("kv[")):
        return f"{lead}. KV is not the only entry that changed. {INSPECT}"
    return (
        f"{lead}. The engine's implicit integrator adds substep length × KV to the inertia of a "
        "position-controlled DOF, even while its effort is clipped. This part of the difference is "
        "numerical, and a smaller substep would shrink it."
    )


def cost_sentence(
    names: tuple[str, str], metrics: Mapping[str, StepMetrics], resolution: Mapping[str, float]
) -> str:
    """State the second case's cost in response time, if there is one."""
    comparison = compare(
        "rise_time", metrics[names[0]], metrics[names[1]], resolution, spec.MARGINS["rise_time"]
    )
    first, second = comparison.first, comparison.second
    if first is None and second is None:
        return "The cost in response time is unknown: no rise was observed."
    if second is None:
        return f"The change costs response time: {names[1]} did not reach 90 % in this window."
    if first is None:
        return f"No cost in response time here: {names[1]} reaches 90 %, {names[0]} does not."
    if comparison.order == "equal":
        return "No cost in response time is visible: the rise times are within the margin."
    delay = format_value(abs(second - first), "s")
    if second > first:
        return f"The change costs response time: {names[1]} reaches 90 % {delay} later."
    return f"No cost in response time here: {names[1]} is {delay} earlier."


def final_error_block(metrics: Mapping[str, StepMetrics]) -> Block:
    """Read each final error together with final velocity and settling, and state the limits."""
    sentences = [final_error_sentence(name, m) for name, m in metrics.items()]
    sentences.append(
        "A small remaining error would be consistent with a controller without an integral term "
        "that holds the arm against gravity. The last sample of a finite window does not prove it."
    )
    return Block("3. The final error, and its limits as evidence", tuple(sentences))


def final_error_sentence(name: str, m: StepMetrics) -> str:
    """Describe the end of one run."""
    at_rest = abs(m.final_velocity) <= AT_REST
    motion = f"nearly at rest (no more than {AT_REST:g} rad/s)" if at_rest else "still moving"
    ends = (
        f"{name} ends {format_value(m.final_error, 'rad')} from its target, {motion} at "
        f"{format_value(m.final_velocity, 'rad/s')}"
    )
    if m.settling_time is not None:
        settled = format_value(m.settling_time, "s")
        tail = "" if at_rest else ", but its speed shows that the error is not final"
        return f"{ends}; it stays within ±{SETTLING_BAND:g} rad from {settled} on{tail}."
    ends = f"{ends}; settling into ±{SETTLING_BAND:g} rad was not observed"
    if at_rest:
        return (
            f"{ends}. The joint is outside the band, and only a longer window can distinguish a "
            "steady error from a slow approach."
        )
    return f"{ends}, so its last sample belongs to the transient and is not a steady error."


def actuator_block(metrics: Mapping[str, StepMetrics], limit: float) -> Block:
    """Report saturation case by case. Where an effort is clipped, ideal PD reasoning ends.

    Args:
        metrics: by case name.
        limit: effort limit read back from the engine [N·m].
    """
    sentences = []
    for name, m in metrics.items():
        peak = f"peak control {format_value(m.peak_control, 'N·m')} of {format_value(limit, 'N·m')}"
        count, effect = "no sample", "Nothing was clipped at these samples."
        if m.saturation_samples:
            seconds = format_value(m.saturation_duration, "s")
            count = f"{format_value(m.saturation_samples, '1')} ({seconds})"
            effect = (
                "While the effort is clipped, a higher gain cannot add effort, and the ideal "
                "second-order model does not apply."
            )
        share = f"{100 * SATURATION_THRESHOLD:.0f} %"
        sentences.append(f"{name}: {count} at or above {share} of the limit; {peak}. {effect}")
    return Block("4. The actuator limit", tuple(sentences))


def interpret(
    metrics: Mapping[str, StepMetrics],
    changed: Mapping[tuple[str, str], list[str]],
    predictions: Mapping[tuple[str, str], tuple[tuple[str, str], ...]],
    resolution: Mapping[str, float],
    traces: Mapping[str, Trace],
    entry: int,
) -> tuple[Block, ...]:
    """Return the four blocks for three cases compared pair by pair.

    Args:
        metrics: by case name, the three cases in order.
        changed: by pair, the entries in which its configurations differ; first KP's pair.
        predictions: by pair, (metric, order) written down before the runs.
        resolution: by unit, the difference that counts as none.
        traces: by case name, the runs of the metrics.
        entry: column of the stepped joint.
    """
    blocks = []
    effects = ("1. {} → {}: the effect of KP", "2. {} → {}: the effect of KV, and its cost")
    for effect, (pair, entries) in zip(effects, changed.items(), strict=True):
        sentences = pair_sentences(pair, metrics, entries, predictions[pair], resolution)
        if "cost" in effect:
            sentences.append(cost_sentence(pair, metrics, resolution))
        sentences.append(start_sentence(pair, traces, entries, entry, resolution))
        blocks.append(Block(effect.format(*pair), tuple(sentences)))
    limit = float(next(iter(traces.values())).effort_limit[entry])
    return (*blocks, final_error_block(metrics), actuator_block(metrics, limit))
