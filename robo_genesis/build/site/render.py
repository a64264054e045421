"""Render the book with Sphinx, from executed pages and nothing else.

A kept folder saves Sphinx from reading and writing unchanged pages; the site is the same.
"""

import shutil
from collections.abc import Callable
from pathlib import Path

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.site.kept import copy_site, fit, keep, prepare, read_state
from robo_genesis.build.site.sphinx_process import SphinxProcess

STATES = "states"
"""The folder of the states of runs. Every change on which they depend empties the kept folder."""
BUILD_INFO = ".buildinfo"
"""A note of Sphinx for its next build, which depends on the checkout's path."""


def render(
    sphinx: SphinxProcess,
    staging: Path,
    built: BuiltPages,
    kept_folder: Path | None = None,
    meanwhile: Callable[[], None] = lambda: None,
) -> Path:
    """Render every page of a book.

    Args:
        sphinx: the process that has loaded the book's configuration.
        staging: folder for the result; its older content is removed.
        built: the executed pages.
        kept_folder: has the doctrees, pages, states of runs and compiled templates of the last
            render, and gets those of this one. None renders from nothing.
        meanwhile: called once, while Sphinx works. What it raises is raised here; the next render
            then starts from nothing.

    Returns:
        The folder with the site's HTML.

    Raises:
        RenderError: Sphinx failed or gave a warning.
    """
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(parents=True)
    if kept_folder is None:
        rendered = sphinx.render(staging, built, meanwhile)
    else:
        rendered = _render_changes(sphinx, kept_folder, built, meanwhile)
    return copy_site(rendered, staging / "html", (BUILD_INFO,))


def _render_changes(
    sphinx: SphinxProcess,
    folder: Path,
    built: BuiltPages,
    meanwhile: Callable[[], None] = lambda: None,
) -> Path:
    """Render what changed since the last render in a folder; return the folder of the pages."""
    before = read_state(sphinx.book, built)
    was_kept = prepare(folder, before)
    rendered = sphinx.render(folder, built.keeping(folder / STATES), meanwhile)
    if was_kept and not fit(folder):  # the state is gone, so this one starts from nothing
        with SphinxProcess(sphinx.book, sphinx.log) as another:
            return _render_changes(another, folder, built)
    keep(folder, before, read_state(sphinx.book, built))
    return rendered
