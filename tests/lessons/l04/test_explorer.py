"""The step explorer in a real browser: it shows the recorded runs, also offline."""

import json
from collections.abc import Iterator

import pytest
from built_site import parsed
from playwright.sync_api import Page
from watching import errors, readout, show_all

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


def test_a_run_is_shown_beside_the_last_one_on_a_phone(page, data):
    page.get_by_label("Step of joint4").select_option("0.02 rad")
    choose(page, 3500, 300)
    choose(page, 3500, 250)
    assert shown(page) == expected(data, 0.02, 3500, 250)
    last = readout(page, ".explorer", "dd.last").values()
    before = expected(data, 0.02, 3500, 300)[1].values()
    assert [*last] == [f"last run: {value}" for value in before]
    overflow = page.locator(".explorer").evaluate("""root => {
      const edge = root.getBoundingClientRect().right;
      return [...root.querySelectorAll("select, td, output, svg, svg text, dl div")]
        .filter(e => e.getBoundingClientRect().right > edge).map(e => e.textContent);
    }""")
    assert overflow == []


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
