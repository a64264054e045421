import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robo_genesis.core.comparison import INSPECT, compare, comparison_sentence, prediction_sentence
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import Block
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import ONE_FACTOR, PREDICTIONS, RESOLUTION
from robo_genesis.lessons.l04.text import (
    AT_REST,
    actuator_block,
    cost_sentence,
    factor_sentence,
    final_error_block,
    final_error_sentence,
    interpret,
    pair_block,
    start_sentence,
)

UNITS, LABELS = StepMetrics.about("unit"), StepMetrics.about("noun")
NAMES = ("G1", "G2")
COMPARED = ("rise_time", "peak_speed", "overshoot", "settling_time")
TIMES = ("rise_time", "settling_time")
FORBIDDEN = re.compile(r"\b(always|universally|never|nan|none|inf)\b", re.IGNORECASE)
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")

MEASURED = StepMetrics(
    initial_error=0.25,
    rise_time=0.12,
    overshoot=0.0111,
    settling_time=0.31,
    final_error=0.0061,
    final_velocity=0.002,
    peak_speed=3.234,
    peak_control=86.5,
    saturation_samples=7,
    saturation_duration=0.07,
)

# Second against first, for a metric that was seen in both.
ORDERS = {"lower": (0.4, 0.3), "equal": (0.4, 0.4), "higher": (0.3, 0.4)}
UNSEEN = {"first": (None, 0.4), "second": (0.4, None), "both": (None, None)}


def pair(metric, values):
    return tuple(replace(MEASURED, **{metric: value}) for value in values)


def compared(metric, values):
    return compare(metric, *pair(metric, values), RESOLUTION)


@pytest.mark.parametrize("metric", sorted(UNITS))
@pytest.mark.parametrize("order", ORDERS)
def test_two_values_are_ordered(metric, order):
    unit = RESOLUTION[UNITS[metric]]
    values = {"lower": (5 * unit, 3 * unit), "equal": (unit, unit), "higher": (unit, 3 * unit)}
    assert compared(metric, values[order]).order == order


@pytest.mark.parametrize("metric", sorted(UNITS))
@pytest.mark.parametrize(
    ("share", "order"), [(0.9, "equal"), (-0.9, "equal"), (1.1, "higher"), (-1.1, "lower")]
)
def test_a_difference_below_the_resolution_is_none(metric, share, order):
    value = 100 * RESOLUTION[UNITS[metric]]
    second = value + share * RESOLUTION[UNITS[metric]]
    assert compared(metric, (value, second)).order == order


@pytest.mark.parametrize("metric", TIMES)
@pytest.mark.parametrize(
    ("unseen", "order"), [("first", "lower"), ("second", "higher"), ("both", None)]
)
def test_a_time_outside_the_window_is_later_than_one_inside(metric, unseen, order):
    assert compared(metric, UNSEEN[unseen]).order == order


@pytest.mark.parametrize("metric", COMPARED)
@pytest.mark.parametrize(
    ("order", "says"),
    [("lower", "goes down"), ("equal", "does not change measurably"), ("higher", "goes up")],
)
def test_a_comparison_says_the_order_and_both_values(metric, order, says):
    first, second = (format_value(value, UNITS[metric]) for value in ORDERS[order])
    assert comparison_sentence(NAMES, compared(metric, ORDERS[order])) == (
        f"The {LABELS[metric]} {says} (G1 {first}, G2 {second})."
    )


@pytest.mark.parametrize("metric", TIMES)
@pytest.mark.parametrize(
    ("unseen", "says"),
    [
        ("first", "observed for G2 alone (G1 not observed, G2 0.40 s); within this window G1 is"),
        ("second", "observed for G1 alone (G1 0.40 s, G2 not observed); within this window G2 is"),
        ("both", "not observed in either case, so this window cannot rank them."),
    ],
)
def test_a_comparison_says_what_was_not_observed(metric, unseen, says):
    sentence = comparison_sentence(NAMES, compared(metric, UNSEEN[unseen]))
    assert says in sentence
    assert LABELS[metric] in sentence


HELD = {
    "no later": {"lower", "equal"},
    "later": {"higher"},
    "higher": {"higher"},
    "lower": {"lower"},
}


@pytest.mark.parametrize("predicted", HELD)
@pytest.mark.parametrize("order", ORDERS)
def test_a_prediction_is_held_against_the_measured_order(predicted, order):
    sentence = prediction_sentence(NAMES, compared("rise_time", ORDERS[order]), predicted)
    assert sentence.startswith(f"Predicted: rise time {predicted} in G2 than in G1.")
    if order in HELD[predicted]:
        assert sentence.endswith("Held in this run.")
    else:
        assert f"**Did not hold**: measured {order}." in sentence
        assert sentence.endswith(INSPECT)


@pytest.mark.parametrize("predicted", HELD)
@pytest.mark.parametrize(("unseen", "order"), [("first", "lower"), ("second", "higher")])
def test_a_prediction_is_judged_when_one_side_was_not_observed(predicted, unseen, order):
    sentence = prediction_sentence(NAMES, compared("rise_time", UNSEEN[unseen]), predicted)
    assert ("Held" in sentence) == (order in HELD[predicted])


@pytest.mark.parametrize("predicted", HELD)
def test_a_prediction_without_observations_cannot_be_judged(predicted):
    sentence = prediction_sentence(NAMES, compared("rise_time", UNSEEN["both"]), predicted)
    assert "Cannot be judged" in sentence
    assert "hold" not in sentence.lower()


@pytest.mark.parametrize("clue", ["saturation", "stamps", "initial states", "window"])
def test_what_to_inspect_is_complete(clue):
    assert clue in INSPECT


def test_every_prediction_of_the_lesson_can_be_judged():
    for predictions in PREDICTIONS.values():
        for metric, predicted in predictions:
            assert prediction_sentence(NAMES, compared(metric, (1, 1)), predicted)


def test_one_differing_entry_is_one_factor():
    sentence = factor_sentence(NAMES, ["kp[joint4]"])
    assert sentence.startswith("Between G1 and G2 only `kp[joint4]` differs;")
    assert "equal" in sentence


@pytest.mark.parametrize("entry", ["seed", "q_target[joint4]", "steps", "effort_limit[joint4]"])
def test_what_differs_is_not_called_equal(entry):
    word = {"q_target": "target", "steps": "duration", "effort_limit": "effort limit"}
    name = entry.split("[")[0]
    claimed = factor_sentence(NAMES, [entry]).split("differs;")[1]
    assert word.get(name, name) not in claimed


@pytest.mark.parametrize(
    ("changed", "named"),
    [([], "nothing"), (["kp[joint4]", "kv[joint4]"], "`kp[joint4]`, `kv[joint4]`")],
)
def test_no_or_two_differing_entries_are_not_one_factor(changed, named):
    assert factor_sentence(NAMES, changed) == (
        f"G1 and G2 differ in {named}, so no difference below can be put down to one factor."
    )


def test_a_pair_names_factor_comparisons_and_predictions_in_order():
    metrics = dict(zip(NAMES, pair("rise_time", (0.12, 0.11)), strict=True))
    predictions = (("rise_time", "no later"), ("overshoot", "higher"))
    block = pair_block("T", NAMES, metrics, ["kp[joint4]"], predictions, RESOLUTION)
    assert block.title == "T"
    assert len(block.sentences) == 1 + len(COMPARED) + len(predictions)
    for sentence, metric in zip(block.sentences[1:], COMPARED, strict=False):
        assert LABELS[metric] in sentence
    assert "Held in this run." in block.sentences[5]
    assert "Did not hold**: measured equal." in block.sentences[6]


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ((0.11, 0.17), "G2 reaches 90 % 0.06 s later."),
        ((0.17, 0.11), "No cost in response time here: G2 is 0.06 s earlier."),
        ((0.17, 0.17), "No cost in response time is visible at this sampling"),
        ((0.17, None), "The cost in response time: G2 did not reach 90 % in this window."),
        ((None, 0.17), "No cost in response time here: G2 reaches 90 %, G1 does not."),
        ((None, None), "cannot be told: no rise was observed."),
    ],
)
def test_the_cost_in_response_time(values, says):
    metrics = dict(zip(NAMES, pair("rise_time", values), strict=True))
    assert says in cost_sentence(NAMES, metrics, RESOLUTION)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("settling", "velocity", "says"),
    [
        (
            0.31,
            AT_REST,
            "nearly at rest (no more than 0.01 rad/s) at {}; "
            "it stays within ±0.01 rad from 0.31 s on.",
        ),
        (0.31, 0.5, "still moving at {}; it stays within ±0.01 rad from 0.31 s on, yet its"),
        (None, 0.5, "still moving at {}; settling into ±0.01 rad was not observed"),
        (
            None,
            AT_REST,
            "nearly at rest (no more than 0.01 rad/s) at {}; "
            "settling into ±0.01 rad was not observed",
        ),
    ],
)
def test_the_final_error_is_read_with_velocity_and_settling(sign, settling, velocity, says):
    m = replace(MEASURED, settling_time=settling, final_velocity=sign * velocity)
    sentence = final_error_sentence("G1", m)
    assert sentence.startswith("G1 ends 0.0061 rad from its target, ")
    assert says.format(format_value(sign * velocity, "rad/s")) in sentence
    assert ("not observed" in sentence) == (settling is None)
    assert ("error is not final" in sentence) == (settling is not None and velocity > AT_REST)


def test_an_unsettled_run_at_rest_is_not_called_moving():
    m = replace(MEASURED, settling_time=None, final_velocity=0.0)
    assert "is a moment of the transient" not in final_error_sentence("G1", m)


def test_the_final_error_block_ends_with_its_boundary():
    block = final_error_block({"G1": MEASURED, "G2": MEASURED})
    assert len(block.sentences) == 3
    assert "gravity" in block.sentences[-1]
    assert "does not prove" in block.sentences[-1]


def test_a_saturated_case_reports_samples_seconds_and_peak():
    (sentence,) = actuator_block({"G1": MEASURED}, 87.0).sentences
    assert sentence.startswith("G1: 7 samples (0.07 s) at or above 99 % of the limit;")
    assert "peak control 86.50 N·m of 87.00 N·m" in sentence
    assert "does not apply" in sentence


def test_a_case_that_is_not_saturated_says_so():
    m = replace(MEASURED, saturation_samples=0, saturation_duration=0.0, peak_control=40.0)
    (sentence,) = actuator_block({"G1": m}, 87.0).sentences
    assert "no sample at or above 99 % of the limit" in sentence
    assert "peak control 40.00 N·m of 87.00 N·m" in sentence
    assert "nothing was clipped" in sentence
    assert "does not apply" not in sentence


def test_a_block_is_a_markdown_list():
    assert Block("T", ("One.", "Two.")).markdown() == "**T**\n\n- One.\n- Two.\n"


def trace(qd=0.0, control_force=0.0, limit=87.0, n=3):
    def column(values):
        return np.broadcast_to(np.asarray(values, dtype=float), (n,))[:, None]

    return Trace(
        t=np.arange(n + 1) * 0.01, q=np.zeros((n + 1, 1)), qd=column(qd), target=column(0.0),
        control_force=column(control_force), internal_force=column(0.0),
        start_control_force=np.zeros(1), start_qd=np.zeros(1), effort_limit=np.array([limit]),
        link_pos=np.zeros((n + 1, 1, 3)), link_quat=np.zeros((n + 1, 1, 4)),
    )  # fmt: skip


def interpreted(metrics, limit=87.0):
    traces = dict.fromkeys(("G1", "G2", "G3"), trace(limit=limit))
    return interpret(metrics, ONE_FACTOR, PREDICTIONS, RESOLUTION, traces, 0)


def started(one, other, changed="kv[joint4]"):
    return start_sentence(("G1", "G2"), {"G1": one, "G2": other}, [changed], 0, RESOLUTION)


def test_clipped_alike_and_moving_alike_says_that_a_gain_cannot_act():
    run = trace(qd=[0.5, 1.0, 1.5], control_force=[87, 87, 20])
    says = started(run, run)
    assert says.startswith("Up to 0.02 s both were clipped to the same effort")
    assert "moved alike (G1 1.000 rad/s and G2 1.000 rad/s)" in says


def test_clipped_alike_and_moving_apart_is_called_numerical():
    one = trace(qd=[0.5, 1.0, 1.5], control_force=87.0)
    other = trace(qd=[0.3, 0.6, 0.9], control_force=[87, 87, 50])
    says = started(one, other)
    assert "differ in speed there (G1 1.000 rad/s and G2 0.600 rad/s)" in says
    assert "numerical" in says
    without_kv = started(one, other, changed="kp[joint4]")
    assert "numerical" not in without_kv
    assert "KV is not the one factor that changed" in without_kv
    assert INSPECT in without_kv


@pytest.mark.parametrize("efforts", [(0.0, 0.0), (87.0, -87.0), (87.0, 20.0)])
def test_without_a_common_clipped_start_nothing_is_concluded(efforts):
    one, other = (trace(control_force=effort) for effort in efforts)
    assert started(one, other).startswith("No leading samples")


def words(blocks):
    return [sentence for block in blocks for sentence in block.sentences]


NONNEGATIVE = st.floats(0, 100)
TIME = st.one_of(st.none(), st.floats(0, 1.2))
METRICS = st.builds(
    StepMetrics,
    initial_error=st.floats(0.001, 1),
    rise_time=TIME,
    overshoot=NONNEGATIVE,
    settling_time=TIME,
    final_error=NONNEGATIVE,
    final_velocity=st.floats(-10, 10),
    peak_speed=NONNEGATIVE,
    peak_control=NONNEGATIVE,
    saturation_samples=st.integers(0, 120),
    saturation_duration=st.floats(0, 1.2),
)
THREE = st.fixed_dictionaries(dict.fromkeys(("G1", "G2", "G3"), METRICS))


@given(metrics=THREE)
def test_any_outcome_gives_four_blocks_of_plain_sentences(metrics):
    blocks = interpreted(metrics)
    assert [block.title[:2] for block in blocks] == ["1.", "2.", "3.", "4."]
    for sentence in words(blocks):
        assert sentence.endswith(".")
        assert not FORBIDDEN.search(sentence)


@given(metrics=THREE, limit=st.floats(1, 200))
def test_every_number_comes_from_the_metrics(metrics, limit):
    texts = [format_value(value, unit) for m in metrics.values() for _, value, unit in m.items()]
    texts += [format_value(limit, "N·m"), "0.01", "99", "90"]
    rises = [metrics[name].rise_time for name in ("G2", "G3")]
    if None not in rises:
        texts.append(format_value(abs(rises[1] - rises[0]), "s"))
    allowed = {number for text in texts for number in NUMBER.findall(text)}
    assert {n for sentence in words(interpreted(metrics)) for n in NUMBER.findall(sentence)} <= (
        allowed | {"87.00"}
    )
    assert {n for s in words(interpreted(metrics, limit)) for n in NUMBER.findall(s)} <= allowed


CHANGED = {
    "rise_time": 0.77,
    "overshoot": 0.0777,
    "settling_time": 0.77,
    "final_error": 0.0777,
    "final_velocity": 0.777,
    "peak_speed": 7.77,
    "peak_control": 77.7,
    "saturation_samples": 77,
    "saturation_duration": 0.77,
}


@pytest.mark.parametrize("case", ["G1", "G2", "G3"])
@pytest.mark.parametrize("name", CHANGED)
def test_another_measurement_changes_the_text(case, name):
    metrics = dict.fromkeys(("G1", "G2", "G3"), MEASURED)
    value = CHANGED[name]
    other = {**metrics, case: replace(MEASURED, **{name: value})}
    before, after = words(interpreted(metrics)), words(interpreted(other))
    text = format_value(value, UNITS[name])
    assert not any(text in sentence for sentence in before)
    assert any(text in sentence for sentence in after)


def test_another_limit_changes_the_text():
    metrics = dict.fromkeys(("G1", "G2", "G3"), MEASURED)
    assert all("of 50.00 N·m" in s for s in interpreted(metrics, 50.0)[3].sentences)


def test_the_pairs_are_those_that_were_given():
    metrics = dict.fromkeys(("G1", "G2", "G3"), MEASURED)
    kp, kv, *_ = interpreted(metrics)
    assert (kp.title, kv.title) == (
        "1. G1 → G2: what KP did",
        "2. G2 → G3: what KV did, and its cost",
    )
    assert "`kp[joint4]`" in kp.sentences[0]
    assert "`kv[joint4]`" in kv.sentences[0]
    assert any("cost in response time" in s.lower() for s in kv.sentences)
