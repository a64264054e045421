"""Finds each figure and measured table of a page, and writes its origin below it.

A picture or table is measured if it is an output of a code cell, shown there or glued elsewhere, or
was read from a bundle. The tables of a cell that is tagged `inputs` were chosen. Outputs of a page
that `page.show` did not display are printed: the build does not compare them with the bundle. A
picture that no run made is an illustration. A table typed in prose is not listed.
"""

import re
import textwrap
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import chain
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.bound import marked
from robo_genesis.pipeline.pages.built import executed_notebook
from robo_genesis.site.evidence import ledger_data, measured, refusals
from robo_genesis.site.evidence import origin as sphinx_origin
from robo_genesis.site.evidence.ledger_data import MEASURED, Item, PageRun
from robo_genesis.site.evidence.origin import INPUTS, above, cell_of, origin

TITLE = 80
"""Longest title in the ledger, in characters."""
ITEMS = "robo_genesis_items"
"""The name of a page's items in its metadata."""

logger = logging.getLogger(__name__)


@lru_cache(maxsize=4)
def measured_pages(book: Path) -> dict[str, str]:
    """Return docname → `lesson/page` of the pages that run the engine."""
    return {p.docname: f"{p.lesson}/{p.page}" for p in find_pages(book) if p.declares_bundle}


@lru_cache(maxsize=4)
def all_runs(book: Path) -> dict[str, PageRun]:
    """Return the runs of this build and the recorded ones by key, missing runs included."""
    runs = [measured.page_run(book, *name.split("/")) for name in measured_pages(book).values()]
    recorded = chain.from_iterable(measured.recorded_runs(book, run.lesson) for run in runs)
    return {run.key: run for run in (*runs, *recorded)}


def read_page(app: Sphinx, doctree: nodes.document) -> None:
    """List the figures and tables of a page, and write its origin below each of them."""
    env = app.env
    book, items = Path(env.srcdir), []
    known, compared = all_runs(book), compared_cells(book, env.docname)
    for node in list(doctree.findall(lambda n: isinstance(n, nodes.table | nodes.image))):
        keys = origin(node, measured_pages(book).get(env.docname))
        is_table = isinstance(node, nodes.table)
        if keys is None and is_table:
            continue
        if problem := _problem(keys, known, is_table):
            logger.warning(problem, location=env.docname)
            continue
        holder = node if is_table else next(above(node, nodes.figure), node)
        item = describe(holder, node, env.docname, keys, book)
        cell = cell_of(node)
        not_compared = cell is not None and cell.get("cell_index") not in (compared or ())
        if compared is not None and not_compared and item.kind != "settings":
            item = replace(item, kind="printed", runs=())
        items.append(item)
        runs = [known[key] for key in item.runs]
        add_line(holder, ledger_data.provenance(item.kind, runs), item.row)
    env.metadata[env.docname][ITEMS] = items


def compared_cells(book: Path, docname: str) -> set[int] | None:
    """Return the places of the cells all of whose outputs the build compared with the bundle.

    Returns:
        None for a page that declares no bundle.
    """
    if docname not in measured_pages(book):
        return None
    page = next(page for page in find_pages(book) if page.docname == docname)
    places = [k for k, cell in enumerate(page.notebook.cells) if cell.cell_type == "code"]
    ran = executed_notebook(docname, page.notebook).cells
    found = {}
    for place, cell in zip(places, ran, strict=True):
        shown = [output for output in cell.outputs if "data" in output]
        found[place] = (len(shown), len(marked(cell)))
    return {place for place, (shown, count) in found.items() if shown == count}


def _problem(
    keys: tuple[str, ...] | None, known: Mapping[str, PageRun], is_table: bool
) -> str | None:
    """Return why an item cannot be listed."""
    if keys == () and not is_table:
        return f"a cell tagged {INPUTS} shows a picture. The tag is for tables: remove it there."
    if not set(keys or ()) <= known.keys():
        what = "table" if is_table else "picture"
        return (
            f"a cell shows a {what}, but the page declares no bundle. Give its front matter "
            f"`robo_genesis: {{lesson, page}}`, or tag a cell of chosen values `{INPUTS}`."
        )
    return None


def describe(
    holder: nodes.Element,
    node: nodes.Element,
    docname: str,
    keys: tuple[str, ...] | None,
    book: Path,
) -> Item:
    """Return the ledger's item of a table or picture, and give `holder` an anchor."""
    is_table = isinstance(node, nodes.table)
    section = next(above(holder, nodes.section), None)
    if not holder["ids"]:
        _name(holder, "table" if is_table else "picture", section)
    anchor = holder["ids"][0]
    if is_table:
        rows = [[e.astext() for e in row.findall(nodes.entry)] for row in node.findall(nodes.row)]
        data = ledger_data.csv_bytes(rows)
        heading = section.next_node(nodes.title).astext() if section is not None else docname
        title = f"{heading}: {', '.join(filter(None, rows[0]))}"
        kind, file = "table" if keys else "settings", f"{docname}-{anchor}.csv".replace("/", "-")
    else:
        caption, path = holder.next_node(nodes.caption), book / node["uri"]
        title = caption.astext() if caption is not None else str(node.get("alt", anchor))
        drawn = node.get("kind") or ledger_data.picture_kind(path)
        kind = "illustration" if keys is None else drawn
        data, file = path.read_bytes(), node["uri"]
    digest = ledger_data.sha256(data)
    return Item(
        kind, _short(title), docname, anchor, keys or (), digest, file, data if is_table else None
    )


def _name(holder: nodes.Element, word: str, section: nodes.Element | None) -> None:
    """Derive an anchor from the section's: it stays the same when other sections change."""
    base = f"{word}-{section['ids'][0]}" if section is not None else word
    document, name, number = holder.document, base, 1
    while name in document.ids:
        number += 1
        name = f"{base}-{number}"
    document.ids[name] = holder
    holder["ids"].append(name)


def _short(text: str) -> str:
    first = re.sub(r"^\d+\. ", "", text).split(". ")[0].removesuffix(".")
    return textwrap.shorten(first, TITLE, placeholder=" …")


def add_line(holder: nodes.Element, text: str, row: str) -> None:
    """Insert the line of provenance at the end of the caption, or below an item without one.

    What was measured has an icon, and the words appear under the mouse or the focus. What was not
    measured says so in words.
    """
    link = nodes.reference("", "ledger", internal=True, refuri="", ledger_row=row)
    caption = holder.next_node(nodes.caption) if isinstance(holder, nodes.figure) else None
    joint = nodes.inline("", " · " if text[-1] != "." else " ", classes=["provenance-joint"])
    parts = [nodes.inline("", text, classes=["provenance-text"]), joint, link]
    classes = ["provenance", *(["as-icon"] if text.startswith(MEASURED) else [])]
    if caption is not None:
        caption += [nodes.Text(" "), nodes.inline("", "", *parts, classes=classes)]
    else:
        line = nodes.paragraph("", "", *parts, classes=classes)
        block = next(above(holder, nodes.paragraph), holder)
        block.parent.insert(block.parent.index(block) + 1, line)


def setup(app: Sphinx) -> None:
    """Register the passes over each page that was read."""
    sphinx_origin.register(app)
    app.connect("doctree-read", refusals.refuse, priority=890)  # before the lines are added
    app.connect("doctree-read", read_page, priority=900)  # pictures are collected before
