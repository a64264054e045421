"""What a page's sets of compiled kernels cost: measured cold and warm, kept, told stale.

The engine compiles kernels for each scene whose structure or options it has not met. A page marks
the cell that brings such a set along by the option `kernels: why it is a set of its own`; the set
lasts until the next such cell.
"""

import hashlib
import json
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

from nbformat import NotebookNode

from robo_genesis import kept, project
from robo_genesis.execute import TIMEOUT, execute_pages
from robo_genesis.page_cache import PageCache, array_digests, notebooks_folder, outputs_folder
from robo_genesis.page_results import failure_report
from robo_genesis.pages import Page

OPTION = "kernels"
COMMAND = "make costs"


class CostsError(kept.KeptError):
    """A page's costs cannot be measured; the message says what to do."""


class Cost(kept.Part):
    """Seconds that the cells of one set took with nothing compiled, and with everything."""

    cold: float
    warm: float


class Costs(kept.Record):
    """One measurement of a page: the cells that it is of, and the cost of each set in order."""

    code: str
    sets: tuple[Cost, ...]


@dataclass(frozen=True, slots=True)
class Measuring:
    """Where a measurement works: the checkout, its book, and who is told of progress."""

    root: Path = project.ROOT
    book: Path = project.BOOK
    timeout: int = TIMEOUT
    say: Callable[[str], None] = print


def code_cells(page: Page) -> list[NotebookNode]:
    """Return a page's code cells in order."""
    return [cell for cell in page.notebook.cells if cell.cell_type == "code"]


def set_names(page: Page) -> list[str]:
    """Return what a page says of its sets of kernels, in its order."""
    return [str(c.metadata[OPTION]) for c in code_cells(page) if OPTION in c.metadata]


def marked_code(page: Page) -> str:
    """Return the sha256 of the cells that bring the sets along."""
    cells = [cell.source for cell in code_cells(page) if OPTION in cell.metadata]
    return hashlib.sha256(json.dumps(cells).encode()).hexdigest()


def spans(page: Page, seconds: Sequence[float]) -> list[float]:
    """Add up the seconds of the cells of each set.

    Args:
        page: a page with marked cells.
        seconds: of each of its code cells.

    Returns:
        One sum for each set; cells before the first mark belong to none.

    Raises:
        ValueError: there is not one entry for each code cell.
    """
    numbers = accumulate(OPTION in cell.metadata for cell in code_cells(page))
    sums = [0.0] * len(set_names(page))
    for number, own in zip(numbers, seconds, strict=True):
        if number:
            sums[number - 1] += own
    return [round(total, 1) for total in sums]


def record_file(book: Path, page: Page) -> Path:
    """Return where the book keeps what a page's kernels cost."""
    return book / kept.FOLDER / f"{page.lesson}-{page.page}.json"


def read_costs(book: Path, page: Page) -> Costs | None:
    """Return the kept measurement of a page, None where there is none.

    Raises:
        KeptError: the file is no such record.
    """
    return kept.read(record_file(book, page), Costs, COMMAND)


def stale(costs: Costs, page: Page, root: Path = project.ROOT) -> str | None:
    """Return why a measurement no longer speaks of a page as it is, None where it does."""
    reason = kept.stale(costs, root)
    if reason:
        return reason
    if costs.code != marked_code(page):
        return "the cells that build the scenes have changed since"
    return None


def measure(pages: Iterable[Page], how: Measuring) -> list[Path]:
    """Run each marked page twice from one empty cache, first cold, then warm; keep what it cost.

    Args:
        pages: the pages of the book.
        how: where to work.

    Returns:
        The files written, one a page; none is written where a page fails.

    Raises:
        CostsError: no page is marked, or a page fails.
    """
    marked = [page for page in pages if set_names(page)]
    if not marked:
        raise CostsError(f"No page of {how.book} has a cell with the option `{OPTION}: why`.")
    found = {page.docname: _measured(page, how) for page in marked}
    return [kept.keep(record_file(how.book, page), found[page.docname]) for page in marked]


def _measured(page: Page, how: Measuring) -> Costs:
    with tempfile.TemporaryDirectory(prefix="robo-costs-") as name:
        cache = Path(name)
        cold, warm = (
            spans(page, _cell_seconds(page, cache, state, how)) for state in ("cold", "warm")
        )
        before, after = (array_digests(outputs_folder(cache / s)) for s in ("cold", "warm"))
    if before != after:
        raise CostsError(
            f"{page.docname}: what was measured depends on what was compiled before. Arrays that "
            f"differ between a cold and a warm run: {', '.join(_moved(before, after))}."
        )
    return Costs(
        **kept.surroundings(how.root),
        code=marked_code(page),
        sets=tuple(Cost(cold=c, warm=w) for c, w in zip(cold, warm, strict=True)),
    )


def _moved(before: Mapping[str, str], after: Mapping[str, str]) -> list[str]:
    """Return the names that two listings do not agree on."""
    return sorted(dict(before.items() ^ after.items()))


def _cell_seconds(page: Page, cache: Path, state: str, how: Measuring) -> list[float]:
    """Run a page in a folder of executed pages of its own, with the engine's cache as it is."""
    environment: Mapping[str, str] = {
        **project.engine_cache_environment(how.root, cache),
        **project.environment_contract(),
        "ROBO_GENESIS_COMMAND": COMMAND,
    }
    [result] = execute_pages(
        [page],
        cache / state,
        timeout=how.timeout,
        environment=environment,
        on_progress=lambda what, event: how.say(f"{state}  {what}  {event}".rstrip()),
    )
    if result.failure:
        raise CostsError(failure_report([result]))
    notebooks = PageCache(notebooks_folder(cache / state))
    executed: NotebookNode = notebooks.get_cache_bundle(
        notebooks.match_cache_notebook(page.notebook).pk
    ).nb
    return list(executed.metadata["robo_genesis"]["cell_seconds"])
