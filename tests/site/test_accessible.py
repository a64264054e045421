"""A lecture by keyboard: what the sweep of all pages only looks at is used here."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page
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
