"""The result of executing a page: expected exceptions, its bundle, the failure and the report."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nbformat import NotebookNode

from robo_genesis.core.checks import CheckFailed
from robo_genesis.core.palette import VALID_COLOURS, outside_the_palette
from robo_genesis.pipeline.command import ANSI

from .book import Page, code_cells
from .guards import contradicted
from .page_folder import OUTPUTS, find_bundle
from .page_rules import MOST_IN_PICTURE, first_line

LOG_LINES = 15
PICTURES = {"image/svg+xml", "image/png", "image/jpeg"}

# What a cell may put out. The course's style has no form for other kinds, such as HTML.
KINDS = PICTURES | {"text/plain", "text/markdown"}

INSTEAD = (
    "Show a table as `Markdown(tables.markdown(rows))` of robo_genesis.core, frames and arrays in "
    "a figure, and a motion by the directive {replay}."
)
TAG_IT = (
    "Tag it figure, and describe the picture in the option `mystnb: {image: {alt: …}}`."
)
MOST_LETTERS = 100_000
ANEW = (
    "It differs in each run, or is a command for a terminal. Print names and values; a semicolon "
    "at the end of the last line hides the value of a call."
)

# Addresses and temporary folders, which differ in each run, and characters for
# terminals.
CHANGING = re.compile(
    r"\bat 0x[0-9a-f]+|\b0x[0-9a-f]{9,}|/(?:tmp|robo-)[a-z0-9_]{8}\b|[\0-\x08\x0b\x0c\x0e-\x1f\x7f]"
)


@dataclass(frozen=True, slots=True)
class Failure:
    """Why a page failed.

    `cell` counts the code cells from 1; `line` is the number of the failing line in the
    page's source, and `source` that line: the one that raised, or called what raised,
    or the cell's first if no line is known. Number and cell are None when the failure
    belongs to no cell.
    """

    error: str
    message: str
    cell: int | None = None
    line: int | None = None
    source: str = ""

    def __str__(self) -> str:
        return f"{self.error}: {self.message}"


@dataclass(frozen=True, slots=True)
class PageResult:
    """The result of one page in one build.

    `status` is executed, reused or failed. `folder` is the page's folder in the store,
    where a failed page may be absent. `log` is the file with all that an executed page
    wrote.
    """

    page: Page
    status: str
    folder: Path
    seconds: float = 0.0
    failure: Failure | None = None
    log: Path | None = None

    @property
    def bundle(self) -> Path | None:
        """The evidence bundle that the page left, None if it declares none."""
        return find_bundle(self.folder / OUTPUTS)


def unexpected_outcome(page: Page, executed: NotebookNode) -> Failure | None:
    """Return the first cell with another exception than expected, or with a wrong output.

    Args:
        page: the page now; tags and `expects` are read here, because a stored notebook
            keeps those of its execution.
        executed: the same code cells with outputs.
    """
    source = page.notebook
    places = [k for k, cell in enumerate(source.cells) if cell.cell_type == "code"]
    for index, cell in zip(places, code_cells(executed), strict=True):
        metadata = source.cells[index].metadata
        wrong = _wrong_output(metadata.get("tags", []), cell.outputs)
        if wrong := wrong or _contradiction(metadata, cell.outputs):
            return at_cell(page, index, *wrong, cell)
    return None


def _wrong_output(
    tags: Sequence[str], outputs: Sequence[NotebookNode]
) -> tuple[str, str] | None:
    """Return the name of the first rule that the outputs of a cell break, with reason and cure."""
    data = [item for out in outputs for item in out.get("data", {}).items()]
    odd = ", ".join(sorted({kind for kind, _ in data} - KINDS))
    if odd:
        return "OutputKind", f"the cell puts out {odd}. {INSTEAD}"
    pictures = [content for kind, content in data if kind in PICTURES]
    if pictures and "figure" not in tags:
        return "FigureUntagged", f"the cell shows a picture. {TAG_IT}"
    if "figure" in tags and not pictures:
        return "FigureMissing", "the cell is tagged figure, but shows none."
    if colours := {each for of in pictures for each in outside_the_palette(of)}:
        return "Colour", f"the cell draws in {', '.join(colours)}. {VALID_COLOURS}"
    texts = [out.get("text", out.get("evalue", "")) for out in outputs]
    texts += [content for kind, content in data if kind not in PICTURES]
    size = sum(map(len, texts))
    if size > MOST_LETTERS or any(len(of) > MOST_IN_PICTURE for of in pictures):
        return (
            "OutputSize",
            f"the cell puts out {size:,} characters and {len(pictures)} pictures. Valid are "
            f"{MOST_LETTERS:,}, and {MOST_IN_PICTURE:,} of a picture. Print a summary, or draw "
            "fewer points.",
        )
    if changing := CHANGING.search("\n".join(texts)):
        return "OutputChanges", f"the cell puts out {changing[0]!r}. {ANEW}"
    return None


def _contradiction(
    metadata: NotebookNode, outputs: Sequence[NotebookNode]
) -> tuple[str, str] | None:
    """Return how a cell's exception contradicts its metadata, None if it does not."""
    expects, raised = metadata.get("expects"), ("no exception", "")
    for out in outputs:
        if out.output_type == "error":
            raised = (out.ename, out.evalue)
    happened = ": ".join(filter(None, raised))
    name, _, text = str(expects or "no exception").partition(":")
    if raised[0] == name.strip() and text.strip() in raised[1]:
        return None
    reason = f"expected was {expects!r}, but the cell raised {happened}."
    if not expects:
        reason = f"the cell raised {happened}, but is not tagged raises-exception."
    return "ExpectedException", reason


def at_cell(
    page: Page, index: int, error: str, message: str, ran: NotebookNode
) -> Failure:
    """Return a failure with the place of a cell.

    Args:
        page: the page, read with its source map.
        index: the cell's position among all cells.
        error: name of the exception.
        message: its whole message.
        ran: the cell with its outputs; the traceback among them names the failing line.
    """
    cells, text = page.notebook.cells, page.path.read_text("utf8").split("\n")
    lines = cells[index].source.splitlines() or [""]
    failing = min(_failing_line(ran), len(lines))
    if error == CheckFailed.__name__:
        book = page.path.parents[page.docname.count("/")]
        name = f"{page.lesson}/{page.page}"
        message += contradicted(book, page.path, name, message)
    return Failure(
        error,
        message,
        cell=cell_number(page.notebook, index),
        line=first_line(text, page.notebook, index) + failing - 1,
        source=lines[failing - 1].strip(),
    )


def cell_number(notebook: NotebookNode, index: int) -> int:
    """Return which code cell, counted from 1, is the cell at an index."""
    return [cell.cell_type for cell in notebook.cells[: index + 1]].count("code")


def _failing_line(ran: NotebookNode) -> int:
    """Return which line of an executed cell failed, 1 if its outputs do not say so.

    It is the last line of this cell in the traceback: later frames are of other cells
        and files.
    """
    errors = [out for out in ran.get("outputs", []) if out.output_type == "error"]
    if not errors:
        return 1
    text = ANSI.sub("", "\n".join(errors[-1].traceback))
    found = re.findall(
        rf"^ *Cell In\[{ran.execution_count}\], line (\d+)", text, re.MULTILINE
    )
    # A syntax error that is found before the cell is compiled has a line, but no frame.
    found = found or re.findall(r"\(<\w+>, line (\d+)\)$", errors[-1].evalue)
    return int(found[-1]) if found else 1


def failure_report(results: Sequence[PageResult]) -> str:
    """Return one text that names page, cell, exception and last log lines of every failed page.

    Args:
        results: all pages of the build.
    """
    failed = [(r.page, r.failure, r.log) for r in results if r.failure]
    lines = [f"{len(failed)} of {len(results)} pages failed."]
    for page, failure, log in failed:
        place = page.docname
        if failure.cell is not None:
            place += (
                f", code cell {failure.cell}, line {failure.line}: {failure.source}"
            )
        lines += ["", place, *(f"    {line}" for line in str(failure).splitlines())]
        written = log.read_text("utf8", errors="replace") if log else ""
        if last := ANSI.sub("", written).splitlines()[-LOG_LINES:]:
            lines += [f"    last lines of {log}:", *(f"    | {line}" for line in last)]
    return "\n".join(lines)
