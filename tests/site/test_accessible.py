"""Each page for readers with a keyboard, a screen reader, large text, or a wish for less motion."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page
from watching import drawn, page_names, violations

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
# Width [px], colour scheme, text size [%] of each state in which every page is looked at.
STATES = {
    "light": (1280, "light", 100),
    "dark": (1280, "dark", 100),
    "narrow": (320, "light", 100),
    "large text": (1280, "light", 200),
}
# axe-core skips what a closed fold hides, so each page is looked at once more with all folds open.
OPENED = ("light", "dark", "narrow")
AXE = {
    "runOnly": {"type": "tag", "values": RULES},
    "rules": {"target-size": {"enabled": True}},  # WCAG 2.2 AA, and off by default
}
OPEN_ALL = """() => {
  const folds = [...document.querySelectorAll("article details:not([open])")];
  for (const fold of folds) fold.open = true;
  return folds.length;
}"""
SCROLLING = """() => [...document.querySelectorAll("article *")].filter(element => {
  const { overflowX, visibility } = getComputedStyle(element);
  return /auto|scroll/.test(overflowX) && element.scrollWidth > element.clientWidth
    && element.clientWidth && visibility === "visible";
}).map(element => ({
  what: element.outerHTML.slice(0, 100),
  reached: element.tabIndex === 0,
  named: !!(element.ariaLabel || element.querySelector(":scope > figcaption, :scope > caption")),
}))"""
MOVING = """() => [...document.querySelectorAll("*")].filter(element => {
  const style = getComputedStyle(element);
  return parseFloat(style.transitionDuration) > 0 || style.animationName !== "none"
    || style.scrollBehavior === "smooth";
}).length"""
THEME_WAITS = 300
"""How long after a change the theme looks again which boxes scroll [ms of the page's clock]."""


def settle(page: Page) -> None:
    """Let our script and then the theme mark the boxes that scroll, as they do after a change."""
    drawn(page)
    page.clock.run_for(THEME_WAITS)


def put_into(page: Page, state: str) -> None:
    width, scheme, text = STATES[state]
    page.set_viewport_size({"width": width, "height": 900})
    page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    page.evaluate(f"document.documentElement.style.fontSize = '{text}%'")
    settle(page)


@pytest.fixture
def page(browser) -> Iterator[Page]:
    page = browser.new_page()
    page.clock.install()  # it runs as ever, and can be put forward
    yield page
    page.close()


def test_each_page_can_be_used_in_every_state(page, address, site):
    """axe-core finds nothing; boxes that scroll have focus and name; nothing is wide or moves."""
    found, opened, kinds = {}, 0, set()

    def look(name: str, state: str, folds: str) -> None:
        put_into(page, state)
        problems = violations(page, **AXE)
        if page.evaluate("document.documentElement.scrollWidth > innerWidth"):
            problems.append("wider than the window")
        if page.evaluate(MOVING):
            problems.append("moves")
        if folds == "open":
            boxes = page.evaluate(SCROLLING)
            kinds.update(box["what"].split()[0] for box in boxes)
            problems += [box["what"] for box in boxes if not (box["reached"] and box["named"])]
        if problems:
            found[f"{name}, {state}, folds {folds}"] = problems

    for name in (*page_names(site), "search.html?q=joint"):
        page.goto(f"{address}/{name}")
        assert page.evaluate("[...document.querySelectorAll('*')].every(e => e.tabIndex <= 0)")
        for state in STATES:
            look(name, state, "closed")
        opened += page.evaluate(OPEN_ALL)
        for state in OPENED:
            look(name, state, "open")
    assert found == {}
    assert opened > 20
    assert {"<pre", "<figure", "<div"} <= kinds


def test_motion_remains_without_the_request(page, address):
    page.goto(f"{address}/{LECTURE}")
    assert page.evaluate(MOVING) > 0


@pytest.mark.parametrize(
    ("spoil", "rule"),
    [
        ("document.querySelector('article img').removeAttribute('alt')", "image-alt"),
        ("document.querySelector('#pst-primary-sidebar').removeAttribute('role')", "region"),
        ("document.querySelector('article p').style.color = '#aaa'", "color-contrast"),
        (
            "for (const link of document.querySelectorAll('nav.bd-docs-nav a')) link.style ="
            " 'display: block; height: 8px; padding: 0; overflow: hidden'",
            "target-size",
        ),
    ],
)
def test_axe_would_find_it(page, address, spoil, rule):
    page.goto(f"{address}/index.html")
    put_into(page, "light")
    page.evaluate(spoil)
    assert rule in {line.partition(":")[0] for line in violations(page, **AXE)}


FOCUSED = """() => {
  const element = document.activeElement;
  if (element === document.body) return null;
  const style = getComputedStyle(element);
  const boxes = [...element.getClientRects()].filter(box => box.width && box.height);
  const seen = boxes.some(box => {
    const [left, top] = [Math.max(box.left, 0), Math.max(box.top, 0)];
    const [right, bottom] = [Math.min(box.right, innerWidth), Math.min(box.bottom, innerHeight)];
    if (right <= left || bottom <= top) return false;
    return [0.1, 0.5, 0.9].some(share => {
      const at = document.elementFromPoint(left + share * (right - left), (top + bottom) / 2);
      return element.contains(at);
    });
  });
  let opaque = 1;
  for (let e = element; e; e = e.parentElement) opaque *= getComputedStyle(e).opacity;
  return {
    what: element.outerHTML.slice(0, 120),
    first: !element.dataset.visited && (element.dataset.visited = "yes"),
    outlined: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
    seen: seen && opaque > 0.5,
  };
}"""


def tab_through(page: Page) -> list[dict]:
    """Press Tab until the focus leaves the page, or comes back to where it was."""
    stops = []
    while len(stops) < 1500:
        page.keyboard.press("Tab")
        stop = page.evaluate(FOCUSED)
        if stop is None or not stop["first"]:
            return stops
        stops.append(stop)
    raise AssertionError(f"Tab does not come to an end: {stops[-1]}")


@pytest.mark.parametrize("width", [1280, 320])
def test_the_focus_is_seen_wherever_it_goes(page, address, site, width):
    page.set_viewport_size({"width": width, "height": 700})
    page.emulate_media(reduced_motion="reduce")
    for name in page_names(site):
        page.goto(f"{address}/{name}")
        settle(page)
        stops = tab_through(page)
        assert "Skip to main content" in stops[0]["what"]
        assert len(stops) > 4
        hidden = [stop for stop in stops if not (stop["outlined"] and stop["seen"])]
        assert hidden == [], name


def test_the_skip_link_leads_past_the_menu(page, address):
    page.goto(f"{address}/{LECTURE}")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.closest('main') !== null")


@pytest.mark.parametrize(
    ("name", "box"),
    [
        (LECTURE, "article figure[tabindex='0']"),
        ("evidence/ledger.html", "#figures-and-tables .scroll-box"),
    ],
)
def test_a_box_scrolls_by_keyboard(page, address, name, box):
    page.set_viewport_size({"width": 320, "height": 700})
    page.goto(f"{address}/{name}")
    settle(page)
    page.locator(box).first.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("document.activeElement.scrollLeft > 0")


def test_every_fold_opens_by_keyboard(page, address):
    page.goto(f"{address}/{LECTURE}")
    folds = page.locator("article details > summary:visible")
    opened = 0
    for fold in folds.all():
        before = fold.evaluate("summary => summary.parentElement.open")
        fold.focus()
        page.keyboard.press("Enter")
        opened += fold.evaluate("summary => summary.parentElement.open") != before
        page.keyboard.press("Enter")
    assert opened == folds.count() > 20
