"""The report of a comparison of two bundles: a summary, and a document with all rows."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import astuple

from robo_genesis.core.text import printable
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.compare import BundleComparison
from robo_genesis.evidence.document import Cells, Document, Part
from robo_genesis.evidence.rows import DIFFERS, EQUAL, INCONCLUSIVE, SEVERITY, Row

COLUMNS = ("result", "what", "old", "new", "Δ", "allowed")


def title(comparison: BundleComparison) -> str:
    """Return the heading of a report."""
    lesson, page = comparison.new.lesson, comparison.new.page
    return f"{lesson.upper()} {page}: {comparison.axis}"


def verdict(comparison: BundleComparison) -> str:
    """Return the result in one sentence, and the number of rows in each state."""
    if comparison.obstacles:
        return "Not comparable."
    rows = Counter(f.state for s in comparison.sections for f in s.rows)
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
        state = part.state if part.rows else part.empty
        lines.append(f"  {part.title.lower()}: {state}")
        worst = [f for f in part.rows if f.state in (DIFFERS, INCONCLUSIVE)]
        lines += [f"    {words(f)}" for f in worst]
    return "\n".join(map(printable, [*lines, *comparison.notes]))


def words(row: Row) -> str:
    """Return a row as one line: what, both values, and the difference beside its limit."""
    limit = f", allowed {row.allowed}" if row.allowed else ""
    more = f" (difference {row.delta}{limit})" if row.delta else limit
    return f"{row.what}: {row.old} → {row.new}{more}"


def document(comparison: BundleComparison) -> Document:
    """Return the whole report."""
    parts = [
        Part(
            part.title,
            _table(part.rows),
            part.empty,
            state=part.state if part.rows else "",
        )
        for part in comparison.sections
    ]
    parts.append(Part("The two bundles", _origin(comparison)))
    return Document(title(comparison), verdict(comparison), parts, comparison.remarks)


def changes(comparison: BundleComparison) -> list[Cells]:
    """Return head and rows of all sections that are not equal, the worst rows first."""
    found = [f for part in comparison.sections for f in part.rows if f.state != EQUAL]
    return _table(sorted(found, key=lambda f: -SEVERITY.index(f.state)))


def _table(rows: Sequence[Row]) -> list[Cells]:
    """Return a head and each row, without empty columns."""
    cells = [astuple(row)[: len(COLUMNS)] for row in rows]
    kept = [k for k in range(len(COLUMNS)) if any(row[k] for row in cells)]
    return [tuple(row[k] for k in kept) for row in [COLUMNS, *cells]]


def _origin(comparison: BundleComparison) -> list[Cells]:
    old, new = _facts(comparison.old), _facts(comparison.new)
    rows = [
        ("folder", *comparison.folders),
        *((what, old[what], new[what]) for what in old),
    ]
    return [("", "old", "new"), *rows]


def _facts(manifest: Manifest) -> dict[str, str]:
    engine, backend, git = manifest.engine, manifest.backend, manifest.git
    dirty = " with changes" if git and git.dirty else ""
    return {
        "engine": f"{engine.version}, quadrants {engine.quadrants_version}",
        "precision": engine.precision,
        "backend": f"{backend.actual} (requested: {backend.requested})",
        "device": backend.device_name,
        "torch": backend.torch_version,
        "host": f"{manifest.host.os}, {manifest.host.cpu}",
        "measured": manifest.started,
        "run": manifest.run_id,
        "commit": f"{git.commit}{dirty}" if git else "unknown",
    }
