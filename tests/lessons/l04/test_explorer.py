"""The step explorer in a real browser: it shows and judges the recorded runs, also offline."""

import json
from collections.abc import Iterator

import numpy as np
import pytest
from bs4 import BeautifulSoup
from playwright.sync_api import Page
from watching import errors

from robo_genesis.core.comparison import order

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"


@pytest.fixture(scope="module")
def data(site) -> dict:
    page = BeautifulSoup((site / LECTURE).read_text(), "html.parser")
    return json.loads(page.select_one(".explorer")["data-grid"])


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


def number(data, step, kp, kv):
    """Return the number of a point among the packed ones."""
    axes = [axis["values"] for axis in data["axes"]]
    at = [values.index(value) for values, value in zip(axes, (step, kp, kv), strict=True)]
    return (at[0] * len(axes[1]) + at[1]) * len(axes[2]) + at[2]


def drawn_samples(data):
    """Return the number of drawn positions, the one at t = 0 included."""
    return round(data["until"] / data["dt"]) + 1


def expected(data, step, kp, kv):
    point = data["points"][number(data, step, kp, kv)]
    return point["sentence"], dict(zip(data["labels"], point["metrics"], strict=True))


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
    cell(page, 3500, 300).tap()
    page.get_by_label("Step of joint4").select_option("0.05 rad")
    assert shown(page) == expected(data, 0.05, 3500, 300)
    page.get_by_label("Map shows").select_option("overshoot [mrad]")
    (found,) = (m for m in data["measures"] if m["noun"] == "overshoot")
    value = 1000 * found["values"][number(data, 0.05, 7000, 100)]
    assert float(cell(page, 7000, 100).inner_text().split()[-1]) == pytest.approx(value, abs=0.05)


def test_the_map_is_one_stop_for_the_keyboard(page):
    press(page, "ArrowRight")
    stops = page.locator(".explorer .map [tabindex='0']")
    assert stops.count() == 1
    assert chosen(page).get_attribute("tabindex") == "0"
    page.keyboard.press("Tab")
    assert page.locator(".explorer .question button").first.evaluate(
        "button => button === document.activeElement"
    )
    page.keyboard.press("Enter")
    assert chosen(page).evaluate("cell => cell === document.activeElement")


@pytest.mark.parametrize(
    ("turns", "second", "noun", "said", "verdict"),
    [
        (0, (6125, 100), "rise time", "too close to call", "Yes"),
        (0, (6125, 100), "rise time", "earlier", "No"),
        (1, (6125, 100), "overshoot", "lower", "Yes"),
    ],
)
def test_a_prediction_is_judged_by_the_recorded_runs(
    page, data, turns, second, noun, said, verdict
):
    """Compared with G2, after one further question for each turn."""
    for _ in range(turns):
        cell(page, 7000, 150).tap()
        answer(page, "Skip")
        without_questions(page)
        cell(page, 7000, 100).tap()
        page.get_by_label("Predict first").check()
    before = shown(page)[1]
    cell(page, *second).tap()
    question = page.locator(".explorer .question legend").inner_text()
    assert question == page.locator(".explorer output").text_content()
    assert question.endswith(f"what happens to the {noun}?")
    assert shown(page)[1] == before  # nothing is shown before the answer
    answer(page, said)
    output, metrics = shown(page)
    (measure,) = (m for m in data["measures"] if m["noun"] == noun)
    values = (measure["values"][number(data, 0.25, *run)] for run in ((7000, 100), second))
    found = order(*values, measure["margin"])
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


def test_the_last_run_stays_as_a_labelled_grey_line_with_its_metrics(page, data):
    assert page.locator(".explorer .ghost, .explorer dd.last").count() == 0
    without_questions(page)
    old = page.locator('.explorer svg[data-curve="force"] .chosen').get_attribute("points")
    cell(page, 3500, 150).tap()
    ghost = page.locator('.explorer svg[data-curve="force"] .ghost')
    assert ghost.get_attribute("points") == old
    labels = page.locator(".explorer .ghost-label").all_text_contents()
    assert labels == ["last run: KP 7000, KV 100"] * 2
    last = [text.removeprefix("last run: ") for text in
            page.locator(".explorer dd.last").all_inner_texts()]  # fmt: skip
    assert last == list(expected(data, 0.25, 7000, 100)[1].values())
    assert "the last run" in page.locator(".explorer .map .last").get_attribute("aria-label")


def test_controls_and_pictures_have_names(page):
    names = page.locator(".explorer :is(select, input)").evaluate_all(
        "all => all.map(i => i.labels[0].firstChild.textContent.trim() || i.name)"
    )
    assert names == ["Step of joint4", "Map shows", "predict"]
    assert page.get_by_role("grid", name="Map of the runs: saturation [samples].").is_visible()
    pictures = page.locator(".explorer svg").evaluate_all(
        "all => all.map(svg => [svg.getAttribute('role'), svg.getAttribute('aria-label')])"
    )
    assert [role for role, _ in pictures] == ["img", "img"]
    assert all("joint4 over time. KP 7000" in label for _, label in pictures)
    assert page.locator(".explorer output").get_attribute("aria-live") == "polite"


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


def test_the_curve_is_drawn_to_scale(page, data):
    """The drawn force is the packed one, between the limits."""
    force = np.array(data["points"][data["opens"]]["force"]) * data["resolution"]["force"]
    assert len(force) == drawn_samples(data) - 1
    drawn = page.locator('.explorer svg[data-curve="force"]').evaluate("""svg => ({
        y: svg.querySelector("polyline").getAttribute("points").split(" ")
          .map(pair => Number(pair.split(",")[1])),
        limits: [...svg.querySelectorAll("line.limit")].map(l => Number(l.getAttribute("y1")))
    })""")
    low, high = drawn["limits"]
    shares = (np.array(drawn["y"]) - low) / (high - low)
    found = (2 * shares - 1) * data["limit"]
    assert found == pytest.approx(force, abs=0.1)  # coordinates have one decimal


def test_the_script_is_deferred_and_on_no_other_page(site):
    pages = {path: path.read_text() for path in site.rglob("*.html")}
    (lecture,) = (path for path, text in pages.items() if "explorer.js" in text)
    (script,) = BeautifulSoup(pages[lecture], "html.parser").select("script[src*='explorer.js']")
    assert (lecture, script.has_attr("defer")) == (site / LECTURE, True)
