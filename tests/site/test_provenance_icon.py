"""The origin of a measured figure is one icon; its words appear for the mouse and the keyboard."""

import pytest
from playwright.sync_api import expect

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"


def wide(locator) -> bool:
    return locator.bounding_box()["width"] > 100


def test_the_words_come_with_mouse_and_focus_and_stay_for_what_was_not_measured(browser, address):
    page = browser.new_page()
    page.goto(f"{address}/{LECTURE}")
    measured = page.locator("article .provenance.as-icon:visible").first
    words, icon = measured.locator(".provenance-text"), measured.locator("a")
    expect(words).to_contain_text("Measured on cpu · Genesis")
    assert not wide(words)
    assert icon.bounding_box()["width"] == icon.bounding_box()["height"] >= 24
    icon.hover()
    assert wide(words)
    page.mouse.move(0, 0)
    assert not wide(words)
    icon.focus()
    assert wide(words)
    for other in page.locator("article .provenance:not(.as-icon):visible").all():
        assert "Measured" not in other.inner_text()
        assert wide(other)
    page.close()
