"""The report of a comparison of two bundles: a summary, and a document with all rows."""

import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path

from robo_genesis.core.comparison import differences
from robo_genesis.core.document import Cells, Document, Part
from robo_genesis.core.text import printable

from .compare import BundleComparison, compare
from .refusals import BundleRefused
from .rows import (
    DIFFERS,
    EQUAL,
    INCONCLUSIVE,
    NOT_COMPARABLE,
    SEVERITY,
    WITHIN,
    Row,
)

COLUMNS = ("result", "what", "old", "new", "Δ", "allowed")


# What a comparison means, by its state.
CONCLUSIONS = {
    EQUAL: "The runs agree within the tolerances of the lesson.",
    WITHIN: "The runs agree within the tolerances of the lesson.",
    INCONCLUSIVE: "Whether the runs agree is undecided: see the inconclusive lines above.",
    DIFFERS: "The runs differ: an arrow leads from the old value to the new one.",
    NOT_COMPARABLE: "The runs cannot be compared, for the reasons above.",
}

# Exit statuses; 1 for a difference, and for an undecided comparison.
STATUS = {EQUAL: 0, WITHIN: 0, NOT_COMPARABLE: 2}

SAME_QUESTION = (
    "Engine, backend, settings and code are equal. Another processor can change the last "
    "digits; a larger difference comes from a changed cell of the notebook. The check "
    "`functions` fails if the test of a function did not pass."
)


def print_comparison(old: Path, new: Path, folder: Path | None = None) -> int:
    """Compare two bundles, or archives of bundles, and print the result.

    Args:
        old: for a student, the site's run.
        new: for a student, the own run.
        folder: gets the whole report, None for none.

    Returns:
        0 they agree, 1 they differ or it is undecided, 2 they cannot be compared.
    """
    try:
        comparison = compare(old, new)
    except BundleRefused as refusal:
        print(f"Not compared: {refusal}", file=sys.stderr)
        return 2
    print(summary(comparison), CONCLUSIONS[comparison.state], sep="\n")
    if comparison.state == DIFFERS and comparison.axis == "repeat":
        print(SAME_QUESTION)
    if folder:
        print(f"Report: {document(comparison).write(folder)}")
    return STATUS.get(comparison.state, 1)


def title(comparison: BundleComparison) -> str:
    """Return the heading of a report."""
    lesson, page = comparison.new.lesson, comparison.new.page
    return f"{lesson.upper()} {page}: {comparison.axis}"


def verdict(comparison: BundleComparison) -> str:
    """Return the result in one sentence, and the number of rows in each state."""
    if comparison.obstacles:
        return "Not comparable."
    rows = Counter(row.state for part in comparison.sections for row in part.rows)
    counts = ", ".join(
        f"{rows[state]} {state}" for state in reversed(SEVERITY) if state in rows
    )
    return f"{comparison.state.capitalize()}. Rows: {counts}."


def summary(comparison: BundleComparison) -> str:
    """Return the report in a few lines: verdict, obstacles or sections, notes.

    Text of the bundles cannot control a terminal or begin a line of its own.
    """
    lines = [title(comparison), verdict(comparison), *comparison.obstacles]
    for part in comparison.sections:
        state = part.state if part.rows else "none"
        lines.append(f"  {part.title.lower()}: {state}")
        worst = [row for row in part.rows if row.state in (DIFFERS, INCONCLUSIVE)]
        lines += [f"    {words(row)}" for row in worst]
    return "\n".join(map(printable, [*lines, *comparison.notes]))


def words(row: Row) -> str:
    """Return a row as one line: what, both values, and the difference beside its limit."""
    limit = f", allowed {row.allowed}" if row.allowed else ""
    more = f" (difference {row.delta}{limit})" if row.delta else limit
    return f"{row.what}: {row.old} → {row.new}{more}"


def document(comparison: BundleComparison) -> Document:
    """Return the whole report."""
    parts = [
        Part(part.title, _table(part.rows), state=part.state if part.rows else "")
        for part in comparison.sections
    ]
    parts.append(Part("The two bundles", _circumstances(comparison)))
    return Document(title(comparison), verdict(comparison), parts, comparison.remarks)


def changes(comparison: BundleComparison) -> list[Cells]:
    """Return head and rows of all sections that are not equal, the worst rows first."""
    rows = [row for part in comparison.sections for row in part.rows]
    unequal = [row for row in rows if row.state != EQUAL]
    return _table(sorted(unequal, key=lambda row: -SEVERITY.index(row.state)))


def _table(rows: Sequence[Row]) -> list[Cells]:
    """Return a head and each row."""
    return [COLUMNS, *(astuple(row)[: len(COLUMNS)] for row in rows)]


def _circumstances(comparison: BundleComparison) -> list[Cells]:
    """Return head and rows of what differs between the manifests."""
    old, new = (
        manifest.model_dump(exclude={"files", "checks", "warnings"})
        for manifest in (comparison.old, comparison.new)
    )
    rows = [(what, str(was), str(now)) for what, was, now in differences(old, new)]
    return [("", "old", "new"), ("folder", *comparison.folders), *rows]
