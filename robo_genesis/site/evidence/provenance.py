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
from typing import Any, TypeAlias

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.site.evidence import ledger_data
from robo_genesis.site.evidence.ledger_data import (
    LEDGER,
    MEASURED,
    PRINTED,
    Item,
)
from robo_genesis.site.evidence.origin import INPUTS, NO_BUNDLE, above, cell_of, origin
from robo_genesis.site.evidence.runs import all_runs, measured_pages
from robo_genesis.site.frame.executed import RECOMPUTED

LOG = "the engine's log"
TITLE = 80  # Longest title in the ledger, in characters
ITEMS = "robo_genesis_items"  # The name of a page's items in its metadata

# The origin of an item; see `origin`.
Keys: TypeAlias = tuple[str, ...] | None

# The kind of an item that belongs to no run, by its origin.
WITHOUT_RUN: dict[Keys, str] = {
    None: "illustration",
    (): "settings",
    NO_BUNDLE: "unbound",
}

UNBOUND = (
    "a cell shows a {}, but the page declares no bundle. Give its front matter "
    "`robo_genesis: {{lesson, page}}`, or tag a cell of chosen values "
    f"`{INPUTS}`."
)

logger = logging.getLogger(__name__)


def read_page(app: Sphinx, doctree: nodes.document) -> None:
    """List the outputs and pictures of a page, and write its origin below each of them."""
    env = app.env
    book, items = Path(env.srcdir), []
    known, page = all_runs(book), measured_pages(book).get(env.docname)
    recomputed = RECOMPUTED.get(env.docname, set())
    ledger = (
        app.builder.get_relative_uri(env.docname, LEDGER)
        if LEDGER in env.found_docs
        else None
    )
    for node in list(doctree.findall(nodes.Element)):
        texts = printed_texts(node, recomputed)
        is_table, is_picture = (
            isinstance(node, nodes.table),
            isinstance(node, nodes.image),
        )
        last = texts[-1] if texts else node
        cell, keys = cell_of(last), origin(last, page)
        if not (texts or is_picture or (is_table and keys is not None)):
            continue
        if not texts and keys == NO_BUNDLE:
            logger.warning(
                UNBOUND.format("table" if is_table else "picture"), location=env.docname
            )
            continue
        holder = next(above(node, nodes.figure), node) if is_picture else node
        item = describe(holder, node, env, keys, texts)
        if item.runs and cell is not None and cell.get("cell_index") not in recomputed:
            item = replace(item, kind="printed")
        items.append(item)
        line = ledger_data.provenance(item.kind, [known[key] for key in item.runs])
        address = None if ledger is None else f"{ledger}#{item.row}"
        add_line(last if texts else holder, line, address)
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
    holder: nodes.Element,
    node: nodes.Element,
    env: Any,
    keys: Keys,
    texts: Sequence[nodes.Element],
) -> Item:
    """Return the ledger's item of a table, picture or texts, and give `holder` an anchor."""
    docname, is_picture = env.docname, isinstance(node, nodes.image)
    section = next(above(holder, nodes.section), None)
    heading = (
        section.next_node(nodes.title).astext() if section is not None else docname
    )
    if not holder["ids"]:
        _name(
            holder,
            "printed" if texts else "picture" if is_picture else "table",
            section,
        )
    anchor = holder["ids"][0]
    file = f"{docname}-{anchor}".replace("/", "-")
    if texts:  # of a result in several forms, the first is Markdown
        bundles = (
            part[0] if part.get("nb_element") == "mime_bundle" else part
            for part in texts
        )
        text = "\n".join(part.astext() for part in bundles)
        kind, data, file = "printed", text.encode(), f"{file}.txt"
        lines = (
            line for line in text.splitlines() if line[:1] not in "[ "
        )  # not of a log
        title = f"{heading}: {[LOG, *lines][-1]}"
        holder["classes"].append("printed")
    elif is_picture:
        caption, path = holder.next_node(nodes.caption), Path(env.srcdir, node["uri"])
        title = (
            caption.astext() if caption is not None else str(node.get("alt", anchor))
        )
        kind = node.get("kind") or ledger_data.picture_kind(path)
        data, file = path.read_bytes(), node["uri"]
    else:
        rows = [
            [e.astext() for e in row.findall(nodes.entry)]
            for row in node.findall(nodes.row)
        ]
        kind, data, file = "table", ledger_data.csv_bytes(rows), f"{file}.csv"
        title = f"{heading}: {', '.join(filter(None, rows[0]))}"
    kind, runs = WITHOUT_RUN.get(keys, kind), () if keys in WITHOUT_RUN else keys or ()
    digest, kept = ledger_data.sha256(data), None if is_picture else data
    title = re.sub(r"^\d+\. ", "", title).split(". ")[0].removesuffix(".")
    title = textwrap.shorten(title, TITLE, placeholder=" …")
    return Item(kind, title, docname, anchor, runs, digest, file, kept)


def _name(holder: nodes.Element, word: str, section: nodes.Element | None) -> None:
    """Derive an anchor from the section's: it stays the same when other sections change."""
    base = f"{word}-{section['ids'][0]}" if section is not None else word
    names, used = (
        chain([base], (f"{base}-{number}" for number in count(2))),
        holder.document.ids,
    )
    name = next(name for name in names if name not in used)
    used[name] = holder
    holder["ids"].append(name)


def add_line(holder: nodes.Element, text: str, address: str | None) -> None:
    """Insert the line of provenance at the end of the caption, or below an item without one.

    What a run measured or printed has an icon, and the words appear under the mouse or
    the focus. Anything else says so in words. `address` is that of its row in the
    ledger.
    """
    caption = (
        holder.next_node(nodes.caption) if isinstance(holder, nodes.figure) else None
    )
    parts = [nodes.inline("", text, classes=["provenance-text"])]
    if address is not None:
        joint = nodes.inline(
            "", " · " if text[-1] != "." else " ", classes=["provenance-joint"]
        )
        parts += [joint, nodes.reference("", "ledger", internal=True, refuri=address)]
    classes = [
        "provenance",
        *(["as-icon"] if text.startswith((MEASURED, PRINTED)) else []),
    ]
    if caption is not None:
        caption += [nodes.Text(" "), nodes.inline("", "", *parts, classes=classes)]
    else:
        line = nodes.paragraph("", "", *parts, classes=classes)
        block = next(above(holder, nodes.paragraph), holder)
        block.parent.insert(block.parent.index(block) + 1, line)


def setup(app: Sphinx) -> None:
    """Register the pass over each page that was read."""
    app.connect(
        "doctree-read", read_page, priority=900
    )  # pictures are collected before
