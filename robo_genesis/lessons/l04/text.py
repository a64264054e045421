"""The interpretation that L04's lab generates: sentences that are right for every outcome."""

from collections.abc import Iterator

from robo_genesis.core.comparison import HELD_BY, Comparison
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.tables import comparison_sentence
from robo_genesis.core.text import blocks, format_value

from . import spec
from .metrics import SATURATION_THRESHOLD, SETTLING_BAND, StepMetrics
from .study_spec import COMPARED
from .tables import NOUNS, UNITS

MEASURES = False

INSPECT = (
    "Before blaming the model, inspect saturation, the time stamps, the initial states and "
    "the length of the window."
)

# Metrics that the text compares between two cases.
COMPARED_METRICS = ("rise_time", "peak_speed", "overshoot", "settling_time")

# By the order of the second rise time, the cost of a change.
COSTS = {
    None: "The cost in response time is unknown: no rise was observed.",
    "lower": "The change costs no response time: {second} reaches 90 % earlier than {first}.",
    "equal": "No cost in response time is visible: the rise times are within the margin.",
    "higher": "The change costs response time: {second} reaches 90 % after {first}, if at all.",
}

LIMITS_OF_ERROR = (
    "A small remaining error would be consistent with a controller without an integral term "
    "that holds the arm against gravity. The last sample of a finite window does not prove it."
)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the compared cases, in four blocks."""
    kp_pair, kv_pair = spec.ONE_FACTOR
    limit = float(run.traces["G1"].effort_limit[spec.ENTRY])
    found = {name: run.metrics[name] for name in COMPARED}
    errors = [
        line for name, m in found.items() for line in final_error_sentences(name, m)
    ]
    cost = COSTS[compared(run, kv_pair, "rise_time").order]
    cost = cost.format(first=kv_pair[0], second=kv_pair[1])
    said = {
        "1. {} → {}: the effect of KP".format(*kp_pair): pair_sentences(run, kp_pair),
        "2. {} → {}: the effect of KV, and its cost".format(*kv_pair): [
            *pair_sentences(run, kv_pair),
            cost,
        ],
        "3. The final error, and its limits as evidence": [*errors, LIMITS_OF_ERROR],
        "4. The actuator limit": [
            actuator_sentence(name, m, limit) for name, m in found.items()
        ],
    }
    return blocks(said)


def pair_sentences(run: Experiment, names: tuple[str, str]) -> Iterator[str]:
    """Compare two cases that should differ in one entry, and judge the predictions about them."""
    (entry,) = spec.ONE_FACTOR[names]
    yield (
        f"Between {names[0]} and {names[1]} only `{entry}` differs; every other entry of "
        "the two configurations is equal, compared field by field."
    )
    for metric in COMPARED_METRICS:
        yield comparison_sentence(names, compared(run, names, metric))
    for metric, order in (of[1:3] for of in spec.RELATIONS if of[0] == names):
        yield prediction_sentence(names, compared(run, names, metric), order)


def compared(run: Experiment, names: tuple[str, str], metric: str) -> Comparison:
    """Compare one metric of two cases with its declared margin."""
    first, second = (getattr(run.metrics[name], metric) for name in names)
    unit, margin = UNITS[metric], spec.MARGINS[metric]
    resolution = spec.RESOLUTION[unit]
    return Comparison(NOUNS[metric], unit, first, second, resolution, margin)


def prediction_sentence(
    names: tuple[str, str], comparison: Comparison, predicted: str
) -> str:
    """Return the outcome of a prediction, with advice if it did not hold."""
    label = comparison.label
    claim = f"Predicted: {label} {predicted} in {names[1]} than in {names[0]}"
    if comparison.order is None:
        return f"{claim}. Cannot be judged: not observed in either case."
    if comparison.order in HELD_BY[predicted]:
        return f"{claim}. Held in this run."
    return f"{claim}. **Did not hold**: measured {comparison.order}. {INSPECT}"


def final_error_sentences(name: str, m: StepMetrics) -> Iterator[str]:
    """Describe the end of one run: its final error with final velocity and settling."""
    speed = format_value(m.final_velocity, "rad/s")
    yield f"{name} ends {format_value(m.final_error, 'rad')} from its target at {speed}."
    if m.settling_time is None:
        yield (
            f"Settling of {name} into ±{SETTLING_BAND:g} rad was not observed. Only a longer "
            "window can distinguish a steady error from a slow approach."
        )
    else:
        settled = format_value(m.settling_time, "s")
        yield f"{name} stays within ±{SETTLING_BAND:g} rad from {settled} on."


def actuator_sentence(name: str, m: StepMetrics, limit: float) -> str:
    """Report the saturation of one run; `limit` is read back from the engine [N·m]."""
    share = f"{100 * SATURATION_THRESHOLD:.0f} % of its limit"
    peak = f"{format_value(m.peak_control, 'N·m')} of {format_value(limit, 'N·m')}"
    return (
        f"{name} has {format_value(m.saturation_samples, '1')} "
        f"({format_value(m.saturation_duration, 's')}) at or above {share}; its peak control is "
        f"{peak}. While the effort is clipped, a higher gain cannot add effort, and the ideal "
        "second-order model does not apply."
    )
