"""The ledger: every run, and every figure and measured table, with digests and downloads.

A page writes ```` ```{ledger} runs ```` and ```` ```{ledger} items ````; both are filled in when
all pages are read.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective
from sphinx.util.osutil import relative_uri

from robo_genesis.site.evidence import ledger_data
from robo_genesis.site.evidence.ledger_data import Run
from robo_genesis.site.evidence.measured import badge_node, make_command
from robo_genesis.site.evidence.provenance import all_items, all_runs, measured_pages

LEDGER = "evidence/ledger"
DOWNLOADS = "_downloads/evidence"
COLUMNS = (
    "what", "kind", "page", "run", "backend", "Genesis", "measured (UTC)", "checks", "sha256",
    "file",
)  # fmt: skip


class ledger_part(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes so
    """Stands for the list of runs or items until all pages are read."""


class scroll_box(nodes.container):  # noqa: N801
    """A wide table in a box of its own, which scrolls and takes the keyboard's focus."""


class digest_text(nodes.inline):  # noqa: N801
    """A sha256 of which the first digits are seen, and all on hover or focus."""


class Ledger(SphinxDirective):
    """List all runs, or all figures and tables of the site."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return what is filled in later."""
        part = self.arguments[0]
        if part not in ("runs", "items"):
            raise self.error(f"ledger: {part!r} is not valid. Choices: runs, items.")
        return [ledger_part(part=part)]


def fill_in(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Lead the lines of provenance to the ledger, and write the ledger's parts."""
    for link in list(doctree.findall(lambda n: "ledger_row" in getattr(n, "attributes", {}))):
        if LEDGER in app.env.found_docs:
            target = app.builder.get_relative_uri(docname, LEDGER)
            link["refuri"] = f"{target}#{link['ledger_row']}"
        else:
            link.parent.remove(link)
    for part in list(doctree.findall(ledger_part)):
        build = run_blocks if part["part"] == "runs" else item_table
        part.replace_self(build(app, docname))


def run_blocks(app: Sphinx, docname: str) -> list[nodes.Node]:
    """Return one block a run."""
    runs = all_runs(Path(app.srcdir))
    return [run_block(docname, run) for run in runs.values()]


def run_block(docname: str, run: Run) -> nodes.Node:
    """Return a run's facts and its bundle, or what is missing and makes it."""
    block = nodes.container(ids=[run_anchor(run.key)], classes=["run-block"])
    title = nodes.strong("", run.page)
    block += nodes.paragraph("", "", title, nodes.Text(" "), badge_node(run.status))
    if run.status.summary or run.predicate is None:
        block += nodes.paragraph("", run.status.summary or run.status.reason)
    if run.predicate is None:
        block += make_command(run.page.split("/")[0], run.status.backend, run.recorded)
    else:
        rows = [[_cell(name), _fact(name, value)] for name, value in ledger_data.facts(run).items()]
        data = ledger_data.archive(run.folder)
        href = _address(docname, f"{DOWNLOADS}/{ledger_data.archive_name(run)}")
        rows.append([_cell("bundle"), _link(ledger_data.archive_name(run), href)])
        rows.append([_cell("its sha256"), _digest(ledger_data.sha256(data))])
        block += scroll(f"Run {run.page} on {run.status.backend}", (), rows)
    return block


def item_table(app: Sphinx, docname: str) -> list[nodes.Node]:
    """Return the table of everything that the pages show, in the order of the pages."""
    env, runs = app.env, all_runs(Path(app.srcdir))
    order = [name for name in _reading_order(env) if name in all_items(env)]
    rows, anchors = [], []
    for item in (item for name in order for item in all_items(env)[name]):
        place = app.builder.get_relative_uri(docname, item.docname)
        file = f"{DOWNLOADS}/{item.file}" if item.data is not None else _image(env, item.file)
        page = measured_pages(Path(app.srcdir)).get(item.docname, item.docname)
        rows.append(
            [
                _link(item.title, f"{place}#{item.anchor}"),
                *(_cell(text) for text in (item.kind, page)),
                *_of_runs([runs[key] for key in item.runs]),
                _digest(item.sha256),
                _link("CSV" if item.data is not None else "picture", _address(docname, file)),
            ]
        )
        anchors.append(item.row)
    return [scroll("Figures and tables", COLUMNS, rows, anchors)]


def _of_runs(runs: Sequence[Run]) -> list[list[nodes.Node]]:
    """Return five cells with a paragraph for each run."""
    if not runs:
        return [[_cell(text)] for text in ("no run", *"––––")]
    return [list(cell) for cell in zip(*map(_of_run, runs), strict=True)]


def _of_run(run: Run) -> list[nodes.Node]:
    if run.predicate is None:
        return [_cell("–"), badge_node(run.status), *(_cell("–") for _ in range(3))]
    predicate = run.predicate
    return [
        _link(predicate.run_id[:8], f"#{run_anchor(run.key)}"),
        badge_node(run.status),
        *map(
            _cell,
            (
                predicate.engine.version,
                ledger_data.moment(predicate),
                ledger_data.passed(predicate),
            ),
        ),
    ]


def run_anchor(key: str) -> str:
    """Return the anchor of a run's block."""
    return f"run-{key}".replace("/", "-")


def _reading_order(env: BuildEnvironment) -> list[str]:
    """Return all pages as the table of contents orders them."""
    order = [env.config.root_doc]
    for name in order:
        order += [child for child in env.toctree_includes.get(name, []) if child not in order]
    return order


def _cell(text: str) -> nodes.Node:
    return nodes.Text(text)


def _fact(name: str, value: str) -> nodes.Node:
    return _digest(value) if name == "evidence key" else _cell(value)


def _digest(value: str) -> nodes.Node:
    return digest_text("", value, classes=["digest"])


def _link(text: str, address: str) -> nodes.Node:
    return nodes.reference("", text, internal=True, refuri=address)


def _address(docname: str, file: str) -> str:
    return relative_uri(f"{docname}.html", file)


def _image(env: BuildEnvironment, uri: str) -> str:
    return f"_images/{env.images[uri][1]}"


def scroll(
    label: str,
    head: Sequence[str],
    rows: Sequence[Sequence[nodes.Node | Sequence[nodes.Node]]],
    anchors: Sequence[str] = (),
) -> nodes.Node:
    """Return a table in a scroll box; `head` may be empty, `anchors` names the rows.

    A cell is a node, or several that stand below each other.
    """
    width = len(rows[0])
    group = nodes.tgroup("", *(nodes.colspec(colwidth=1) for _ in range(width)), cols=width)
    if head:
        group += nodes.thead("", _row(map(_cell, head)))
    body = nodes.tbody("", *(_row(line) for line in rows))
    for row, anchor in zip(body, anchors, strict=False):
        row["ids"].append(anchor)
    group += body
    return scroll_box("", nodes.table("", group), label=label)


def _row(cells: Iterable[nodes.Node | Sequence[nodes.Node]]) -> nodes.row:
    row = nodes.row()
    for cell in cells:
        parts = [cell] if isinstance(cell, nodes.Node) else cell
        row += nodes.entry("", *(nodes.paragraph("", "", part) for part in parts))
    return row


def write_downloads(app: Sphinx, exception: Exception | None) -> None:
    """Write tables and bundles beside the pages that link to them."""
    if exception is not None or app.builder.format != "html" or LEDGER not in app.env.found_docs:
        return
    folder = Path(app.outdir) / DOWNLOADS
    folder.mkdir(parents=True, exist_ok=True)
    for item in (item for items in all_items(app.env).values() for item in items):
        if item.data is not None:
            (folder / item.file).write_bytes(item.data)
    for run in all_runs(Path(app.srcdir)).values():
        if run.predicate is not None:
            (folder / ledger_data.archive_name(run)).write_bytes(ledger_data.archive(run.folder))


def visit_scroll_box(self: Any, node: scroll_box) -> None:
    """Open the box."""
    given = {"role": "region", "tabindex": "0", "aria-label": node["label"]}
    self.body.append(self.starttag(node, "div", CLASS="scroll-box", **given))


def depart_scroll_box(self: Any, node: scroll_box) -> None:
    """Close the box."""
    self.body.append("</div>\n")


def visit_digest(self: Any, node: digest_text) -> None:
    """Open a digest that widens when it has the focus."""
    self.body.append(self.starttag(node, "code", "", tabindex="0"))


def depart_digest(self: Any, node: digest_text) -> None:
    """Close it."""
    self.body.append("</code>")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive, its nodes, and what fills and writes."""
    app.add_directive("ledger", Ledger)
    app.add_node(ledger_part)
    app.add_node(scroll_box, html=(visit_scroll_box, depart_scroll_box))
    app.add_node(digest_text, html=(visit_digest, depart_digest))
    app.connect("doctree-resolved", fill_in)
    app.connect("build-finished", write_downloads)
    return {"version": "1", "parallel_read_safe": False, "parallel_write_safe": True}
