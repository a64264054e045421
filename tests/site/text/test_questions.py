"""The right option of a question is the one that the bundle shows, and it is not in sight."""

import re

import pytest
from bundles import RENDERER
from docutils import nodes
from docutils.utils import new_document
from tiny_book import make_book, paragraphs

from robo_genesis.core.comparison import Comparison
from robo_genesis.core.project import BOOK, ProjectError
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.pages.page_index import PageIndex
from robo_genesis.site.text import questions


@pytest.mark.parametrize(
    ("unit", "order", "metric", "text"),
    [
        ("s", "lower", "", "earlier"),
        ("rad", "higher", "", "more"),
        ("1", None, "", questions.UNDECIDED),
        ("m", "equal", "", "the same (to 0.1 mm)"),
        ("1", "equal", "", "the same"),
        ("s", "equal", "settling_time", "at the same time"),
        ("s", "equal", "rise_time", "about the same (less than 15 ms apart)"),
    ],
)
def test_exactly_the_measured_option_is_right(unit, order, metric, text):
    values = {"lower": (2, 1), "equal": (1, 1), "higher": (1, 2), None: (None, None)}
    margin = questions.declared_margin("l04", metric)
    measure = Comparison("noun", unit, *values[order], 1e-4, margin)
    shown = questions.options(measure, {})
    assert [name for name, right, _ in shown if right] == [text]


def test_the_order_is_that_of_the_bundle_s_metrics(outputs, experiment):
    first, second = (experiment.metrics[name].overshoot for name in ("G1", "G2"))
    assert abs(first - second) > l04.RESOLUTION["rad"]
    found, sentence, origin = questions.measured_order(
        "l04/lab", "overshoot", ["G1", "G2"]
    )
    assert (found.order, found.unit) == ("higher" if second > first else "lower", "rad")
    assert (
        f"{1000 * first:.3g} mrad for G1, {1000 * second:.3g} mrad for G2" in sentence
    )
    assert origin.startswith("Measured by l04/lab on cpu")
    assert (
        questions.measured_order("l04/lab", "overshoot", ["G2", "G2"])[0].order
        == "equal"
    )


@pytest.mark.parametrize(
    ("unit", "values", "margin", "said"),
    [
        ("m", (0.1001, 0.0025), 0.0, "Depth: 100 mm for A, 2.5 mm for B."),
        ("rad", (-1e-9, 0.0447), 0.0, "Depth: 0 mrad for A, 44.7 mrad for B."),
        ("m", (0.2011, 0.1971), 0.0, "Depth: 0.2011 m for A, 0.1971 m for B."),
        (
            "s",
            (0.14, 0.15),
            0.015,
            "Depth: 0.14 s for A, 0.15 s for B. A difference below 15 ms does not count.",
        ),
        ("s", (0.14, None), 0.0, "The depth was observed for A alone"),
    ],
)
def test_the_answer_has_both_values_in_a_readable_unit(unit, values, margin, said):
    resolution = {"m": 1e-5, "s": 0.005, "rad": 1e-5}
    found = Comparison("depth", unit, *values, resolution[unit], margin)
    assert questions.measured_sentence(("A", "B"), found).startswith(said)


@pytest.mark.parametrize(
    ("lines", "causes"),
    [
        ("", {}),
        (
            "- low: Not before\n  it.\n- right: Y.",
            {"low": "Not before it.", "right": "Y."},
        ),
        ("- x57.3: In degrees.", {"x57.3": "In degrees."}),
        ("- x5.: No.", None),
        ("- no cause", None),
        ("- low: a\n- low: b", None),
    ],
)
def test_the_causes_of_valid_keys_follow_a_question(lines, causes):
    asked = ["When does", "it end?", "", *lines.splitlines()], ["low", "right"]
    if causes is None:
        with pytest.raises(LookupError, match=r"is not a cause.*`- low: …`"):
            questions.split_causes(*asked)
    else:
        assert questions.split_causes(*asked) == ("When does it end?", causes)


def written(node):
    return node["opening"] + node["closing"]


MEASURED = {"answer": "G1 < G2", "origin": "Measured"}


def test_the_right_number_is_the_bundle_s(outputs, experiment):
    causes = {"low": "The motor saturates.", "x57.3": "In degrees."}
    value = experiment.metrics["G2"].overshoot
    for unit, scale, text in (
        ("", 1, f"{value:.4f} rad"),
        ("mrad", 1000, f"{1000 * value:.3g} m"),
    ):
        found = questions.asked_number("l04/lab", "G2.overshoot", 20, causes, unit)
        assert found["value"] == pytest.approx(scale * value)
        assert found["tolerance"] == pytest.approx(scale * value / 5)
        assert found["unit"] == (unit or "rad")
        assert found["answer"].startswith(text)
    count = experiment.metrics["G2"].saturation_samples
    found_count = questions.asked_number("l04/lab", "G2.saturation_samples", 0, {}, "")
    assert found_count["answer"].startswith(f"{count};")
    assert found["feedback"][1] == ("low", "Too low. The motor saturates.")
    assert found["feedback"][3] == ("x57.3", "No. In degrees.")
    with pytest.raises(LookupError, match=r"cannot be shown in 'mm'\. Valid is mrad"):
        questions.asked_number("l04/lab", "G2.overshoot", 20, {}, "mm")


ASKED = "```{{choice}} l04/lab overshoot G1 {}\nMore in run {}?\n```"
PAGE = [
    (ASKED.format("G2", 1), True),
    ("```{number} l04/lab G2.overshoot\n:tolerance: 5\nHow far?\n```", True),
    (ASKED.format("G2\n:explained: `L03`", 2), False),
    (ASKED.format("G2\n:calculation:", 3), False),
    (ASKED.format("unseen\n:absent:", 4), False),
    (ASKED.format("G2\n:hides:", 5), False),
]


def test_an_answer_that_may_be_in_sight_stops_the_build_with_page_and_line(
    recorder, experiment, tmp_path
):
    recorder.write(experiment, RENDERER)
    outputs = {"l04/lab": recorder.contract.outputs / "l04" / "lab"}
    book = make_book(tmp_path, text="# Text\n\n" + paragraphs(*dict(PAGE)))
    with pytest.raises(ProjectError) as caught:
        render(book, tmp_path, PageIndex(outputs=outputs), tmp_path / "render.log")
    lines, line = [], 3
    for text, refused in PAGE:
        lines += [str(line)] * refused
        line += 2 + text.count("\n")
    said = r"text\.md:(\d+): .*may be in sight. Add `:hides:`"
    assert re.findall(said, str(caught.value)) == lines


@pytest.mark.parametrize(
    ("after", "refused"),
    [
        ([nodes.container(classes=["replay-block", "growing"])], False),
        ([nodes.container(classes=["replay-block"])], True),
        ([nodes.paragraph(), nodes.container(classes=["growing"])], True),
        ([], True),
    ],
    ids=["blind", "not blind", "a text before it", "no replay"],
)
def test_a_question_is_blind_with_the_replay_that_follows_directly(
    monkeypatch, after, refused
):
    said = []
    monkeypatch.setattr(questions.logger, "warning", lambda *a, **_: said.append(a))
    document = new_document("page")
    document += [questions.question(kinds=[]), *after]
    questions.RequireKinds(document).apply()
    assert said == [(questions.IN_SIGHT,)] * refused


FEEDBACK = [("right", "Yes."), ("low", "Too low. It saturates."), ("high", "Too high.")]
FEEDBACK += [("x57.3", "No. In degrees.")]


@pytest.mark.browser
def test_feedback_is_announced_by_keyboard_and_a_number_is_right_within_its_tolerance(
    page,
):
    measure = Comparison("noun", "s", None, None, 0.005)
    shown = questions.options(measure, {"lower": "Why"})
    first = questions.asked(name="choice-3", options=shown, **MEASURED)
    given = {"value": 0.05, "tolerance": 0.01, "unit": "rad", "feedback": FEEDBACK}
    second = questions.asked(name="choice-4", **MEASURED, **given)
    script, style = (BOOK / "_static" / name for name in ("choice.js", "course.css"))
    html = written(first) + written(second)
    page.set_content(f"<!doctype html><style>{style.read_text()}</style>{html}")
    page.add_script_tag(path=script)
    page.locator("#choice-3-0").focus()
    page.keyboard.press("Space")
    said = page.locator("fieldset output")
    assert said.first.inner_text() == "No. Why G1 < G2"
    page.keyboard.press("ArrowUp")  # from the first option to the last
    assert said.first.inner_text() == "Yes. G1 < G2"
    for typed, text in (
        ("0.041", "Yes."),
        ("0.039", "Too low. It saturates."),
        ("0.061", "Too high."),
        ("2.9", "No. In degrees."),
        ("1.0", "Too high."),
        ("", ""),
    ):
        page.locator("#choice-4-0").fill(typed)
        page.keyboard.press("Tab")
        assert said.last.inner_text() == text
        shown = [
            t.inner_text()
            for t in page.locator(".number .feedback").all()
            if t.is_visible()
        ]
        assert shown == [text] * bool(text)


@pytest.mark.browser
@pytest.mark.parametrize(
    "answer",
    [
        lambda page: [page.locator("#choice-5-0").press(key) for key in ("3", "Tab")],
        lambda page: page.locator("summary").click(),
        lambda page: page.evaluate("location.hash = 'result'"),
    ],
    ids=["a number", "our answer", "a link"],
)
def test_the_rest_of_a_section_waits_for_an_answer(page, answer):
    given = {"value": 4.0, "tolerance": 0.1, "unit": "", "feedback": FEEDBACK}
    asked = questions.asked(name="choice-5", **MEASURED, **given)
    rest = '<div><p id="result">4</p></div></section><section><p id="later">Next</p></section>'
    style, script = (BOOK / "_static" / name for name in ("course.css", "choice.js"))
    head = f"<!doctype html><style>{style.read_text()}</style>"
    page.set_content(f"{head}<section>{written(asked)}{questions.HIDES}{rest}")
    page.add_script_tag(path=script)
    result, note = page.locator("#result"), page.locator(".after-answer")
    assert (result.is_visible(), note.is_visible()) == (False, True)
    assert page.locator("#later").is_visible()
    answer(page)
    note.wait_for(state="hidden")  # a fold tells later that it was opened
    result.wait_for()
