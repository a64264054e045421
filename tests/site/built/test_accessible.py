"""A lecture by keyboard and without scripts, which the sweep of all pages only looks at."""

import pytest
from built_site import LESSON_PAGES
from playwright.sync_api import expect
from watching import call

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l02-life-cycle/lecture.html"
PART_1, MEASURED = (
    f"lessons/l04-joint-control/{n}.html" for n in ("lecture", "motion")
)
REPLAY = ".replay[data-name=replay-l04-motion-cpu]"
BLOCK = f".replay-block:has({REPLAY})"


def test_the_skip_link_leads_past_the_menu(page, address):
    page.goto(f"{address}/{LECTURE}")
    for key in ("Tab", "Enter", "Tab"):
        page.keyboard.press(key)
    assert page.evaluate("document.activeElement.closest('main') !== null")


MOST = 160
LECTURES = [name for (_, page), name in LESSON_PAGES.items() if page == "lecture"]


@pytest.mark.parametrize("name", LECTURES)
def test_a_lecture_has_few_tab_stops(page, address, name):
    page.goto(f"{address}/{name}.html")
    stops = call(page, "tab_stops")
    assert 0 < stops <= MOST
    page.evaluate(
        "document.querySelector('article').innerHTML += '<a href=#x>a</a>'.repeat(151)"
    )
    assert call(page, "tab_stops") > MOST


def test_code_can_be_copied_where_the_pointer_or_the_focus_is(page, address):
    page.goto(f"{address}/{LECTURE}")
    block = page.locator("article .highlight:has(> pre):visible").first
    button = block.locator("button.copybtn")
    expect(button).to_be_hidden()
    block.hover()
    expect(button).to_be_visible()
    page.mouse.move(0, 0)
    expect(button).to_be_hidden()
    block.locator("pre").evaluate("code => { code.tabIndex = 0; code.focus(); }")
    expect(button).to_be_visible()


def wide(locator) -> bool:
    return locator.bounding_box()["width"] > 100


def test_the_words_come_with_mouse_and_focus_and_stay_for_what_was_not_measured(
    page, address
):
    page.goto(f"{address}/{MEASURED}")
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


def test_without_scripts_all_but_replay_and_explorer_remains(browser, address):
    bare = browser.new_page(java_script_enabled=False)
    bare.goto(f"{address}/{MEASURED}")
    expect(bare.locator("article h2").first).to_have_css("border-top-width", "1px")
    assert bare.locator(f"{REPLAY} .still").is_visible()
    assert bare.locator(f"{REPLAY} .shown").inner_text() == "at the start"
    assert not bare.locator(f"{REPLAY} button:visible").count()
    assert not bare.locator(f"{REPLAY} .panel").is_visible()
    assert not bare.locator(".veil:visible").count()
    assert bare.locator("#fig-l04-gains svg").is_visible()
    bare.locator(f"{BLOCK} summary").click()
    assert bare.locator(BLOCK).get_by_text("gets the target").first.is_visible()
    assert bare.locator(f"{BLOCK} tbody tr").count() == 121
    assert bare.locator(f"{BLOCK} table").is_visible()
    assert not bare.locator(".explorer .panel").is_visible()
    assert bare.locator(".explorer noscript p").is_visible()  # its text is not found
    bare.goto(f"{address}/{PART_1}")
    assert bare.locator("#fig-l04-posture img").is_visible()
    bare.close()
