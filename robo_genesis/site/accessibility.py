"""Attributes that the theme's markup lacks for a keyboard, a screen reader or speech input.

`tests/site/test_accessible.py` checks the result with axe-core.
"""

import re

from bs4 import BeautifulSoup, Tag

ICON = re.compile("^fa-")
"""How the classes of an icon's element begin."""
NAMED_BY_TEXT = "button.search-button-field, details.hide > summary"
"""The button of the search field, and the folds around code and outputs."""


def make_accessible(page: BeautifulSoup) -> None:
    """Correct the attributes of a complete page, in place."""
    # The control around an icon has its name as text or label.
    for icon in [*page.find_all("i", class_=ICON), *page.find_all("span", class_="fa-solid")]:
        icon["aria-hidden"] = "true"
    # A fold of code shows an icon; its text is for screen readers and, as a title, for the mouse.
    for fold in page.select("details.hide.above-input > summary"):
        fold["title"] = "Show or hide source"
    # HTML allows no paragraph in a summary. A style sheet has other rules for spans there.
    for text in page.select("summary > p"):
        text.name = "b"
    # The link beside a heading or caption is for the mouse: it repeats the contents list.
    for anchor in page.select("a.headerlink"):
        anchor["tabindex"] = "-1"
    # A label would replace the visible text, by which speech input finds a control.
    for element in page.select(NAMED_BY_TEXT):
        del element["aria-label"]
    # A fold of the course menu shows only an arrow; the name of its page comes before it.
    for summary in page.select("nav.bd-docs-nav details > summary"):
        link = summary.parent.find_previous_sibling("a") if summary.parent else None
        if isinstance(link, Tag):
            summary["aria-label"] = f"Pages below {link.get_text(' ', strip=True)}"
    # The course's name and the search are outside the menu, so the whole sidebar is a landmark.
    for sidebar in page.select("#pst-primary-sidebar"):
        sidebar["role"], sidebar["aria-label"] = "complementary", "Course"
