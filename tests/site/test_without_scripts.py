"""What a reader without scripts has of the lecture."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"
REPLAY = ".replay[data-name=replay-l04-lecture-cpu]"
BLOCK = f".replay-block:has({REPLAY})"


@pytest.fixture(scope="module")
def page(browser, address) -> Iterator[Page]:
    page = browser.new_page(java_script_enabled=False)
    page.goto(f"{address}/{LECTURE}")
    yield page
    page.close()


def test_the_page_has_its_colours(page):
    expect(page.locator("article h2").first).to_have_css("border-top-width", "1px")


def test_of_the_replay_picture_figures_and_table_remain(page):
    assert page.locator(f"{REPLAY} .still").is_visible()
    assert page.locator(f"{REPLAY} .shown").inner_text() == "at the start"
    assert not page.locator(f"{REPLAY} button").is_visible()
    assert not page.locator(f"{REPLAY} .panel").is_visible()
    assert page.locator("#fig-l04-gains svg").is_visible()
    assert page.locator("#fig-l04-posture img").is_visible()
    page.locator(f"{BLOCK} summary").click()
    assert page.get_by_text("moves farthest").first.is_visible()
    assert page.locator(f"{BLOCK} tbody tr").count() == 121
    assert page.locator(f"{BLOCK} table").is_visible()


def test_of_the_explorer_a_sentence_remains(page):
    assert not page.locator(".explorer .panel").is_visible()
    assert page.get_by_text("The explorer needs JavaScript").is_visible()
