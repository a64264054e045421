"""The right option of a question is the one that the bundle shows, whatever it shows."""

import re
from types import SimpleNamespace

import pytest

from robo_genesis.core.comparison import compare_values
from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.site.text import question_nodes, questions
from robo_genesis.site.text.questions import (
    JUDGED,
    LOWER,
    UNDECIDED,
    UNKNOWN,
    WRONG,
    asked_number,
    declared_margin,
    measured_order,
    measured_sentence,
    options,
    split_causes,
)


@pytest.mark.parametrize(
    ("unit", "order", "metric", "text"),
    [
        ("s", "lower", "", "earlier"),
        ("s", "higher", "", "later"),
        ("rad", "higher", "", "more"),
        ("rad/s", "lower", "", "less"),
        ("1", None, "", UNDECIDED),
        ("m", "equal", "", "the same (to 0.1 mm)"),
        ("1", "equal", "", "the same"),
        ("s", "equal", "settling_time", "at the same time"),
        ("s", "equal", "rise_time", "about the same (less than 15 ms apart)"),
        ("1", "equal", "saturation_samples", "about the same (less than 1.5 samples apart)"),
    ],
)
def test_exactly_the_measured_option_is_right(unit, order, metric, text):
    shown = options(unit, order, "0.1 mm", margin=declared_margin("l04", metric))
    assert [name for name, right, _ in shown if right] == [text]


def test_the_order_is_that_of_the_bundle_s_metrics(outputs, experiment):
    first, second = (experiment.metrics[name].overshoot for name in ("G1", "G2"))
    assert abs(first - second) > l04.RESOLUTION["rad"]
    order, unit, sentence, origin = measured_order("l04/lab", "overshoot", ["G1", "G2"])
    assert order == ("higher" if second > first else "lower")
    assert f"{first:.4f} rad for G1, {second:.4f} rad for G2" in sentence
    assert origin.startswith("Measured by l04/lab on cpu")
    assert unit == "rad"
    turned, *_ = measured_order("l04/lab", "overshoot", ["G2", "G1"])
    assert {order, turned} == {"higher", "lower"}
    assert measured_order("l04/lab", "overshoot", ["G2", "G2"])[0] == "equal"


@pytest.mark.parametrize(
    ("unit", "values", "margin", "said"),
    [
        ("m", (0.01316, 0.00781), 0.0, "Depth: 13.2 mm for A, 7.81 mm for B."),
        ("m", (0.2011, 0.1971), 0.0, "Depth: 0.2011 m for A, 0.1971 m for B."),
        ("s", (0.14, 0.15), 0.015,
         "Depth: 0.14 s for A, 0.15 s for B. A difference below 15 ms does not count."),
        ("s", (0.14, None), 0.0, "The depth was observed for A alone"),
    ],
)  # fmt: skip
def test_the_answer_has_both_values_in_a_readable_unit(unit, values, margin, said):
    resolution = {"m": 1e-5, "s": 0.005}
    found = compare_values("depth", unit, *values, resolution, margin)
    assert measured_sentence(("A", "B"), found).startswith(said)


KEYS = [*LOWER, UNKNOWN]


def test_a_question_s_causes_follow_it():
    asked = [
        "When does",
        "it end?",
        "",
        "- lower: Not before",
        "  the limit.",
        "- unknown: It ends.",
    ]
    causes = {"lower": "Not before the limit.", "unknown": "It ends."}
    assert split_causes(asked, KEYS) == ("When does it end?", causes)
    assert split_causes(["When?"], KEYS) == ("When?", {})


def test_a_number_s_typical_wrong_answer_has_a_factor_as_its_key():
    asked = ["How far?", "", "- x57.3: In degrees."]
    assert split_causes(asked, [*JUDGED, WRONG])[1] == {"x57.3": "In degrees."}
    with pytest.raises(LookupError, match=r"Valid.*`- x57\.3: …`"):
        split_causes(["How far?", "", "- x5.: No."], [*JUDGED, WRONG])
    with pytest.raises(LookupError, match="is not a cause"):
        split_causes(asked, KEYS)


@pytest.mark.parametrize("line", ["- lowest: No.", "- no cause", "- lower: a\n- lower: b"])
def test_a_cause_without_a_valid_key_is_refused_with_the_valid_ones(line):
    with pytest.raises(LookupError, match=r"is not a cause.*`- lower: …`, .*`- unknown: …`"):
        split_causes(["When?", *line.splitlines()], KEYS)


def test_a_tolerance_is_a_share_in_percent():
    assert [questions.percents(text) for text in ("20", "0.5")] == [20, 0.5]
    for text in ("0", "-1", "100", "nan", "much", "20 %"):
        with pytest.raises(ValueError, match=f"'{text}' is not a tolerance. Give percents above 0"):
            questions.percents(text)


def written(node):
    page = SimpleNamespace(body=[])
    question_nodes.visit_question(page, node)
    numeric = isinstance(node, question_nodes.number)
    (question_nodes.depart_number if numeric else question_nodes.depart_choice)(page, node)
    return "".join(page.body)


SHOWN = {"number": 3, "answer": "G1 < G2", "origin": "Measured"}


def test_each_option_tells_yes_or_no_with_its_cause_and_the_text_is_escaped():
    node = question_nodes.choice(
        "", options=options("s", "higher", "5 ms", {"lower": "F < 9"}), **SHOWN
    )
    html = written(node)
    assert re.findall(r'feedback (\w+)">(\w+)\. (.*?)</p>', html) == [
        ("wrong", "No", "F &lt; 9 G1 &lt; G2"),
        ("wrong", "No", "G1 &lt; G2"),
        ("right", "Yes", "G1 &lt; G2"),
        ("wrong", "No", "G1 &lt; G2"),
    ]
    assert html.count('name="choice-3"') == 4
    assert "<strong>later</strong>" in html
    assert 'aria-live="polite"></output>' in html


def test_the_right_number_is_the_bundle_s(outputs, experiment):
    causes = {"low": "The motor saturates.", "x57.3": "In degrees."}
    found = asked_number("l04/lab", "G2.overshoot", 20, causes)
    value = experiment.metrics["G2"].overshoot
    assert found["value"] == pytest.approx(value)
    assert found["tolerance"] == pytest.approx(value / 5)
    assert found["feedback"][1] == ("low", "Too low. The motor saturates.")
    assert found["feedback"][3] == ("x57.3", "No. In degrees.")
    assert found["answer"].startswith(f"{value:.4f} rad; answers within 20 %")
    with pytest.raises(LookupError, match=r"Known: .*G2\.overshoot"):
        asked_number("l04/lab", "G2.overshot", 20, {})
    small = asked_number("l04/lab", "G2.overshoot", 20, {}, "mrad")
    assert small["value"] == pytest.approx(1000 * value)
    assert small["tolerance"] == pytest.approx(200 * value)
    assert (small["unit"], small["answer"][:9]) == ("mrad", f"{1000 * value:.3g} mrad")
    with pytest.raises(LookupError, match=r"cannot be shown in 'mm'\. Valid is mrad"):
        asked_number("l04/lab", "G2.overshoot", 20, {}, "mm")


FEEDBACK = [("right", "Yes."), ("low", "Too low. It saturates."), ("high", "Too high.")]
FEEDBACK += [("x57.3", "No. In degrees.")]


@pytest.fixture
def asked(browser):
    """A page with a choice and a number, and the course's script and style."""
    first = question_nodes.choice("", options=options("s", None, "5 ms", {"lower": "Why"}), **SHOWN)
    given = {"value": 0.05, "tolerance": 0.01, "unit": "rad", "feedback": FEEDBACK}
    second = question_nodes.number("", **SHOWN | {"number": 4}, **given)
    script, style = (BOOK / "_static" / name for name in ("choice.js", "course.css"))
    page = browser.new_page()
    page.set_content(
        f"<!doctype html><style>{style.read_text()}</style>{written(first)}{written(second)}"
    )
    page.add_script_tag(path=script)
    yield page
    page.close()


@pytest.mark.browser
def test_feedback_is_announced_by_keyboard_too(asked):
    asked.locator("#choice-3-0").focus()
    asked.keyboard.press("Space")
    said = asked.locator("fieldset output")
    assert said.first.inner_text() == "No. Why G1 < G2"
    asked.keyboard.press("ArrowUp")  # from the first option to the last
    assert said.first.inner_text() == "Yes. G1 < G2"


@pytest.mark.browser
def test_a_number_is_right_within_its_tolerance(asked):
    for typed, text in (
        ("0.041", "Yes."),
        ("0.039", "Too low. It saturates."),
        ("0.061", "Too high."),
        ("2.9", "No. In degrees."),
        ("1.0", "Too high."),
        ("", ""),
    ):
        asked.locator("#choice-4").fill(typed)
        asked.keyboard.press("Tab")
        assert asked.locator("fieldset output").last.inner_text() == text
        shown = [t.inner_text() for t in asked.locator(".number .feedback").all() if t.is_visible()]
        assert shown == [text] * bool(text)
