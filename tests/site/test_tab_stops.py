"""A reader with a keyboard gets through a lecture with few stops."""

import pytest
from built_site import LESSON_PAGES
from playwright.sync_api import expect

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
