"""A term is a button that shows its definition, with a link to its entry."""

import pytest
from browsers import launched
from built_site import parsed
from playwright.sync_api import expect
from watching import violations

SENTENCE = "How far it passes, counted along its DOF."


def test_a_term_has_its_definition_and_a_link_to_its_entry(small_site):
    entries, page = parsed(small_site, "glossary"), parsed(small_site, "terms")
    found = []
    for button in page.select("button.term-link"):
        note = page.find(id=button["popovertarget"])
        file, _, anchor = note.a.extract()["href"].partition("#")
        assert file == "glossary.html"
        assert entries.find(id=anchor).name == "dt"
        found.append((button.get_text().split(), note.get_text().strip()))
    assert found == [
        (["Overshoots"], SENTENCE),
        (["degree", "of", "freedom"], "One axis of motion."),
    ]
    assert entries.select_one(".term-note a")["href"] == "#term-DOF"


@pytest.mark.browser
def test_touch_and_keyboard_show_and_hide_a_definition(small_site):
    with launched() as browser:
        page = browser.new_page(viewport={"width": 390, "height": 700}, has_touch=True)
        page.goto((small_site / "terms.html").as_uri())
        note, word = page.get_by_text(SENTENCE), page.get_by_text("Overshoots")
        word.tap()
        expect(note).to_be_visible()
        box, above = note.bounding_box(), word.bounding_box()
        assert 0 <= box["x"] <= 390 - box["width"]
        assert 0 <= box["y"] - above["y"] - above["height"] < 20
        assert violations(page, "article") == []
        page.touchscreen.tap(200, 600)
        expect(note).to_be_hidden()
        page.get_by_role("button", name="Overshoots").press("Enter")
        expect(note).to_be_visible()
        page.keyboard.press("Escape")
        expect(note).to_be_hidden()
