from types import SimpleNamespace

import pytest

from robo_genesis.core import tables
from robo_genesis.core.checks import Check
from robo_genesis.core.text import NOT_OBSERVED
from robo_genesis.lessons.l04.metrics import step_metrics


def test_numbers_stand_to_the_right_and_are_written_short():
    row = {
        "name": "joint4",
        "upper": -0.0698,
        "dof": 3,
        "share": 0.04,
        "zero": -0.0,
        "kp": 87.0,
    }
    _, sides, written = tables.markdown([row]).splitlines()
    assert sides == f"| :--- |{' ---: |' * 5}"
    assert written == "| joint4 | −0.0698 | 3 | 0.04 | 0 | 87 |"


@pytest.mark.parametrize("rows", [[], [{"a": 1}, {"b": 1}]])
def test_rows_that_form_no_table_are_refused(rows):
    with pytest.raises(ValueError, match="at least one row"):
        tables.markdown(rows)


def test_metric_table_has_units_and_says_what_was_not_observed(make_trace):
    trace = make_trace([0.0, 0.125, 0.25, 0.25], 1.0)
    metrics = step_metrics(trace, 0)
    text = tables.metric_table({"G1": metrics})
    assert f"| rise time | {NOT_OBSERVED} |" in text
    assert "| final error | 0.7500 rad |" in text


def test_check_table_shouts_a_failure():
    outcomes = [Check("stamps", True, "held"), Check("mapping", False, "found 8")]
    text = tables.checks_of_run(SimpleNamespace(outcomes=lambda: outcomes))
    assert "| `stamps` | passed | held |" in text
    assert "| `mapping` | **FAILED** | found 8 |" in text


def test_numbers_have_the_digits_of_their_column_and_a_true_minus_sign():
    rows = {"a": (-1.25, 3), "b": (-0.001, "none")}
    assert tables.number_table("run", {"x [m]": 1, "n": 0}, rows).splitlines()[2:] == [
        "| a | −1.2 | 3 |",
        "| b | 0.0 | none |",
    ]
