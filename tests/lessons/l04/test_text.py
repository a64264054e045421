"""Generated sentences: right for every outcome, with numbers from the metrics alone."""

import re
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robo_genesis.core.comparison import compare
from robo_genesis.core.text import Block, comparison_sentence, format_value, prediction_sentence
from robo_genesis.lessons.l04 import text as l04
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import MARGINS, ONE_FACTOR, PREDICTIONS, RESOLUTION
from robo_genesis.lessons.l04.study_spec import AT_REST

UNITS, LABELS = StepMetrics.about("unit"), StepMetrics.about("noun")
NAMES, THREE = ("G1", "G2"), ("G1", "G2", "G3")
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

# Order of the second value to the first; a time that was not observed is later than any other.
ORDERED = [
    ((0.4, 0.3), "lower"),
    ((0.4, 0.4), "equal"),
    ((0.3, 0.4), "higher"),
    ((None, 0.4), "lower"),
    ((0.4, None), "higher"),
]


def pair(metric, values):
    return tuple(replace(MEASURED, **{metric: value}) for value in values)


def compared(metric, values):
    return compare(metric, *pair(metric, values), RESOLUTION)


@pytest.mark.parametrize("metric", sorted(UNITS))
@pytest.mark.parametrize(
    ("share", "order"),
    [(0, "equal"), (0.9, "equal"), (-0.9, "equal"), (1.1, "higher"), (-1.1, "lower")],
)
def test_a_difference_below_the_resolution_is_none(metric, share, order):
    unit = RESOLUTION[UNITS[metric]]
    assert compared(metric, (100 * unit, 100 * unit + share * unit)).order == order


@pytest.mark.parametrize("metric", ["rise_time", "settling_time"])
@pytest.mark.parametrize(
    ("values", "says"),
    [
        ((0.4, 0.3), "goes down (G1 0.40 s, G2 0.30 s)."),
        ((0.4, 0.4), "does not change measurably (G1 0.40 s, G2 0.40 s)."),
        ((0.3, 0.4), "goes up (G1 0.30 s, G2 0.40 s)."),
        ((None, 0.4), "was observed for G2 alone (G1 not observed, G2 0.40 s); within this "
                      "window G1 is the slower one, by how much is unknown."),
        ((0.4, None), "was observed for G1 alone (G1 0.40 s, G2 not observed); within this "
                      "window G2 is the slower one, by how much is unknown."),
        ((None, None), "was not observed in either case, so this window cannot rank them."),
    ],
)  # fmt: skip
def test_a_comparison_says_what_was_measured_or_not_observed(metric, values, says):
    sentence = comparison_sentence(NAMES, compared(metric, values))
    assert sentence == f"The {LABELS[metric]} {says}"


@pytest.mark.parametrize("metric", ["rise_time", "settling_time"])
@pytest.mark.parametrize(
    ("values", "order", "says"),
    [
        ((0.12, 0.11), "equal",
         "is too close to call: G1 0.12 s, G2 0.11 s, within the margin of 0.015 s."),
        ((0.12, 0.12), "equal", "does not change measurably (G1 0.12 s, G2 0.12 s)."),
        ((0.13, 0.11), "lower", "goes down (G1 0.13 s, G2 0.11 s)."),
    ],
)  # fmt: skip
def test_a_difference_within_the_margin_is_too_close_to_call(metric, values, order, says):
    found = compare(metric, *pair(metric, values), RESOLUTION, MARGINS[metric])
    assert found.order == order
    assert comparison_sentence(NAMES, found) == f"The {LABELS[metric]} {says}"


CONFIRMED = {
    "no later": {"lower", "equal"},
    "later": {"higher"},
    "higher": {"higher"},
    "lower": {"lower"},
}


@pytest.mark.parametrize("predicted", CONFIRMED)
@pytest.mark.parametrize(("values", "order"), ORDERED)
def test_a_prediction_is_compared_with_the_measured_order(predicted, values, order):
    sentence = prediction_sentence(NAMES, compared("rise_time", values), predicted, l04.INSPECT)
    found = f"**Did not hold**: measured {order}. {l04.INSPECT}"
    if order in CONFIRMED[predicted]:
        found = "Held in this run."
    assert sentence == f"Predicted: rise time {predicted} in G2 than in G1. {found}"


def test_a_prediction_without_observations_cannot_be_judged():
    sentence = prediction_sentence(NAMES, compared("rise_time", (None, None)), "later", l04.INSPECT)
    assert sentence.endswith("Cannot be judged: not observed in either case.")


@pytest.mark.parametrize("clue", ["saturation", "stamps", "initial states", "window"])
def test_what_to_inspect_is_complete(clue):
    assert clue in l04.INSPECT


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        (["seed"], "Between G1 and G2 only `seed` differs; every other entry of the two"),
        (
            [],
            "G1 and G2 differ in nothing, so no difference below can be attributed to one factor.",
        ),
        (["kp[joint4]", "kv[joint4]"], "G1 and G2 differ in `kp[joint4]`, `kv[joint4]`, so no"),
    ],
)
def test_the_factor_is_one_entry_or_none(changed, says):
    assert l04.factor_sentence(NAMES, changed).startswith(says)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ((0.11, 0.17), "The change costs response time: G2 reaches 90 % 0.06 s later."),
        ((0.17, 0.11), "No cost in response time here: G2 is 0.06 s earlier."),
        ((0.17, 0.17), "No cost in response time is visible"),
        ((0.17, 0.18), "No cost in response time is visible"),
        ((0.17, None), "The change costs response time: G2 did not reach 90 % in this window."),
        ((None, 0.17), "No cost in response time here: G2 reaches 90 %, G1 does not."),
        ((None, None), "The cost in response time is unknown: no rise was observed."),
    ],
)
def test_the_cost_in_response_time(values, says):
    metrics = dict(zip(NAMES, pair("rise_time", values), strict=True))
    assert l04.cost_sentence(NAMES, metrics, RESOLUTION).startswith(says)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("settling", "velocity", "says"),
    [
        (0.31, AT_REST, "nearly at rest (no more than 0.01 rad/s) at {}; "
                        "it stays within ±0.01 rad from 0.31 s on."),
        (0.31, 0.5, "still moving at {}; it stays within ±0.01 rad from 0.31 s on, but its speed "
                    "shows that the error is not final."),
        (None, 0.5, "still moving at {}; settling into ±0.01 rad was not observed, so its last "
                    "sample belongs to the transient and is not a steady error."),
        (None, AT_REST, "nearly at rest (no more than 0.01 rad/s) at {}; "
                        "settling into ±0.01 rad was not observed. The joint is outside the band"),
    ],
)  # fmt: skip
def test_the_final_error_is_read_with_velocity_and_settling(sign, settling, velocity, says):
    m = replace(MEASURED, settling_time=settling, final_velocity=sign * velocity)
    says = says.format(format_value(sign * velocity, "rad/s"))
    assert l04.final_error_sentence("G1", m).startswith(
        f"G1 ends 0.0061 rad from its target, {says}"
    )


def test_the_final_error_block_ends_with_its_limits():
    *cases, limits = l04.final_error_block(dict.fromkeys(NAMES, MEASURED)).sentences
    assert len(cases) == 2
    assert "gravity" in limits
    assert "does not prove" in limits


@pytest.mark.parametrize(
    ("metrics", "says"),
    [
        (MEASURED, "G1: 7 samples (0.07 s) at or above 99 % of the limit; peak control 86.50 N·m "
         "of 87.00 N·m. While the effort is clipped, a higher gain cannot add effort, and the "
         "ideal second-order model does not apply."),
        (replace(MEASURED, saturation_samples=0, saturation_duration=0.0, peak_control=40.0),
         "G1: no sample at or above 99 % of the limit; peak control 40.00 N·m of 87.00 N·m. "
         "Nothing was clipped at these samples."),
    ],
)  # fmt: skip
def test_saturation_is_reported_with_samples_seconds_and_peak(metrics, says):
    assert l04.actuator_block({"G1": metrics}, 87.0).sentences == (says,)


def test_a_block_is_a_markdown_list():
    assert Block("T", ("One.", "Two.")).markdown() == "**T**\n\n- One.\n- Two.\n"


@pytest.fixture(scope="session")
def interpreted(make_trace):
    """The blocks for metrics, and for runs that were not clipped to the same effort."""

    def blocks(metrics, limit=87.0):
        traces = dict.fromkeys(THREE, make_trace([0, 0, 0, 0], 0, effort_limit=limit))
        return l04.interpret(metrics, ONE_FACTOR, PREDICTIONS, RESOLUTION, traces, 0)

    return blocks


@pytest.mark.parametrize(
    ("one", "other", "changed", "says"),
    [
        (([0.5, 1.0, 1.5], [87, 87, 20]), ([0.5, 1.0, 1.5], [87, 87, 20]), "kv[joint4]",
         r"Up to 0\.02 s both were clipped to the same effort .* both moved at the same speed "
         r"\(G1 1\.000 rad/s and G2 1\.000 rad/s\).* `kv\[joint4\]` had no visible effect\."),
        (([0.5, 1.0, 1.5], 87.0), ([0.3, 0.6, 0.9], [87, 87, 50]), "kv[joint4]",
         r".* their speeds differ there \(G1 1\.000 rad/s and G2 0\.600 rad/s\).* numerical, .*"),
        (([0.5, 1.0, 1.5], 87.0), ([0.3, 0.6, 0.9], [87, 87, 50]), "kp[joint4]",
         rf"(?!.*numerical).*KV is not the only entry that changed\. {re.escape(l04.INSPECT)}"),
        ((0.5, 87.0), (0.3, 87.0), "kv[joint4]", r"Up to 0\.03 s .*"),  # clipped to the end
        *(((0.0, a), (0.0, b), "kv[joint4]", "The two runs were not clipped to the same effort .*")
          for a, b in ((0.0, 0.0), (87.0, -87.0), (87.0, 20.0))),
    ],
)  # fmt: skip
def test_the_start_is_explained_where_both_were_clipped_alike(
    make_trace, one, other, changed, says
):
    runs = [make_trace([0, 0, 0, 0], 0, qd=qd, control_force=force) for qd, force in (one, other)]
    traces = dict(zip(NAMES, runs, strict=True))
    assert re.fullmatch(says, l04.start_sentence(NAMES, traces, [changed], 0, RESOLUTION))


def words(blocks):
    return [sentence for block in blocks for sentence in block.sentences]


NONNEGATIVE = st.floats(0, 100)
TIME = st.one_of(st.none(), st.floats(0, 1.2))
METRICS = st.builds(
    StepMetrics,
    initial_error=st.floats(0.001, 1),
    final_velocity=st.floats(-10, 10),
    saturation_samples=st.integers(0, 120),
    saturation_duration=st.floats(0, 1.2),
    **dict.fromkeys(("rise_time", "settling_time"), TIME),
    **dict.fromkeys(("overshoot", "final_error", "peak_speed", "peak_control"), NONNEGATIVE),
)


@given(metrics=st.fixed_dictionaries(dict.fromkeys(THREE, METRICS)), limit=st.floats(1, 200))
def test_any_outcome_gives_four_blocks_of_sentences_with_measured_numbers(
    interpreted, metrics, limit
):
    blocks = interpreted(metrics, limit)
    assert [block.title[:2] for block in blocks] == ["1.", "2.", "3.", "4."]
    texts = [format_value(value, unit) for m in metrics.values() for _, value, unit in m.items()]
    texts += [format_value(limit, "N·m"), "0.01", "99", "90"]
    texts += [f"{margin:g}" for margin in MARGINS.values()]
    rises = [metrics[name].rise_time for name in ("G2", "G3")]
    if None not in rises:
        texts.append(format_value(abs(rises[1] - rises[0]), "s"))
    allowed = {number for text in texts for number in NUMBER.findall(text)}
    for sentence in words(blocks):
        assert sentence.endswith(".")
        assert not FORBIDDEN.search(sentence)
        assert set(NUMBER.findall(sentence)) <= allowed


@pytest.mark.parametrize("case", THREE)
@pytest.mark.parametrize("name", sorted(UNITS.keys() - {"initial_error"}))
def test_another_measurement_changes_the_text(interpreted, case, name):
    metrics = dict.fromkeys(THREE, MEASURED)
    value = 7 * getattr(MEASURED, name)
    other = {**metrics, case: replace(MEASURED, **{name: value})}
    text = format_value(value, UNITS[name])
    assert not any(text in sentence for sentence in words(interpreted(metrics)))
    assert any(text in sentence for sentence in words(interpreted(other)))


def test_the_pairs_and_the_limit_are_those_that_were_given(interpreted):
    kp, kv, _, actuator = interpreted(dict.fromkeys(THREE, MEASURED), 50.0)
    assert kp.title == "1. G1 → G2: the effect of KP"
    assert kv.title == "2. G2 → G3: the effect of KV, and its cost"
    nouns = [LABELS[metric] for metric in l04.COMPARED_METRICS]
    for block, pair, entry in ((kp, ("G1", "G2"), "kp"), (kv, ("G2", "G3"), "kv")):
        predicted = [f"Predicted: {LABELS[metric]}" for metric, _ in PREDICTIONS[pair]]
        starts = [f"`{entry}[joint4]`", *nouns, *predicted]
        assert all(start in s for start, s in zip(starts, block.sentences, strict=False))
    assert "cost in response time" in kv.sentences[-2]
    assert all("of 50.00 N·m" in s for s in actuator.sentences)
