"""The step explorer in a real browser: it shows and judges the recorded runs, also offline."""

import json
from collections.abc import Iterator

import numpy as np
import pytest
from bs4 import BeautifulSoup
from playwright.sync_api import Page
from watching import errors

from robo_genesis.core.comparison import order
from robo_genesis.core.text import format_value
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import ENTRY
from robo_genesis.lessons.l04.study_spec import POINTS

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"


@pytest.fixture(scope="module")
def lecture(site) -> BeautifulSoup:
    return BeautifulSoup((site / LECTURE).read_text(), "html.parser")


@pytest.fixture(scope="module")
def data(lecture) -> dict:
    return json.loads(lecture.select_one(".explorer")["data-explorer"])


@pytest.fixture(scope="module", params=["served", "from disk"])
def opened(request, browser, address, site) -> Iterator[tuple[Page, str]]:
    """A window of a phone and the address of the lecture: in the light, from disk in the dark."""
    base, scheme = {"served": (address, "light"), "from disk": (site.as_uri(), "dark")}[
        request.param
    ]
    page = browser.new_page(
        viewport={"width": 320, "height": 900}, color_scheme=scheme, has_touch=True
    )
    problems = errors(page)
    yield page, f"{base}/{LECTURE}"
    assert problems == []
    page.close()


@pytest.fixture
def page(opened) -> Page:
    """The lecture, freshly loaded."""
    page, address = opened
    page.goto(address)
    return page


def cell(page, kp, kv):
    return page.locator(f".explorer [role=gridcell][aria-label*='KP {kp}, KV {kv}']")


def chosen(page):
    return page.locator(".explorer [aria-selected=true]")


def press(page, *keys):
    """Press keys on the map."""
    chosen(page).focus()
    for key in keys:
        page.keyboard.press(key)


def answer(page, text):
    page.locator(".explorer .question").get_by_role("button", name=text, exact=True).click()


def without_questions(page):
    page.get_by_label("Predict first").uncheck()


def shown(page):
    """Return what the widget shows as the packed data has it: (sentence, metrics)."""
    terms, values = (
        page.locator(f".explorer {tag}").all_inner_texts() for tag in ("dt", "dd:not(.last)")
    )
    return page.locator(".explorer output").inner_text(), dict(zip(terms, values, strict=True))


def run_of(data, step, kp, kv):
    """Return the packed run of a point."""
    (grid,) = (one for one in data["maps"] if one["label"] == f"{step:g} rad")
    cells = (one for row in grid["rows"] for one in row["cells"])
    return next(one for one in cells if one["name"] == f"KP {kp}, KV {kv}")


def drawn_samples(data):
    """Return the number of drawn positions, the one at t = 0 included."""
    return round(data["curves"]["until"] / data["curves"]["dt"]) + 1


def expected(data, step, kp, kv):
    run = run_of(data, step, kp, kv)
    return run["sentence"], dict(zip(data["columns"], run["values"], strict=True))


def test_arrow_keys_choose_a_run_and_all_of_it_is_shown(page, data):
    without_questions(page)
    curve = page.locator('.explorer svg[data-curve="q"] .chosen')
    before = curve.get_attribute("points")
    press(page, "ArrowUp", "ArrowDown", "ArrowDown", "ArrowRight")  # the first leaves the map
    assert shown(page) == expected(data, 0.25, 5250, 150)
    points = curve.get_attribute("points")
    assert points != before
    assert len(points.split()) == drawn_samples(data)
    assert "KP 5250, KV 150" in chosen(page).get_attribute("aria-label")
    assert chosen(page).evaluate("cell => cell === document.activeElement")


def test_a_touch_and_another_step_choose_a_run(page, data):
    without_questions(page)
    cell(page, 3500, 300).tap()
    assert shown(page) == expected(data, 0.25, 3500, 300)
    page.get_by_label("Step of joint4").select_option("0.05 rad")
    assert shown(page) == expected(data, 0.05, 3500, 300)


@pytest.mark.parametrize(
    ("measure", "factor", "within"),
    [
        ("saturation [samples]", 1, 0),
        ("rise time [ms]", 1000, 0.5),
        ("overshoot [mrad]", 1000, 0.05),
    ],
)
def test_each_cell_of_the_map_holds_its_measured_number(page, data, measure, factor, within):
    page.get_by_label("Map shows").select_option(measure)
    k = [one["label"] for one in data["measures"]].index(measure)
    for kp, kv in ((7000, 100), (3500, 300), (6125, 150)):
        value = run_of(data, 0.25, kp, kv)["numbers"][k] * factor
        text = cell(page, kp, kv).inner_text().split()[-1]
        assert float(text) == pytest.approx(value, abs=within + 1e-9)
    grounds = page.locator(".explorer [role=gridcell]").evaluate_all(
        "all => all.map(one => getComputedStyle(one).backgroundColor)"
    )
    assert len(set(grounds)) > 3


def judged(data, noun, *gains):
    """Return the order of the second run by Python's rule."""
    k = [measure["noun"] for measure in data["measures"]].index(noun)
    numbers = (run_of(data, 0.25, *of)["numbers"][k] for of in gains)
    return data["measures"][k], order(*numbers, data["measures"][k]["margin"])


QUESTIONS = [
    # the answers before, the run before and the run, the question's metric, the answer, its verdict
    (0, (7000, 100), (6125, 100), "rise time", "too close to call", "Yes"),
    (0, (7000, 100), (6125, 100), "rise time", "earlier", "No"),
    (0, (7000, 100), (3500, 300), "rise time", "later", "Yes"),
    (1, (7000, 100), (6125, 100), "overshoot", "lower", "Yes"),
    (1, (7000, 100), (6125, 100), "overshoot", "too close to call", "No"),
    (2, (7000, 100), (3500, 300), "peak speed", "lower", "Yes"),
]


@pytest.mark.parametrize(("earlier", "first", "second", "noun", "said", "verdict"), QUESTIONS)
def test_a_prediction_is_judged_by_the_recorded_runs(
    page, data, earlier, first, second, noun, said, verdict
):
    for turn in range(earlier):
        cell(page, *((7000, 150), (7000, 100))[turn % 2]).tap()
        answer(page, "Skip")
    if earlier % 2:
        without_questions(page)
        cell(page, *first).tap()
        page.get_by_label("Predict first").check()
    before = shown(page)[1]
    cell(page, *second).tap()
    question = page.locator(".explorer .question legend").inner_text()
    assert question == page.locator(".explorer output").text_content()
    assert question.endswith(f"what happens to the {noun}?")
    assert shown(page)[1] == before  # nothing is shown before the answer
    answer(page, said)
    output, metrics = shown(page)
    measure, found = judged(data, noun, first, second)
    words = {"equal": "too close to call"}.get(found) or measure[found]
    assert (words == said) == (verdict == "Yes")
    assert output.startswith(f"{verdict}. The {noun}: {words}, first ")
    assert (f"The margin is {measure['within']}." in output) == (found == "equal")
    assert output.endswith(expected(data, 0.25, *second)[0])
    assert metrics == expected(data, 0.25, *second)[1]


def test_where_neither_run_has_a_rise_time_the_record_cannot_tell(page):
    without_questions(page)
    page.get_by_label("Step of joint4").select_option("0.02 rad")
    cell(page, 3500, 300).tap()
    page.get_by_label("Predict first").check()
    cell(page, 3500, 250).tap()
    answer(page, "these runs cannot show it")
    assert shown(page)[0].startswith("Yes. The rise time: these runs cannot show it, first not obs")


def test_no_run_moves_visibly_after_the_end_of_the_plots(data, site):
    folder = site.parent / "pages" / "l04" / "batch" / "cpu"
    described = bundle.read_arrays(folder)
    for point in POINTS:
        trace = read_any_trace(folder, described, point.name)
        late = trace.q[drawn_samples(data) - 1 :, ENTRY]
        assert late.size > 1
        assert np.ptp(late) < 5e-4, point.name  # rad


def test_the_curve_is_drawn_to_scale(page, data):
    """The lowest and highest point of the drawn force are the packed ones, between the limits."""
    packed = run_of(data, 0.25, 7000, 100)["force"]
    assert len(packed) == drawn_samples(data) - 1
    force = [value * data["curves"]["drawn"][1]["unit"] for value in packed]
    limit = max(level["value"] for level in data["maps"][0]["axes"]["force"]["levels"])
    drawn = page.locator('.explorer svg[data-curve="force"]').evaluate("""svg => ({
        y: svg.querySelector("polyline").getAttribute("points").split(" ")
          .map(pair => Number(pair.split(",")[1])),
        limits: [...svg.querySelectorAll("line.limit")].map(l => Number(l.getAttribute("y1")))
    })""")
    low, high = drawn["limits"]
    to_force = [(y - low) / (high - low) * 2 * limit - limit for y in drawn["y"]]
    assert to_force == pytest.approx(force, abs=0.1)  # coordinates have one decimal


def test_the_widget_opens_at_g2_with_what_the_bundle_holds(page, site):
    sentence, metrics = shown(page)
    assert "(the case G2)" in sentence
    records = bundle.read_metrics(site.parent / "evidence" / "l04" / "cpu")["G2"]
    assert metrics == {
        label: format_value(records[name].value, records[name].unit)
        for name, label in StepMetrics.about("label").items()
        if name != "initial_error"
    }


def test_nothing_in_the_widget_is_cut_off_on_a_phone(page):
    without_questions(page)
    cell(page, 5250, 200).tap()
    page.get_by_label("Predict first").check()
    cell(page, 5250, 250).tap()
    overflow = page.locator(".explorer").evaluate("""root => {
      const edge = root.getBoundingClientRect().right;
      return [...root.querySelectorAll("input, select, button, td, output, svg, svg text, dl div")]
        .filter(e => e.getBoundingClientRect().right > edge).map(e => e.textContent);
    }""")
    assert overflow == []


def test_text_and_curves_stand_out_from_the_ground(page):
    without_questions(page)
    cell(page, 6125, 100).tap()
    contrasts = page.locator(".explorer").evaluate("""root => {
      const light = text => text.match(/[\\d.]+/g).slice(0, 3)
        .map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
        .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
      let ground = root;
      while (getComputedStyle(ground).backgroundColor === "rgba(0, 0, 0, 0)")
        ground = ground.parentElement;
      const of = (name, property) => {
        const found = getComputedStyle(root.querySelector(name))[property];
        const pair = [light(found), light(getComputedStyle(ground).backgroundColor)];
        pair.sort((a, b) => b - a);
        return (pair[0] + 0.05) / (pair[1] + 0.05);
      };
      return {
        output: of("output", "color"), text: of("svg text", "fill"),
        curve: of(".curve.chosen", "stroke"), limit: of(".limit", "stroke"),
        ghost: of(".curve.ghost", "stroke"), label: of(".ghost-label", "fill"),
      };
    }""")
    assert min(contrasts[name] for name in ("output", "text", "label")) >= 4.5, contrasts
    assert min(contrasts[name] for name in ("curve", "limit", "ghost")) >= 3, contrasts
