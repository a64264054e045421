"""Finds what cells and runs show on a page, and writes its origin below it.

A picture or table is measured if `page.show` displayed it, or if it was read from a
bundle. Other outputs of cells are printed, also texts: the build compares them with the
bundle, but does not compute them again. The outputs of a cell that is tagged `inputs`
were chosen. A picture that no run made is an illustration. A table typed in prose is
not listed.
"""

import re
import textwrap
from collections.abc import Sequence, Set
from dataclasses import replace
from itertools import chain, count
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.core.files import bytes_digest
from robo_genesis.core.markup import filled
from robo_genesis.site.frame.executed import RECOMPUTED

from . import ledger_data
from .ledger_data import LEDGER, MEASURED, PRINTED, Item
from .origin import INPUTS, above, origin
from .plain_nodes import html
from .runs import all_runs, measured_pages

LINE = Path(__file__).with_suffix(".html")  # The template of the line
LOG = "the engine's log"
TITLE = 80  # Longest title in the ledger, in characters
ITEMS = "robo_genesis_items"  # The name of a page's items in its metadata

UNBOUND = (
    "a cell shows an output, but the page declares no bundle. Give its front matter "
    f"`robo_genesis: {{lesson, page}}`, or tag a cell of chosen values `{INPUTS}`."
)

logger = logging.getLogger(__name__)

# The kind of an item that belongs to no run, by the keys of its origin.
WITHOUT_RUN: dict[tuple[str, ...] | None, str] = {None: "illustration", (): "settings"}


def read_page(app: Sphinx, doctree: nodes.document) -> None:
    """List the outputs and pictures of a page, and write its origin below each of them."""
    env = app.env
    book, items = Path(env.srcdir), []
    known, page = all_runs(book), measured_pages(book).get(env.docname)
    recomputed = RECOMPUTED.get(env.docname, set())
    ledger = ""  # of a small book
    if LEDGER in env.found_docs:
        ledger = app.builder.get_relative_uri(env.docname, LEDGER)
    for node in list(doctree.findall(nodes.Element)):
        texts = printed_texts(node, recomputed)
        last = texts[-1] if texts else node
        keys, cell = origin(last, page)
        is_picture = isinstance(node, nodes.image)
        made = keys is not None and (texts or isinstance(node, nodes.table))
        if not (is_picture or made):
            continue
        if cell is not None and keys and page is None:
            if not texts:
                logger.warning(UNBOUND, location=env.docname)
            continue
        holder = next(above(node, nodes.figure), node) if is_picture else node
        item = describe(holder, node, env, texts)
        printed = cell is not None and cell.get("cell_index") not in recomputed
        kind = WITHOUT_RUN.get(keys, "printed" if printed else item.kind)
        item = replace(item, kind=kind, runs=keys or ())
        items.append(item)
        line = ledger_data.provenance(kind, [known[key] for key in item.runs])
        add_line(last if texts else holder, line, f"{ledger}#{item.row}" * bool(ledger))
    env.metadata[env.docname][ITEMS] = items


def printed_texts(box: nodes.Element, recomputed: Set[int]) -> list[nodes.Element]:
    """Return the texts that a cell printed, an empty list for any other node."""
    if box.get("nb_element") != "cell_code_output":
        return []
    left_out = "mime_bundle" if box.parent.get("cell_index") in recomputed else None
    parts = (part for part in box if part.get("nb_element", "") != left_out)
    others = lambda node: isinstance(node, nodes.table | nodes.image)  # noqa: E731
    return [
        part for part in parts if part.astext().strip() and not [*part.findall(others)]
    ]


def describe(
    holder: nodes.Element, node: nodes.Element, env: Any, texts: Sequence[nodes.Element]
) -> Item:
    """Return the item of a table, picture or texts as of no run, and give `holder` an anchor."""
    section = next(above(holder, nodes.section))
    heading = section.next_node(nodes.title).astext()
    if isinstance(node, nodes.image):
        caption, file = holder.next_node(nodes.caption), node["uri"]
        path, data = Path(env.srcdir, file), None
        anchor = _anchor(holder, f"picture-{section['ids'][0]}")
        kind, content = (
            node.get("kind") or ledger_data.picture_kind(path),
            path.read_bytes(),
        )
        title = node.get("alt", "") if caption is None else caption.astext()
    else:
        if texts:
            kind, suffix = "printed", ".txt"
            title, content = _text(texts)
            holder["classes"].append("printed")
        else:
            kind, suffix = "table", ".csv"
            rows = [[cell.astext() for cell in row] for row in node.findall(nodes.row)]
            title, content = (
                ", ".join(filter(None, rows[0])),
                ledger_data.csv_bytes(rows),
            )
        anchor, data = _anchor(holder, f"{kind}-{section['ids'][0]}"), content
        title = f"{heading}: {title}"
        file = f"{env.docname}-{anchor}{suffix}".replace("/", "-")
    title = re.sub(r"^\d+\. ", "", title).split(". ")[0].removesuffix(".")
    title = textwrap.shorten(title, TITLE, placeholder=" …")
    digest = bytes_digest(content)
    return Item(kind, title, env.docname, anchor, (), digest, file, data)


def _text(texts: Sequence[nodes.Element]) -> tuple[str, bytes]:
    """Return the last line that is not of a log, and the content of printed texts."""
    # Of a result in several forms, the first is Markdown.
    parts = (
        part[0] if part.get("nb_element") == "mime_bundle" else part for part in texts
    )
    text = "\n".join(part.astext() for part in parts)
    lines = (line for line in text.splitlines() if line[:1] not in "[ ")
    return [LOG, *lines][-1], text.encode()


def _anchor(holder: nodes.Element, base: str) -> str:
    """Return an anchor, by default from the section's: other sections do not change it."""
    if not holder["ids"]:
        used = holder.document.ids
        names = chain([base], (f"{base}-{n}" for n in count(2)))
        name = next(name for name in names if name not in used)
        used[name] = holder
        holder["ids"].append(name)
    return holder["ids"][0]


def add_line(holder: nodes.Element, text: str, address: str) -> None:
    """Insert the line of provenance at the end of the caption, or below an item without one.

    What a run measured or printed has an icon, and the words appear under the mouse or
    the focus. Anything else says so in words. `address` is that of its row in the
    ledger, empty without one.
    """
    line = html(filled(LINE, text=text, address=address))
    with_icon = text.startswith((MEASURED, PRINTED))
    classes = ["provenance", "as-icon"] if with_icon else ["provenance"]
    is_figure = isinstance(holder, nodes.figure)
    caption = holder.next_node(nodes.caption) if is_figure else None
    if caption is not None:
        caption += [nodes.Text(" "), nodes.inline("", "", line, classes=classes)]
    else:
        line = nodes.paragraph("", "", line, classes=classes)
        block = next(above(holder, nodes.paragraph), holder)
        block.parent.insert(block.parent.index(block) + 1, line)


def setup(app: Sphinx) -> None:
    """Register the pass over each page that was read."""
    app.connect(
        "doctree-read", read_page, priority=900
    )  # pictures are collected before
