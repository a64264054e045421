"""The right option of a question is the one that the bundle shows, whatever it shows."""

import re
from types import SimpleNamespace

import pytest

from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.site import multiple_choice
from robo_genesis.site.multiple_choice import (
    UNDECIDED,
    declared_margin,
    measured_order,
    options,
)


@pytest.mark.parametrize(
    ("unit", "order", "text"),
    [
        ("s", "lower", "earlier"),
        ("s", "higher", "later"),
        ("rad", "higher", "more"),
        ("rad/s", "lower", "less"),
        ("1", None, UNDECIDED),
    ],
)
def test_exactly_the_measured_option_is_right(unit, order, text):
    assert [name for name, right in options(unit, order) if right] == [text]


@pytest.mark.parametrize(
    ("metric", "unit", "text"),
    [
        ("rise_time", "s", "too close to call, within the margin of 0.015 s"),
        ("saturation_samples", "1", "too close to call, within the margin of 1.5 samples"),
        ("settling_time", "s", "at the same sample"),
    ],
)
def test_a_difference_within_the_declared_margin_is_too_close_to_call(metric, unit, text):
    shown = options(unit, "equal", declared_margin("l04", metric))
    assert [name for name, right in shown if right] == [text]


def test_the_order_is_that_of_the_bundle_s_metrics(outputs, experiment):
    first, second = (experiment.metrics[name].overshoot for name in ("G1", "G2"))
    assert abs(first - second) > l04.RESOLUTION["rad"]
    order, unit, sentence, origin = measured_order("l04/lab", "overshoot", ["G1", "G2"])
    assert order == ("higher" if second > first else "lower")
    assert f"G1 {first:.4f} rad, G2 {second:.4f} rad" in sentence
    assert origin.startswith("Measured by l04/lab on cpu")
    assert unit == "rad"
    turned, *_ = measured_order("l04/lab", "overshoot", ["G2", "G1"])
    assert {order, turned} == {"higher", "lower"}
    assert measured_order("l04/lab", "overshoot", ["G2", "G2"])[0] == "equal"


@pytest.mark.parametrize(("metric", "case"), [("overshot", "G2"), ("overshoot", "G9")])
def test_an_unknown_metric_or_case_names_those_there_are(outputs, metric, case):
    with pytest.raises(LookupError, match=r"Known: .*G2\.overshoot"):
        measured_order("l04/lab", metric, ["G1", case])


def test_each_option_tells_yes_or_no_and_the_text_is_escaped():
    shown = {"options": options("s", "higher"), "answer": "G1 < G2", "origin": "Measured"}
    node, page = multiple_choice.choice("", number=3, **shown), SimpleNamespace(body=[])
    multiple_choice.visit_choice(page, node)
    multiple_choice.depart_choice(page, node)
    html = "".join(page.body)
    assert re.findall(r'feedback (\w+)">(\w+)\.', html) == [
        ("wrong", "No"), ("wrong", "No"), ("right", "Yes"), ("wrong", "No"),
    ]  # fmt: skip
    assert html.count('name="choice-3"') == 4
    assert "G1 &lt; G2" in html
    assert "<strong>later</strong>" in html
