"""Prepares tables that are wider than a phone: there, each row becomes a block of named values.

The style sheet stacks the cells of such a table on a narrow screen and shows each column's head
beside its value. A table that fits, or that has too many rows to be read as blocks, stays a table.
"""

from bs4 import BeautifulSoup, Tag

PHONE = 358
"""Width of a page's column on a phone that is 390 pixels wide [CSS px]."""
LETTER, PADDING = 9, 22.4
"""Width of a wide letter, and of a cell's padding on both sides [CSS px]."""
MOST_ROWS = 40
"""Longer tables are lists of samples, and scroll."""

ROLES = {"thead": "rowgroup", "tbody": "rowgroup", "tr": "row", "th": "columnheader", "td": "cell"}
"""What the parts of a table are to a screen reader, however a style sheet shows them."""


def stack_tables(page: BeautifulSoup) -> None:
    """Mark the wide tables of an article in place, and give each cell the head of its column."""
    for table in page.find_all("table"):
        if table.thead is None or not table.find_parent("article"):
            continue
        columns = table.thead.find_all("th")
        heads = [head.get_text(" ", strip=True) for head in columns]
        lines = (line for body in table.find_all("tbody") for line in body.find_all("tr"))
        rows = [line.find_all(["td", "th"]) for line in lines]
        even = all(len(row) == len(heads) for row in rows)
        if table.find_parent(class_="scroll-box") or not even or not 0 < len(rows) <= MOST_ROWS:
            continue
        whole = table.thead.find(class_="case-mark") is not None
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
