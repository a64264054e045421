"""What the theme's markup lacks for readers with a keyboard, a screen reader or large text.

Each function mends one thing on a parsed page, in place. `tests/site/test_accessible.py` looks at
the result with axe-core.
"""

from bs4 import BeautifulSoup, Tag

ICONS = "i[class*='fa-'], span.fa-solid"


def mend(page: BeautifulSoup) -> None:
    """Mend one page of the site.

    Args:
        page: the complete page as the theme wrote it.
    """
    hide_icons(page)
    name_by_visible_text(page)
    name_menu_folds(page)
    mark_the_sidebar(page)


def hide_icons(page: BeautifulSoup) -> None:
    """Keep icons from screen readers: the control around one has its name as text or label."""
    for icon in page.select(ICONS):
        icon["aria-hidden"] = "true"


def name_by_visible_text(page: BeautifulSoup) -> None:
    """Drop labels that replace what the element shows, so that speech input finds it by its words.

    These are the search field's button, and the folds around code and outputs.
    """
    for element in page.select("button.search-button-field, details.hide > summary"):
        del element["aria-label"]


def name_menu_folds(page: BeautifulSoup) -> None:
    """Name each fold of the course menu, which shows an arrow only, after the page beside it."""
    for summary in page.select("nav.bd-docs-nav details > summary"):
        beside = summary.parent.find_previous_sibling("a") if summary.parent else None
        if isinstance(beside, Tag):
            summary["aria-label"] = f"Pages below {beside.get_text(' ', strip=True)}"


def mark_the_sidebar(page: BeautifulSoup) -> None:
    """Make the sidebar a landmark: the course's name and the search stand outside of its menu."""
    for sidebar in page.select("#pst-primary-sidebar"):
        sidebar["role"] = "complementary"
        sidebar["aria-label"] = "Course"
