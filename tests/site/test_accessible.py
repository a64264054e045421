"""A lecture by keyboard: what the sweep of all pages only looks at is used here."""

from collections.abc import Iterator

import pytest
from built_site import LESSON_PAGES
from playwright.sync_api import Page, expect
from watching import MOVING, settle

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l02-life-cycle/lecture.html"


@pytest.fixture(scope="module")
def page(browser) -> Iterator[Page]:
    page = browser.new_page(viewport={"width": 320, "height": 700})
    page.clock.install()  # it runs as ever, and can be put forward
    yield page
    page.close()


def test_a_box_scrolls_by_keyboard(page, address):
    page.goto(f"{address}/evidence/ledger.html")
    settle(page)
    page.locator("#figures-and-tables .scroll-box").first.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("document.activeElement.scrollLeft > 0")


@pytest.fixture(scope="module")
def lecture(page, address) -> Page:
    page.set_viewport_size({"width": 1280, "height": 700})
    page.goto(f"{address}/{LECTURE}")
    return page


def test_the_skip_link_leads_past_the_menu(lecture):
    lecture.keyboard.press("Tab")
    lecture.keyboard.press("Enter")
    lecture.keyboard.press("Tab")
    assert lecture.evaluate("document.activeElement.closest('main') !== null")


def test_every_fold_opens_by_keyboard(lecture):
    folds = lecture.query_selector_all("article details > summary:visible")
    is_open = "fold => fold.parentElement.open"
    before = [fold.evaluate(is_open) for fold in folds]
    for fold in reversed(folds):  # a fold inside of another comes after it
        fold.focus()
        lecture.keyboard.press("Enter")
    assert [fold.evaluate(is_open) for fold in folds] == [not was for was in before]
    assert len(folds) > 20


def test_motion_remains_without_the_request(lecture):
    assert lecture.evaluate(MOVING)


pytestmark = [pytest.mark.engine, pytest.mark.browser]

MOST = 150
STOPS = """() => new Set([...document.querySelectorAll(
  "article :is(a[href], button, input, select, textarea, summary, [tabindex])"
)].filter((one) =>
  one.tabIndex >= 0 && !one.disabled && one.checkVisibility({ visibilityProperty: true })
).map((one) => one.type === "radio" ? one.name : one)).size"""
"""Radio buttons of one name are one stop: the arrow keys choose among them."""
LECTURES = [name for (_, page), name in LESSON_PAGES.items() if page == "lecture"]


@pytest.mark.parametrize("name", LECTURES)
def test_a_lecture_has_few_tab_stops(browser, address, name):
    page = browser.new_page()
    page.goto(f"{address}/{name}.html")
    stops = page.evaluate(STOPS)
    assert 0 < stops <= MOST
    page.evaluate("document.querySelector('article').innerHTML += '<a href=#x>a</a>'.repeat(151)")
    assert page.evaluate(STOPS) > MOST
    page.close()


def test_code_can_be_copied_where_the_pointer_or_the_focus_is(browser, address):
    page = browser.new_page()
    page.goto(f"{address}/lessons/l02-life-cycle/lecture.html")
    block = page.locator("article .highlight:has(> pre):visible").first
    button = block.locator("button.copybtn")
    expect(button).to_be_hidden()
    block.hover()
    expect(button).to_be_visible()
    page.mouse.move(0, 0)
    expect(button).to_be_hidden()
    block.locator("pre").evaluate("code => { code.tabIndex = 0; code.focus(); }")
    expect(button).to_be_visible()
    page.close()
