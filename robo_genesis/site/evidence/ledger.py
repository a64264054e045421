"""The ledger: every run, figure, measured table and printed text, with digests and downloads.

A page writes ```` ```{ledger} runs ```` and ```` ```{ledger} items ````. Both are
filled in after all pages are read.
"""

from collections.abc import Sequence
from html import escape
from itertools import chain
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.osutil import relative_uri

from robo_genesis.core.files import write_whole
from robo_genesis.pipeline.pages.book import page_files
from robo_genesis.site.evidence import ledger_data
from robo_genesis.site.evidence.plain_nodes import Cell, between, html, paragraph, table
from robo_genesis.site.evidence.provenance import ITEMS
from robo_genesis.site.evidence.runs import (
    PageRun,
    all_runs,
    badge_node,
    measured_pages,
)
from robo_genesis.site.pages import PageDirective

DOWNLOADS = "_downloads/evidence"
COLUMNS = (
    "what",
    "kind",
    "page",
    "run",
    "backend",
    "Genesis",
    "measured (UTC)",
    "checks",
    "sha256",
    "file",
)


class ledger_part(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes so
    """Placeholder for the list of runs or items until all pages are read."""


class Ledger(PageDirective):
    """List all runs, or all figures, tables and printed texts of the site."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the placeholder."""
        part = self.arguments[0]
        if part not in ("runs", "items"):
            raise ValueError("the choices are runs and items.")
        self.env.note_reread()
        return [ledger_part(part=part)]


def fill_in(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Write the ledger's parts."""
    for part in list(doctree.findall(ledger_part)):
        if part["part"] == "runs":
            runs = all_runs(Path(app.srcdir)).values()
            part.replace_self([run_block(docname, run) for run in runs])
        else:
            part.replace_self(item_table(app, docname))


def run_block(docname: str, run: PageRun) -> nodes.Node:
    """Return a run's facts and its bundle, or why it is missing and the command that creates it."""
    block = nodes.container(ids=[run_anchor(run.key)], classes=["run-block"])
    block += paragraph(nodes.strong("", run.page), " ", badge_node(run.status))
    if run.status.summary or run.manifest is None:
        block += paragraph(run.status.summary or run.status.reason)
    if run.manifest is None:
        block += nodes.literal_block(run.command, run.command, language="console")
        return block
    facts: dict[str, Cell] = {**ledger_data.facts(run.status.backend, run.manifest)}
    facts["evidence key"] = _digest(run.manifest.evidence_key)
    name = ledger_data.archive_name(run)
    facts["bundle"] = _link(
        name, relative_uri(f"{docname}.html", f"{DOWNLOADS}/{name}")
    )
    facts["its sha256"] = _digest(ledger_data.sha256(ledger_data.archive(run.folder)))
    block += scroll_box(
        f"Run {run.page} on {run.status.backend}", table((), list(facts.items()))
    )
    return block


def item_table(app: Sphinx, docname: str) -> nodes.Node:
    """Return the table of all items on the pages, in the order of the pages."""
    env, runs = app.env, all_runs(Path(app.srcdir))
    rows, anchors = [], []
    order = page_files(Path(app.srcdir))
    for item in (item for name in order for item in env.metadata[name][ITEMS]):
        place = app.builder.get_relative_uri(docname, item.docname)
        word, file = item.file.rpartition(".")[2].upper(), f"{DOWNLOADS}/{item.file}"
        if item.data is None:
            word, file = "picture", f"_images/{env.images[item.file][1]}"
        page = measured_pages(Path(app.srcdir)).get(item.docname, item.docname)
        what = [_link(item.title, f"{place}#{item.anchor}"), item.kind, page]
        last = [
            _digest(item.sha256),
            _link(word, relative_uri(f"{docname}.html", file)),
        ]
        rows.append([*what, *_of_runs([runs[key] for key in item.runs]), *last])
        anchors.append(item.row)
    return scroll_box("Figures and tables", table(COLUMNS, rows, anchors))


def _of_runs(runs: Sequence[PageRun]) -> list[Cell]:
    """Return five cells with a paragraph for each run."""
    return [*zip(*map(_of_run, runs), strict=True)] if runs else ["no run", *"––––"]


def _of_run(run: PageRun) -> list[str | nodes.Node]:
    badge, manifest = badge_node(run.status), run.manifest
    if manifest is None:
        return ["–", badge, *"–––"]
    facts = ledger_data.facts(run.status.backend, manifest)
    link = _link(facts["run"], f"#{run_anchor(run.key)}")
    more = (facts[name] for name in ("started (UTC)", "checks passed"))
    return [link, badge, manifest.engine.version, *more]


def run_anchor(key: str) -> str:
    """Return the anchor of a run's block."""
    return f"run-{key}".replace("/", "-")


def _digest(value: str) -> nodes.Node:
    """Return a sha256 whose first digits are visible, and all of them on hover or focus."""
    return html(f'<code class="digest" tabindex="0">{value}</code>')


def _link(text: str, address: str) -> nodes.Node:
    return nodes.reference("", text, internal=True, refuri=address)


def scroll_box(label: str, *inside: nodes.Node) -> between:
    """Return a box that scrolls a wide table and accepts the keyboard's focus."""
    named = (
        f'aria-label="{escape(label)}" class="scroll-box" role="region" tabindex="0"'
    )
    return between("", *inside, opening=f"<div {named}>\n", closing="</div>\n")


def write_downloads(app: Sphinx, exception: Exception | None) -> None:
    """Write the tables, texts and bundles that the ledger links to."""
    if exception is not None or ledger_data.LEDGER not in app.env.found_docs:
        return
    folder = Path(app.outdir) / DOWNLOADS
    for item in chain.from_iterable(
        page.get(ITEMS, ()) for page in app.env.metadata.values()
    ):
        if item.data is not None:
            write_whole(folder / item.file, item.data)
    for run in all_runs(Path(app.srcdir)).values():
        if run.manifest is not None:
            write_whole(
                folder / ledger_data.archive_name(run), ledger_data.archive(run.folder)
            )


def setup(app: Sphinx) -> None:
    """Register the directive, its nodes and the two later steps."""
    app.add_directive("ledger", Ledger)
    app.add_node(ledger_part)
    app.connect("doctree-resolved", fill_in)
    app.connect("build-finished", write_downloads)
