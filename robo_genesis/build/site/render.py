"""Render the book with Sphinx, from executed pages and nothing else.

A kept folder saves Sphinx from reading and writing unchanged pages; the site is the same.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.kernels import end_with_parent
from robo_genesis.build.page_results import ANSI
from robo_genesis.build.site.kept import copy_site, fit, keep, prepare, read_state
from robo_genesis.core.project import ROOT, ProjectError

COMMAND = """\
from robo_genesis.build.command import collect_rarely
collect_rarely()
from jupyter_book.cli.main import main
main()
"""
BUILD_INFO = ".buildinfo"
"""A note of Sphinx for its next build, which depends on the checkout's path."""
COMPLAINT = re.compile(r"WARNING|ERROR|CRITICAL|[Ee]rror:")


class RenderError(ProjectError):
    """Sphinx failed or warned; the message holds its complaints and the place of the log."""


def render(
    book: Path, staging: Path, built: BuiltPages, log: Path, kept_folder: Path | None = None
) -> Path:
    """Render every page of a book.

    Args:
        book: folder with `_config.yml`, `_toc.yml` and the pages.
        staging: folder for the result; its older content is removed.
        built: the executed pages.
        log: file for the output of Sphinx.
        kept_folder: has the doctrees and pages of the last render and gets those of this one. None
            renders from nothing.

    Returns:
        The folder with the site's HTML.

    Raises:
        RenderError: Sphinx failed or gave a warning.
    """
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(parents=True)
    log.parent.mkdir(parents=True, exist_ok=True)
    if kept_folder is None:
        rendered = run_sphinx(book, staging, built, log)
    else:
        rendered = _render_changes(book, kept_folder, built, log)
    return copy_site(rendered, staging / "html", (BUILD_INFO,))


def _render_changes(book: Path, folder: Path, built: BuiltPages, log: Path) -> Path:
    """Render what changed since the last render in a folder; return the folder of the pages."""
    before = read_state(book, built)
    was_kept = prepare(folder, before)
    rendered = run_sphinx(book, folder, built, log)
    if was_kept and not fit(folder):  # the state is gone, so this one starts from nothing
        return _render_changes(book, folder, built, log)
    keep(folder, before, read_state(book, built))
    return rendered


def run_sphinx(book: Path, folder: Path, built: BuiltPages, log: Path) -> Path:
    """Run Sphinx and return the folder with its pages.

    Args:
        book: see `render`.
        folder: of Sphinx's output. What is there is taken for current, unless Sphinx finds it
            outdated.
        built: the executed pages.
        log: file for the output of Sphinx.

    Raises:
        RenderError: Sphinx failed or gave a warning.
    """
    command = [sys.executable, "-c", COMMAND, "build", str(book), "--path-output", str(folder)]
    command += ["-n", "-W", "--keep-going", "--builder", "html"]
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        **built.write(folder / "executed-pages.json"),
    }
    with log.open("w", encoding="utf8") as stream:
        done = subprocess.run(
            command,
            env=environment,
            stdout=stream,
            stderr=subprocess.STDOUT,
            check=False,
            preexec_fn=end_with_parent(),
        )
    html = folder / "_build" / "html"
    if done.returncode != 0 or not (html / "index.html").is_file():
        raise RenderError(f"{_complaints(log)}\nThe complete log is in {log}")
    return html


def _complaints(log: Path) -> str:
    """Return the warnings and errors of a log, or its end where it names none."""
    lines = ANSI.sub("", log.read_text("utf8", errors="replace")).splitlines()
    found = list(dict.fromkeys(line for line in lines if COMPLAINT.search(line)))
    return "\n".join(found or lines[-20:])
