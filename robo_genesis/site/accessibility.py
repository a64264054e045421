"""Attributes that the theme's markup lacks for a keyboard, a screen reader or speech input.

`tests/site/test_accessible.py` checks the result with axe-core.
"""

import re

from bs4 import BeautifulSoup, Tag

ICON = re.compile("^fa-")
"""How the classes of an icon's element begin."""


def make_accessible(page: BeautifulSoup) -> None:
    """Correct the attributes of a complete page, in place."""
    # The control around an icon has its name as text or label.
    for icon in [*page.find_all("i", class_=ICON), *page.find_all("span", class_="fa-solid")]:
        icon["aria-hidden"] = "true"
    for summary in page.find_all("summary"):
        fold = summary.find_parent("details")
        kinds = fold.get_attribute_list("class") if fold else []
        # A label would replace the visible text, by which speech input finds a control.
        if "hide" in kinds:
            del summary["aria-label"]
        # A fold of code shows an icon; its text is for screen readers and, as a title, the mouse.
        if "above-input" in kinds:
            summary["title"] = "Show or hide source"
        # HTML allows no paragraph in a summary. A style sheet has other rules for spans there.
        for text in summary.find_all("p", recursive=False):
            text.name = "b"
        # A fold of the course menu shows only an arrow; the name of its page comes before it.
        link = fold.find_previous_sibling("a") if fold else None
        if isinstance(link, Tag) and summary.find_parent("nav", class_="bd-docs-nav"):
            summary["aria-label"] = f"Pages below {link.get_text(' ', strip=True)}"
    for button in page.find_all("button", class_="search-button-field"):
        del button["aria-label"]  # it shows its name
    # The link beside a heading or caption is for the mouse: it repeats the contents list.
    for anchor in page.find_all("a", class_="headerlink"):
        anchor["tabindex"] = "-1"
    # The course's name and the search are outside the menu, so the whole sidebar is a landmark.
    for sidebar in page.find_all(id="pst-primary-sidebar"):
        sidebar["role"], sidebar["aria-label"] = "complementary", "Course"
