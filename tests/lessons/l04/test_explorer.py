"""The step explorer in a real browser: it shows and judges the recorded runs, also offline."""

import json
from collections.abc import Iterator

import pytest
from built_site import parsed
from playwright.sync_api import Page
from watching import errors, readout, show_all

from robo_genesis.core.comparison import order

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/motion"


@pytest.fixture(scope="module")
def data(site) -> dict:
    return json.loads(parsed(site, LECTURE).select_one(".explorer")["data-explorer"])


@pytest.fixture(scope="module", params=["light", "dark"])
def opened(request, browser, address, site) -> Iterator[tuple[Page, str]]:
    """A window of a phone and the address of the lecture: in the light, from disk in the dark."""
    base, size = (
        {"light": address, "dark": site.as_uri()},
        {"width": 320, "height": 900},
    )
    page = browser.new_page(viewport=size, color_scheme=request.param, has_touch=True)
    problems = errors(page)
    yield page, f"{base[request.param]}/{LECTURE}.html"
    assert problems == []
    page.close()


@pytest.fixture
def page(opened) -> Page:
    """The lecture, freshly loaded."""
    page, address = opened
    page.goto(address)
    show_all(page)
    return page


def choose(page, kp, kv):
    page.locator(f".explorer [role=gridcell][aria-label*='KP {kp}, KV {kv}']").tap()


def without_question(page, kp, kv):
    page.get_by_label("Predict first").uncheck()
    choose(page, kp, kv)
    page.get_by_label("Predict first").check()


def answer(page, text):
    page.locator(".explorer .question").get_by_role(
        "button", name=text, exact=True
    ).click()


def shown(page):
    """Return what the widget shows as the packed data has it: (sentence, metrics)."""
    said = page.locator(".explorer output").inner_text()
    return said, readout(page, ".explorer", "dd:not(.last)")


def run_of(data, step, kp, kv):
    """Return the packed run of a point."""
    (grid,) = (one for one in data["maps"] if one["label"] == f"{step:g} rad")
    cells = (one for row in grid["rows"] for one in row["cells"])
    return next(one for one in cells if one["name"] == f"KP {kp}, KV {kv}")


def expected(data, step, kp, kv):
    run = run_of(data, step, kp, kv)
    return run["sentence"], dict(zip(data["columns"], run["values"], strict=True))


def test_it_opens_at_g2(page, data):
    assert "(the case G2)" in shown(page)[0]
    assert shown(page) == expected(data, 0.25, 7000, 100)


QUESTIONS = [
    # the answers before, the run before and the run, the question's metric, the answer,
    # its verdict
    (0, (7000, 100), (6125, 100), "rise time", "too close to call", "Yes"),
    (1, (7000, 100), (6125, 100), "overshoot", "lower", "Yes"),
    (1, (7000, 100), (3500, 300), "overshoot", "too close to call", "No"),
]


@pytest.mark.parametrize(
    ("earlier", "first", "second", "noun", "said", "verdict"), QUESTIONS
)
def test_a_prediction_is_judged_by_runs(
    page, data, earlier, first, second, noun, said, verdict
):
    for turn in range(earlier):
        choose(page, *((7000, 150), (7000, 100))[turn % 2])
        answer(page, "Skip")
    without_question(page, *first)
    before = shown(page)[1]
    choose(page, *second)
    question = page.locator(".explorer .question legend").inner_text()
    assert question.endswith(f"what happens to the {noun}?")
    assert shown(page)[1] == before  # nothing is shown before the answer
    answer(page, said)
    output, metrics = shown(page)
    k = [measure["noun"] for measure in data["measures"]].index(noun)
    numbers = (run_of(data, 0.25, *of)["numbers"][k] for of in (first, second))
    measure = data["measures"][k]
    found = order(*numbers, measure["margin"])
    words = {"equal": "too close to call"}.get(found) or measure[found]
    assert (words == said) == (verdict == "Yes")
    assert output.startswith(f"{verdict}. The {noun}: {words}, first ")
    assert (f"The margin is {measure['within']}." in output) == (found == "equal")
    assert output.endswith(expected(data, 0.25, *second)[0])
    assert metrics == expected(data, 0.25, *second)[1]


def test_where_neither_run_has_a_rise_time_the_record_cannot_tell(page):
    page.get_by_label("Step of joint4").select_option("0.02 rad")
    without_question(page, 3500, 300)
    choose(page, 3500, 250)
    overflow = page.locator(".explorer").evaluate("""root => {
      const edge = root.getBoundingClientRect().right;
      return [...root.querySelectorAll("input, select, button, td, output, svg, svg text, dl div")]
        .filter(e => e.getBoundingClientRect().right > edge).map(e => e.textContent);
    }""")
    assert overflow == []  # on a phone, with the question open
    answer(page, "this record cannot tell")
    assert shown(page)[0].startswith(
        "Yes. The rise time: this record cannot tell, first not obs"
    )


def test_the_curve_is_drawn_to_scale(page, data):
    """The lowest and highest point of the drawn force are the packed ones, between the limits."""
    packed = run_of(data, 0.25, 7000, 100)["force"]
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
