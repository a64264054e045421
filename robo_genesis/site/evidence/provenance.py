"""Finds what cells and runs show on a page, and writes its origin below it.

A picture or table is measured if `page.show` displayed it, or if it was read from a
bundle. Other outputs of cells are printed, also texts: the build compares them with the
bundle, but does not compute them again. The outputs of a cell that is tagged `inputs`
were chosen. A picture that no run made is an illustration. A table typed in prose has
no line.
"""

from collections.abc import Sequence, Set
from itertools import chain, count
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.core.markup import filled
from robo_genesis.site.frame.executed import RECOMPUTED

from .origin import INPUTS, above, origin
from .plain_nodes import html
from .runs import PageRun, all_runs, measured_pages

LINE = Path(__file__).with_suffix(".html")  # The template of the line
LEDGER = "evidence/ledger"  # The page that lists the runs

UNBOUND = (
    "a cell shows an output, but the page declares no bundle. Give its front matter "
    f"`robo_genesis: {{lesson, page}}`, or tag a cell of chosen values `{INPUTS}`."
)

logger = logging.getLogger(__name__)

# How the line below an item begins whose runs are all accepted.
MEASURED, PRINTED = "Measured", "Printed by this run"

# The line below an item that belongs to no run, by the keys of its origin.
WITHOUT_RUN: dict[tuple[str, ...] | None, str] = {
    None: "Illustration, not measured.",
    (): "Settings, not measured.",
}


def read_page(app: Sphinx, doctree: nodes.document) -> None:
    """Write below each output and picture of a page where it is from."""
    env = app.env
    book = Path(env.srcdir)
    known, page = all_runs(book), measured_pages(book).get(env.docname)
    recomputed = RECOMPUTED.get(env.docname, set())
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
        kind = "picture" if is_picture else "printed" if texts else "table"
        give_anchor(holder, kind)
        if texts:
            holder["classes"].append("printed")
        printed = cell is not None and cell.get("cell_index") not in recomputed
        runs, address = [known[key] for key in keys or ()], ""
        if runs and LEDGER in env.found_docs:  # a small book has none
            ledger = app.builder.get_relative_uri(env.docname, LEDGER)
            address = f"{ledger}#{runs[0].anchor}"
        line = WITHOUT_RUN[keys] if not keys else of_runs(printed, runs)
        add_line(last if texts else holder, line, address)


def of_runs(printed: bool, runs: Sequence[PageRun]) -> str:
    """Return the line below an item that runs made, without its link.

    Args:
        printed: whether it was compared with the bundle and not computed again.
        runs: the runs.
    """
    lacking = [run.status.badge for run in runs if run.manifest is None]
    if lacking:
        return f"No accepted evidence: {', '.join(lacking)}."
    origins = (
        f"on {run.status.backend} · Genesis {accepted.engine.version} · run {accepted.run_id[:8]}"
        for run in runs
        if (accepted := run.manifest)
    )
    return f"{PRINTED if printed else MEASURED} {' and '.join(origins)}"


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


def give_anchor(holder: nodes.Element, kind: str) -> None:
    """Give an item an anchor, by default from its section's: other sections do not change it."""
    if not holder["ids"]:
        base = f"{kind}-{next(above(holder, nodes.section))['ids'][0]}"
        used = holder.document.ids
        names = chain([base], (f"{base}-{n}" for n in count(2)))
        name = next(name for name in names if name not in used)
        used[name] = holder
        holder["ids"].append(name)


def add_line(holder: nodes.Element, text: str, address: str) -> None:
    """Insert the line of provenance at the end of the caption, or below an item without one.

    What a run measured or printed has an icon, and the words appear under the mouse or
    the focus. Anything else says so in words. `address` is that of its run in the
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
