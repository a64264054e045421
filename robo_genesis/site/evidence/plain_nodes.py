"""Nodes from text of a bundle, which no parser of markup may see: it could contain a script."""

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path

from docutils import nodes
from sphinx.environment import BuildEnvironment

MARKED = re.compile(r"\*\*([^*]+)\*\*|`([^`]+)`")
KINDS = (nodes.Text, partial(nodes.strong, ""), partial(nodes.literal, ""))


def marked(text: str) -> list[nodes.Node]:
    """Return text with `**strong**` parts and code in backticks; nothing else is markup."""
    parts = zip(cycle(KINDS), MARKED.split(text))  # plain, strong, code, plain, …
    return [make(part) for make, part in parts if part]


def image(env: BuildEnvironment, name: str, content: bytes, alt: str) -> nodes.image:
    """Return a picture; its file is written outside the site until Sphinx copies it.

    Args:
        env: of the build.
        name: of the file, unique on the site.
        content: of the file.
        alt: its alternative text.
    """
    file = Path(env.app.outdir).parent / "panel" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content)
    return nodes.image(uri=f"/{os.path.relpath(file, env.srcdir)}", alt=alt)


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[nodes.Node | Sequence[nodes.Node]]],
    anchors: Sequence[str] = (),
) -> nodes.table:
    """Return a table; `head` may be empty, `anchors` names the rows.

    A cell is one node, or several that become paragraphs.
    """
    width = len(rows[0])
    group = nodes.tgroup("", *(nodes.colspec(colwidth=1) for _ in range(width)), cols=width)
    if head:
        group += nodes.thead("", _row(map(nodes.Text, head)))
    body = nodes.tbody("", *(_row(line) for line in rows))
    for row, anchor in zip(body, anchors, strict=False):
        row["ids"].append(anchor)
    group += body
    return nodes.table("", group)


def text_table(rows: Sequence[Mapping[str, str | Sequence[nodes.Node]]]) -> nodes.table:
    """Return rows of equal keys as a table, each text as it is; columns are as wide as needed."""
    cells = [
        [nodes.Text(cell) if isinstance(cell, str) else cell for cell in row.values()]
        for row in rows
    ]
    found = table(list(rows[0]), cells)
    found["classes"].append("colwidths-auto")
    return found


def _row(cells: Iterable[nodes.Node | Sequence[nodes.Node]]) -> nodes.row:
    parts = ([cell] if isinstance(cell, nodes.Node) else cell for cell in cells)
    return nodes.row(
        "", *(nodes.entry("", *(nodes.paragraph("", "", n) for n in cell)) for cell in parts)
    )
