"""Corrects markup for a keyboard, a screen reader, speech input and a narrow screen.

`tests/site/sweep.py` checks the result with axe-core. In a table that is wider than a
phone, each row becomes a block of named values there: the style sheet stacks its cells
and shows each column's head beside its value. A table that fits, or that has too many
rows to be read as blocks, stays a table.
"""

from bs4 import BeautifulSoup, Tag

PHONE = 358  # Width of a page's column on a phone that is 390 pixels wide [CSS px]
# Width of a wide letter, and of a cell's padding on both sides [CSS px]
LETTER, PADDING = 9, 22.4
MOST_ROWS = 40  # Longer tables are lists of samples, and scroll

# What the parts of a table are to a screen reader, however a style sheet shows them.
ROLES = {
    "thead": "rowgroup",
    "tbody": "rowgroup",
    "tr": "row",
    "th": "columnheader",
    "td": "cell",
}


def make_accessible(page: BeautifulSoup) -> None:
    """Correct the attributes of a complete page, in place."""
    # The control around an icon has its name as text or label.
    for icon in page.select('i[class*="fa-"], span.fa-solid'):
        icon["aria-hidden"] = "true"
    for summary in page.find_all("summary"):
        fold = summary.find_parent("details")
        kinds = fold.get_attribute_list("class") if fold else []
        # A label would replace the visible text, by which speech input finds a control.
        if "hide" in kinds:
            del summary["aria-label"]
        # A fold of code shows an icon; its text is for screen readers and, as a title,
        # the mouse.
        if "above-input" in kinds:
            summary["title"] = "Show or hide source"
        # HTML allows no paragraph in a summary. A style sheet has other rules for spans
        # there.
        for text in summary.find_all("p", recursive=False):
            text.name = "b"
        # A fold of the course menu shows only an arrow; the name of its page comes
        # before it.
        link = fold.find_previous_sibling("a") if fold else None
        if isinstance(link, Tag) and summary.find_parent("nav", class_="bd-docs-nav"):
            summary["aria-label"] = f"Pages below {link.get_text(' ', strip=True)}"
    for button in page.find_all("button", class_="search-button-field"):
        del button["aria-label"]  # it shows its name
    # The link beside a heading or caption is for the mouse: it repeats the contents
    # list.
    for anchor in page.find_all("a", class_="headerlink"):
        anchor["tabindex"] = "-1"
    # The course's name and the search are outside the menu, so the whole sidebar is a
    # landmark.
    for sidebar in page.find_all(id="pst-primary-sidebar"):
        sidebar["role"], sidebar["aria-label"] = "complementary", "Course"


def stack_tables(page: BeautifulSoup) -> None:
    """Mark the wide tables of an article in place, and give each cell the head of its column."""
    for table in page.select("article table:has(thead):not(.scroll-box table)"):
        columns = table.select("thead th")
        heads = [head.get_text(" ", strip=True) for head in columns]
        rows = [row.find_all(["td", "th"]) for row in table.select("tbody tr")]
        if {len(row) for row in rows} != {len(heads)} or len(rows) > MOST_ROWS:
            continue
        whole = table.select_one("thead .case-mark") is not None
        widths = (
            max(narrowest(cell, whole) for cell in column)
            for column in zip(columns, *rows, strict=True)
        )
        if sum(widths) <= PHONE:
            continue
        table["class"] = [*table.get_attribute_list("class", []), "stacks"]
        table["role"] = "table"
        for part in table.find_all(list(ROLES)):
            part["role"] = ROLES[part.name]
        for row in rows:
            for head, cell in zip(heads, row, strict=True):
                cell["data-head"] = head


def narrowest(cell: Tag, whole: bool) -> float:
    """Return the least width of a cell [CSS px].

    Args:
        cell: its longest part that does not break decides.
        whole: no cell of its table breaks, as where the columns are cases.
    """
    text = cell.get_text(" ", strip=True)
    code = [part.get_text() for part in cell.find_all("code")]
    parts = [text] if whole else [*text.split(), *code]
    return PADDING + LETTER * max(map(len, parts), default=0)
