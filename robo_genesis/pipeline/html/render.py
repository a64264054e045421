"""Render the book with Sphinx, from executed pages and nothing else.

A kept folder saves Sphinx from reading and writing unchanged pages; the site is the
same.
"""

import shutil
from collections.abc import Callable
from pathlib import Path

from robo_genesis.pipeline.html.draft import Draft
from robo_genesis.pipeline.html.kept import UNFIT, keep, prepare, read_state
from robo_genesis.pipeline.html.sphinx_process import HTML, SphinxProcess
from robo_genesis.pipeline.pages.page_index import PageIndex

# The folder of the states of runs. Every change on which they depend empties the kept
# folder.
STATES = "states"


def render(
    sphinx: SphinxProcess,
    staging: Path,
    built: PageIndex,
    kept_folder: Path | None = None,
    meanwhile: Callable[[Draft], None] = lambda draft: None,
) -> Draft:
    """Render every page of a book.

    Args:
        sphinx: the process that has loaded the book's configuration.
        staging: folder for the result; its older content is removed.
        built: the executed pages.
        kept_folder: has the doctrees, pages and states of runs of the last render, and
            gets those of this one. None renders from nothing.
        meanwhile: called once, while Sphinx works. What it raises is raised here; the
            next render then starts from nothing.

    Returns:
        The site, complete but for archive and sums.

    Raises:
        ProjectError: Sphinx failed or gave a warning.
    """
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(parents=True)
    rendered = (kept_folder or staging) / HTML
    draft = Draft(rendered, staging / "site")
    if kept_folder is None:
        sphinx.render(staging, built, lambda: meanwhile(draft))
    else:
        _render_changes(sphinx, kept_folder, built, lambda: meanwhile(draft))
    return draft.complete()


def _render_changes(
    sphinx: SphinxProcess,
    folder: Path,
    built: PageIndex,
    meanwhile: Callable[[], None] = lambda: None,
) -> None:
    """Render what changed since the last render in a folder."""
    before = read_state(sphinx.book, built)
    was_kept = prepare(folder, before)
    kept = built.model_copy(update={"states": folder / STATES})
    sphinx.render(folder, kept, meanwhile)
    if (
        was_kept and (folder / UNFIT).exists()
    ):  # the state is gone, so this one starts from nothing
        with SphinxProcess(sphinx.book, sphinx.log) as another:
            return _render_changes(another, folder, built)
    keep(folder, before, read_state(sphinx.book, built))
