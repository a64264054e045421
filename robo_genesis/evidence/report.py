"""The report of a comparison: a summary, a Markdown page and an HTML page that fetches nothing."""

from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path

from robo_genesis.core import tables
from robo_genesis.core.files import write_whole
from robo_genesis.core.refusals import printable
from robo_genesis.evidence.bundle import Predicate
from robo_genesis.evidence.compare import BundleComparison
from robo_genesis.evidence.findings import (
    DIFFERS,
    EQUAL,
    INCONCLUSIVE,
    SEVERITY,
    Finding,
)

COLUMNS = ("result", "what", "old", "new", "Δ", "allowed")
Row = tuple[str, ...]

STYLE = """
:root { color-scheme: light dark; --line: #c9ced6; --soft: #f3f4f5; --text: #222832; --page: #fff;
  --bad: #a3122a; --unsure: #7a4b00; --good: #1b6b3a; }
@media (prefers-color-scheme: dark) { :root { --line: #48566b; --soft: #222832; --text: #ced6dd;
  --page: #14181e; --bad: #ff8f9e; --unsure: #f0b75e; --good: #6fd39a; } }
body { background: var(--page); color: var(--text); line-height: 1.6; margin: 0 auto;
  max-width: 60rem; padding: 1rem 1rem 3rem; overflow-wrap: anywhere;
  font-family: -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h2 { border-bottom: 1px solid var(--line); margin-top: 2rem; }
.box { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { border-bottom: 1px solid var(--line); padding: .3rem .8rem .3rem 0; text-align: left;
  vertical-align: top; }
.differs, .not-comparable { color: var(--bad); font-weight: 600; }
.inconclusive { color: var(--unsure); font-weight: 600; }
.equal, .within-tolerance { color: var(--good); }
.verdict { background: var(--soft); border-left: .3rem solid; padding: .5rem 1rem; }
"""


def title(comparison: BundleComparison) -> str:
    """Return the heading of a report."""
    lesson, page = comparison.new.lesson, comparison.new.page
    return f"{lesson.upper()} {page}: {comparison.axis}"


def verdict(comparison: BundleComparison) -> str:
    """Return the result in one sentence, and the number of rows in each state."""
    if comparison.obstacles:
        return "Not comparable."
    rows = Counter(f.state for s in comparison.sections for f in s.findings)
    counts = ", ".join(f"{rows[state]} {state}" for state in reversed(SEVERITY) if state in rows)
    return f"{comparison.state.capitalize()}. Rows: {counts}."


def summary(comparison: BundleComparison) -> str:
    """Return the report in a few lines: verdict, obstacles or sections, notes.

    Text of the bundles cannot control a terminal or begin a line of its own.
    """
    lines = [title(comparison), verdict(comparison), *comparison.obstacles]
    for part in comparison.sections:
        state = part.state if part.findings else part.empty
        lines.append(f"  {part.title.lower()}: {state}")
        worst = [f for f in part.findings if f.state in (DIFFERS, INCONCLUSIVE)]
        lines += [f"    {_words(f)}" for f in worst]
    return "\n".join(map(printable, [*lines, *comparison.notes]))


def _words(row: Finding) -> str:
    """Return a row as one line: what, both values, and the difference beside its limit."""
    limit = f", allowed {row.allowed}" if row.allowed else ""
    more = f" (difference {row.delta}{limit})" if row.delta else limit
    return f"{row.what}: {row.old} → {row.new}{more}"


def markdown(comparison: BundleComparison) -> str:
    """Return the report as a Markdown page."""
    parts = [f"# {plain(title(comparison))}", f"**{verdict(comparison)}**"]
    parts += ["\n".join(f"- {plain(line)}" for line in comparison.remarks)]
    for part in comparison.sections:
        state = f": {part.state}" if part.findings else ""
        parts.append(f"## {part.title}{state}")
        parts.append(markdown_table(_table(part.findings), part.empty))
    parts += ["## The two bundles", markdown_table(_origin(comparison))]
    return "\n\n".join(part.strip() for part in parts if part) + "\n"


def html(comparison: BundleComparison) -> str:
    """Return the report as one HTML page without scripts, fonts or pictures from elsewhere."""
    body = [f"<h1>{escape(title(comparison))}</h1>"]
    state = _css(comparison.state)
    body.append(f'<p class="verdict {state}">{escape(verdict(comparison))}</p>')
    body += html_list(comparison.remarks)
    for part in comparison.sections:
        mark = f': <span class="{_css(part.state)}">{part.state}</span>' if part.findings else ""
        body.append(f"<h2>{part.title}{mark}</h2>")
        body.append(html_table(part.title, _table(part.findings), part.empty))
    body += ["<h2>The two bundles</h2>", html_table("The two bundles", _origin(comparison))]
    return html_page(title(comparison), body)


def changes(comparison: BundleComparison) -> list[Row]:
    """Return head and rows of all sections that are not equal, the worst rows first."""
    found = [f for part in comparison.sections for f in part.findings if f.state != EQUAL]
    return _table(sorted(found, key=lambda f: -SEVERITY.index(f.state)))


def html_list(lines: Sequence[str]) -> list[str]:
    """Return lines as an HTML list, nothing for no line."""
    items = "".join(f"<li>{_escaped(line)}</li>\n" for line in lines)
    return [f"<ul>\n{items}</ul>"] if items else []


def html_page(name: str, body: list[str]) -> str:
    """Return a whole page in the style of the reports."""
    head = (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(name)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>\n"
    )
    return head + "\n".join(body) + "\n</main>\n</body>\n</html>\n"


def write(folder: Path, markdown_text: str, html_text: str) -> list[Path]:
    """Write both pages of a report and return their paths."""
    pages = {"report.md": markdown_text, "report.html": html_text}
    for name, text in pages.items():
        write_whole(folder / name, text.encode())
    return [folder / name for name in pages]


def _table(findings: Sequence[Finding]) -> list[Row]:
    """Return a head and a row for each finding, without empty columns."""
    rows = [(f.state, f.what, f.old, f.new, f.delta, f.allowed) for f in findings]
    kept = [k for k in range(len(COLUMNS)) if any(row[k] for row in rows)]
    return [tuple(row[k] for k in kept) for row in [COLUMNS, *rows]]


def _origin(comparison: BundleComparison) -> list[Row]:
    old, new = _facts(comparison.old), _facts(comparison.new)
    rows = [("folder", *comparison.folders), *((what, old[what], new[what]) for what in old)]
    return [("", "old", "new"), *rows]


def _facts(predicate: Predicate) -> dict[str, str]:
    engine, backend, git = predicate.engine, predicate.backend, predicate.git
    dirty = " with changes" if git and git.dirty else ""
    return {
        "engine": f"{engine.version}, quadrants {engine.quadrants_version}",
        "precision": engine.precision,
        "backend": f"{backend.actual} (requested: {backend.requested})",
        "device": backend.device_name,
        "torch": backend.torch_version,
        "host": f"{predicate.host.os}, {predicate.host.cpu}",
        "measured": predicate.started,
        "run": predicate.run_id,
        "commit": f"{git.commit}{dirty}" if git else "unknown",
    }


def markdown_table(rows: list[Row], empty: str = "") -> str:
    """Return rows of text as a Markdown table; the first row is the head.

    Args:
        rows: of equal length.
        empty: the text in the place of a table that has only a head.
    """
    if len(rows) == 1:
        return empty
    head = [plain(cell) for cell in rows[0]]
    return tables.markdown(
        [dict(zip(head, map(plain, row), strict=True)) for row in rows[1:]]
    ).strip()


def html_table(label: str, rows: list[Row], empty: str = "") -> str:
    """Return rows of text as a table in a scroll box; see `markdown_table`."""
    if len(rows) == 1:
        return f"<p>{empty}</p>"
    head = "".join(f'<th scope="col">{escape(cell)}</th>' for cell in rows[0])
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>\n" for row in rows[1:])
    return (
        f'<div class="box" role="region" aria-label="{escape(label)}" tabindex="0">\n'
        f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n</div>"
    )


def _cell(text: str) -> str:
    if text in SEVERITY:
        return f'<td class="{_css(text)}">{text}</td>'
    return f"<td>{_escaped(text)}</td>"


def _escaped(text: str) -> str:
    """Return text as HTML of one line, without characters that change how others are shown."""
    return escape(printable(" ".join(text.split())))


def _css(state: str) -> str:
    return state.replace(" ", "-")


def plain(text: str) -> str:
    """Return text with the characters escaped that have a meaning in Markdown."""
    one_line = printable(" ".join(text.split()))
    return "".join(f"\\{c}" if c in "\\`*_|[]<>#" else c for c in one_line)
