"""Nodes that no parser of markup makes; text of a bundle could contain a script."""

import os
import re
from collections.abc import Iterable, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any, TypeAlias

from docutils import nodes
from sphinx.environment import BuildEnvironment

MARKED = re.compile(r"\*\*([^*]+)\*\*|`([^`]+)`")
Cell: TypeAlias = str | nodes.Node | Sequence[str | nodes.Node]
KINDS = (nodes.Text, partial(nodes.strong, ""), partial(nodes.literal, ""))


class between(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes in lower case
    """Nodes between two pieces of the site's own HTML, `opening` and `closing`."""


def _write(part: str, self: Any, node: between) -> None:
    self.body.append(node[part])


# What Sphinx calls before and after such nodes.
WRITERS = (partial(_write, "opening"), partial(_write, "closing"))


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


def html(text: str) -> nodes.Node:
    """Return markup of the site's own."""
    return nodes.raw("", text, format="html")


def paragraph(*parts: str | nodes.Node, **attributes: Any) -> nodes.paragraph:
    """Return a paragraph of nodes and texts, each text as it is."""
    texts = (nodes.Text(part) if isinstance(part, str) else part for part in parts)
    return nodes.paragraph("", "", *texts, **attributes)


def bullets(*items: Iterable[str | nodes.Node], **attributes: Any) -> nodes.bullet_list:
    """Return a list; an item consists of nodes and texts."""
    lines = (nodes.list_item("", paragraph(*item)) for item in items)
    return nodes.bullet_list("", *lines, **attributes)


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[Cell]],
    ids: Sequence[str] = (),
    **attributes: Any,
) -> nodes.table:
    """Return a table; `head` may be empty, `ids` are those of the rows.

    A cell is one node or text, or several that become paragraphs.
    """
    width = len(rows[0])
    group = nodes.tgroup(
        "", *(nodes.colspec(colwidth=1) for _ in range(width)), cols=width
    )
    if head:
        group += nodes.thead("", _row(head))
    body = nodes.tbody("", *map(_row, rows))
    for row, name in zip(body, ids, strict=False):
        row["ids"].append(name)
    group += body
    return nodes.table("", group, **attributes)


def _row(cells: Iterable[Cell]) -> nodes.row:
    parts = ([cell] if isinstance(cell, str | nodes.Node) else cell for cell in cells)
    return nodes.row("", *(nodes.entry("", *map(paragraph, cell)) for cell in parts))
