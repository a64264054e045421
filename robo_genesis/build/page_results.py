"""The result of executing a page: expected exceptions, its bundle, the failure and the report."""

import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from nbformat import NotebookNode

from robo_genesis.core.project import OUTPUTS_DIR, RUN_ID
from robo_genesis.lessons.book_pages import Page

LOG_LINES = 15
Status = Literal["executed", "reused", "failed"]
PICTURES = {"image/svg+xml", "image/png", "image/jpeg"}
ANSI = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")


@dataclass(frozen=True, slots=True)
class Failure:
    """Why a page failed.

    `cell` counts the code cells from 1 and `line` the lines of the page's source; both are None
    when the failure belongs to no cell. `log` holds the last lines the engine wrote.
    """

    error: str
    message: str
    cell: int | None = None
    line: int | None = None
    source: str = ""
    log: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PageResult:
    """The result of one page in one build.

    `bundle` is None if the page declares none. `folder` is the page's folder in the store; a failed
    page may have none.
    """

    page: Page
    status: Status
    seconds: float
    run_id: str
    bundle: Path | None = None
    failure: Failure | None = None
    folder: Path | None = None


def find_bundle(left: Path, run_id: str) -> Path | None:
    """Return the bundle folder that a run of a page left, None if there is none of that run.

    Args:
        left: the folder of the files that the page left.
        run_id: the run that the bundle's manifest must name.
    """
    for manifest in sorted(left.glob("*/manifest.json")):
        try:
            found = json.loads(manifest.read_text("utf8"))["predicate"]["run_id"]
        except (ValueError, KeyError, TypeError):
            continue
        if found == run_id:
            return manifest.parent
    return None


def missing_bundle(left: Path, page: Page, run_id: str) -> Failure | None:
    """Return the failure of a page that declares a bundle and did not leave it."""
    if not page.declares_bundle or find_bundle(left, run_id):
        return None
    wanted = f"{page.lesson}/{page.page}/<backend>/manifest.json"
    return Failure(
        "BundleMissing",
        f"the front matter declares a bundle, but the run left no {wanted} with predicate.run_id "
        f"{run_id}. Write one to {OUTPUTS_DIR} with {RUN_ID}, "
        "or remove `robo_genesis` from the front matter.",
    )


def unexpected_outcome(source: NotebookNode, executed: NotebookNode) -> Failure | None:
    """Return the first cell that lacks its figure, or whose exception is not the expected one.

    Args:
        source: the page's notebook now; tags and `expects` are read here, because a stored
            notebook keeps those of its execution.
        executed: the same code cells with outputs.
    """
    ran = [cell for cell in executed.cells if cell.cell_type == "code"]
    places = [index for index, cell in enumerate(source.cells) if cell.cell_type == "code"]
    for index, cell in zip(places, ran, strict=True):
        metadata = source.cells[index].metadata
        kinds = {kind for out in cell.outputs for kind in out.get("data", {})}
        if "figure" in metadata.get("tags", []) and not kinds & PICTURES:
            reason = "the cell is tagged figure, but shows none."
            return at_cell(source, index, "FigureMissing", reason)
        raised = [out for out in cell.outputs if out.output_type == "error"]
        if contradiction := _contradiction(metadata, raised):
            return at_cell(source, index, "ExpectedException", contradiction)
    return None


def _contradiction(metadata: NotebookNode, raised: Sequence[NotebookNode]) -> str | None:
    """Return how a cell's exception contradicts its metadata, None if it does not."""
    tags, expects = metadata.get("tags", []), metadata.get("expects")
    happened = f"{raised[-1].ename}: {raised[-1].evalue}" if raised else "no exception"
    if "skip-execution" in tags:
        return "the tag skip-execution is not allowed; show code that is not run in a plain fence."
    if "raises-exception" not in tags:
        if raised:
            return f"the cell raised {happened}, but is not tagged raises-exception."
        return "the cell has `expects` without the tag raises-exception." if expects else None
    if not expects:
        return (
            "the cell is tagged raises-exception but does not say what it expects; "
            f'it raised {happened}. Add the option `expects: "ValueError: part of the message"`.'
        )
    name, _, text = str(expects).partition(":")
    if raised and raised[-1].ename == name.strip() and text.strip() in raised[-1].evalue:
        return None
    return f"expected was {expects!r}, but the cell raised {happened}."


def at_cell(
    notebook: NotebookNode, index: int, error: str, message: str, log: Iterable[str] = ()
) -> Failure:
    """Return a failure with the place of a cell.

    Args:
        notebook: the notebook, read with its source map.
        index: the cell's position among all cells.
        error: name of the exception.
        message: its whole message.
        log: last log lines.
    """
    lines = notebook.metadata.get("source_map", [])
    numbers = [cell.cell_type for cell in notebook.cells[: index + 1]]
    return Failure(
        error,
        message,
        cell=numbers.count("code"),
        line=lines[index] + 1 if index < len(lines) else None,
        source=next(iter(notebook.cells[index].source.strip().splitlines()), ""),
        log=tuple(log),
    )


def last_log_lines(notebook: NotebookNode, upto: int) -> tuple[str, ...]:
    """Return the last lines that the cells up to a position wrote, the engine's log among them."""
    written = [
        output.text
        for cell in notebook.cells[: upto + 1]
        for output in cell.get("outputs", [])
        if output.output_type == "stream"
    ]
    return last_lines("".join(written))


def last_lines(text: str) -> tuple[str, ...]:
    """Return the last lines of a text, colours removed."""
    return tuple(ANSI.sub("", text).splitlines()[-LOG_LINES:])


def failure_report(results: Sequence[PageResult]) -> str:
    """Return one text that names page, cell, exception and last log lines of every failed page.

    Args:
        results: all pages of the build.
    """
    failed = [(result.page, result.failure) for result in results if result.failure]
    lines = [f"{len(failed)} of {len(results)} pages failed."]
    for page, failure in failed:
        place = page.docname
        if failure.cell is not None:
            place += f", code cell {failure.cell}, line {failure.line}: {failure.source}"
        message = f"{failure.error}: {failure.message}".splitlines()
        lines += ["", place, *(f"    {line}" for line in message)]
        if failure.log:
            lines += ["    last log lines:", *(f"    | {line}" for line in failure.log)]
    return "\n".join(lines)
