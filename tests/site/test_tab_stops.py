"""A reader with a keyboard gets through a lecture with few stops."""

import pytest
from built_site import LESSON_PAGES

from robo_genesis.site.page_sizes import EXEMPT

pytestmark = [pytest.mark.engine, pytest.mark.browser]

MOST = 150
MORE = {
    *EXEMPT, "lessons/l03-rigid-bodies/lecture", "lessons/l04-joint-control/lecture",
}  # fmt: skip
"""Lectures that still have more: excerpts, tables and the readers' tools come with stops."""
STOPS = """() => [...document.querySelectorAll(
  "article :is(a[href], button, input, select, textarea, summary, [tabindex])"
)].filter((one) => one.tabIndex >= 0 && !one.disabled && one.checkVisibility()).length"""
LECTURES = [name for (_, page), name in LESSON_PAGES.items() if page == "lecture"]


@pytest.mark.parametrize("name", LECTURES)
def test_a_lecture_has_few_tab_stops(browser, address, name):
    page = browser.new_page()
    page.goto(f"{address}/{name}.html")
    stops = page.evaluate(STOPS)
    assert stops > 0
    assert stops <= MOST or name in MORE
    page.evaluate("document.querySelector('article').innerHTML += '<a href=#x>a</a>'.repeat(151)")
    assert page.evaluate(STOPS) > MOST
    page.close()
