"""The generated interpretation is right for every outcome, and its sentences are whole."""

from dataclasses import replace

import pytest

from robo_genesis.core.comparison import Comparison
from robo_genesis.lessons.l04 import tables, text
from robo_genesis.lessons.l04.metrics import StepMetrics

MEASURED = StepMetrics(0.25, 0.12, 0.0111, 0.31, 0.0061, 0.002, 3.234, 86.5, 7, 0.07)


def with_metrics(run, **by_case):
    return replace(run, accepted={**run.metrics, **by_case})


SAYS = {
    "- Between G2 and G3 only `kv[joint4]` differs; every other entry": {},
    "costs response time: G3 reaches 90 % after": {"G3": {"rise_time": None}},
    "costs no response time: G3 reaches 90 % ear": {"G3": {"rise_time": 0.0}},
    "- No cost in response time is visible": {"G2": {}, "G3": {}},
    "- Settling of G1 into ±0.01 rad was not": {"G1": {"settling_time": None}},
    "- G1 has 7 samples (0.07 s) at or above 99 % of its limit; its peak": {"G1": {}},
}


@pytest.mark.parametrize("says", SAYS)
def test_the_lab_says_what_the_runs_show(experiment, says):
    changed = {name: replace(MEASURED, **of) for name, of in SAYS[says].items()}
    assert says in text.conclusions(with_metrics(experiment, **changed))


@pytest.mark.parametrize(
    ("predicted", "values", "says"),
    [
        ("no later", (0.4, 0.4), "Held in this run."),
        ("no later", (0.4, None), f"**Did not hold**: measured higher. {text.INSPECT}"),
        ("later", (0.4, 0.4), f"**Did not hold**: measured equal. {text.INSPECT}"),
        ("lower", (None, 0.4), "Held in this run."),
        ("higher", (None, None), "Cannot be judged: not observed in either case."),
    ],
)
def test_a_prediction_is_compared_with_the_measured_order(predicted, values, says):
    comparison = Comparison("rise time", "s", *values, 0.005)
    sentence = text.prediction_sentence(("G1", "G2"), comparison, predicted)
    assert sentence == f"Predicted: rise time {predicted} in G2 than in G1. {says}"


@pytest.mark.parametrize(
    ("rise", "outcome"),
    [
        (0.11, "held (too close to call)"),
        (0.13, "too close to call"),
        (0.2, "**did not hold**"),
        (0.05, "held"),
    ],
)
def test_a_prediction_within_the_margin_is_too_close_to_call(experiment, rise, outcome):
    run = with_metrics(experiment, G1=MEASURED, G2=replace(MEASURED, rise_time=rise))
    row = tables.outcomes_of_predictions(run).splitlines()[2]
    assert row.split("|")[4].strip() == outcome


def test_a_table_marks_unstable_runs(experiments):
    table = tables.relation_table(experiments["integrator"])
    assert table.count("| unstable: ") == table.count("\n") - 2
