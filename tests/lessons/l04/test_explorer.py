"""The step explorer in a real browser: it shows the page's own data, by keyboard and offline."""

import json
from collections.abc import Iterator

import pytest
from bs4 import BeautifulSoup
from playwright.sync_api import Page
from watching import errors

from robo_genesis.core.quantities import format_value
from robo_genesis.evidence import bundle
from robo_genesis.lessons.l04.metrics import StepMetrics

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"


@pytest.fixture(scope="module")
def lecture(site) -> BeautifulSoup:
    return BeautifulSoup((site / LECTURE).read_text(), "html.parser")


@pytest.fixture(scope="module")
def grid(site) -> BeautifulSoup:
    """The page that ran the grid."""
    page = site / LECTURE.replace("lecture", "deeper-batch")
    return BeautifulSoup(page.read_text(), "html.parser")


@pytest.fixture(scope="module")
def data(lecture) -> dict:
    return json.loads(lecture.select_one(".explorer")["data-grid"])


@pytest.fixture(scope="module", params=["served", "from disk"])
def page(request, browser, address, site) -> Iterator[Page]:
    """The lecture on a phone: served in the light, from disk in the dark."""
    base, scheme = {"served": (address, "light"), "from disk": (site.as_uri(), "dark")}[
        request.param
    ]
    page = browser.new_page(viewport={"width": 320, "height": 900}, color_scheme=scheme)
    problems = errors(page)
    page.goto(f"{base}/{LECTURE}")
    yield page
    assert problems == []
    page.close()


@pytest.fixture(scope="module")
def opened(page) -> tuple[str, dict[str, str]]:
    """What the widget shows before anybody touches it."""
    return shown(page)


@pytest.fixture(autouse=True)
def untouched(request) -> None:
    """Look at the widget before a test moves it."""
    if "page" in request.fixturenames:
        request.getfixturevalue("opened")


def press(page, name, key):
    page.locator(f"#explorer-{name}").focus()
    page.keyboard.press(key)


def shown(page):
    """Return what the widget shows as the packed data has it: (sentence, metrics)."""
    terms, values = (page.locator(f".explorer {tag}").all_inner_texts() for tag in ("dt", "dd"))
    return page.locator(".explorer output").inner_text(), dict(zip(terms, values, strict=True))


def expected(data, step, kp, kv):
    sizes = [len(axis["values"]) for axis in data["axes"]]
    point = data["points"][(step * sizes[1] + kp) * sizes[2] + kv]
    return point["sentence"], dict(zip(data["labels"], point["metrics"], strict=True))


def test_keys_move_to_a_run_and_all_of_it_is_shown(page, data):
    for name in ("step", "kp", "kv"):
        press(page, name, "Home")
    assert shown(page) == expected(data, 0, 0, 0)
    curve = page.locator('.explorer svg[data-curve="q"] polyline')
    before = curve.get_attribute("points")
    press(page, "step", "End")
    press(page, "kp", "ArrowRight")
    press(page, "kp", "ArrowRight")
    press(page, "kv", "ArrowRight")
    assert shown(page) == expected(data, 3, 2, 1)
    assert len({shown(page)[0], expected(data, 0, 0, 0)[0]}) == 2
    points = curve.get_attribute("points")
    assert points != before
    assert len(points.split()) == len(data["points"][0]["q"])
    assert page.locator("#explorer-kp").get_attribute("aria-valuetext") == "5250 N·m/rad"


def test_the_curve_is_drawn_to_scale(page, data):
    """The lowest and highest point of the drawn force are the packed ones, between the limits."""
    for name, key in (("step", "End"), ("kp", "End"), ("kv", "Home")):
        press(page, name, key)
    force = [value * data["resolution"]["force"] for value in data["points"][95]["force"]]
    drawn = page.locator('.explorer svg[data-curve="force"]').evaluate("""svg => ({
        y: svg.querySelector("polyline").getAttribute("points").split(" ")
          .map(pair => Number(pair.split(",")[1])),
        limits: [...svg.querySelectorAll("line.limit")].map(l => Number(l.getAttribute("y1")))
    })""")
    low, high = drawn["limits"]
    to_force = [(y - low) / (high - low) * 2 * data["limit"] - data["limit"] for y in drawn["y"]]
    assert to_force == pytest.approx(force, abs=0.1)  # coordinates have one decimal


def test_the_widget_opens_at_g2_with_what_the_bundle_holds(opened, site):
    sentence, metrics = opened
    assert "(the case G2)" in sentence
    records = bundle.read_metrics(site.parent / "evidence" / "l04" / "cpu")["G2"]
    assert metrics == {
        label: format_value(records[name].value, records[name].unit)
        for name, label in StepMetrics.about("label").items()
        if name != "initial_error"
    }


def test_controls_and_pictures_have_names(page):
    names = page.locator(".explorer input").evaluate_all(
        "all => all.map(i => i.labels[0].textContent)"
    )
    assert [name.split()[0] for name in names] == ["Step", "KP", "KV"]
    pictures = page.locator(".explorer svg").evaluate_all(
        "all => all.map(svg => [svg.getAttribute('role'), svg.getAttribute('aria-label')])"
    )
    assert [role for role, _ in pictures] == ["img", "img"]
    assert all("joint4 over time. KP 7000" in label for _, label in pictures)
    assert page.locator(".explorer output").get_attribute("aria-live") == "polite"


def test_nothing_in_the_widget_is_cut_off_on_a_phone(page):
    overflow = page.locator(".explorer").evaluate("""root => {
      const edge = root.getBoundingClientRect().right;
      return [...root.querySelectorAll("input, output, svg, svg text, dl div")]
        .filter(e => e.getBoundingClientRect().right > edge).map(e => e.textContent);
    }""")
    assert overflow == []


def test_text_and_curves_stand_out_from_the_ground(page):
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
        curve: of(".curve", "stroke"), limit: of(".limit", "stroke"),
      };
    }""")
    assert min(contrasts["output"], contrasts["text"]) >= 4.5, contrasts
    assert min(contrasts["curve"], contrasts["limit"]) >= 3, contrasts


def test_the_script_is_deferred_and_on_no_other_page(site, lecture):
    (script,) = lecture.select("script[src*='explorer.js']")
    assert script.has_attr("defer")
    others = [path for path in site.rglob("*.html") if "explorer.js" in path.read_text()]
    assert [path.name for path in others] == ["lecture.html"]


def test_every_run_is_in_the_folded_table_of_the_page_of_the_grid(grid, data):
    tables = [table for table in grid.select("table") if len(table.select("tr")) > 50]
    (table,) = tables
    assert len(table.select("tbody tr")) == len(data["points"])


def test_the_grid_s_checks_passed(grid):
    (table,) = grid.select("#can-a-copy-among-many-be-trusted table")
    rows = [[cell.get_text(strip=True) for cell in row.select("td")] for row in table.select("tr")]
    assert [row[:2] for row in rows if row] == [
        ["grid_matches_cases", "passed"],
        ["grid_within_gains", "passed"],
    ]
