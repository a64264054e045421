"""Render the book with Sphinx, from executed pages and nothing else.

`site.frame.outdated` says what makes Sphinx read or write a page again.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from robo_genesis.core.project import (
    EXECUTED_PAGES,
    KEPT,
    PUBLISHED,
    ROOT,
    ProjectError,
)
from robo_genesis.core.text import ended
from robo_genesis.pipeline.command import end_with_parent
from robo_genesis.pipeline.pages.page_index import LAST_OUTPUTS, PageIndex

HTML, DOCTREES = "html", "doctrees"  # In the folder of a render
ENVIRONMENT = "environment.pickle"  # What Sphinx knows of all pages, in `DOCTREES`
GOOD = "good.pickle"  # The same after the last render that succeeded
EXECUTED = "executed-pages.json"  # Lists the executed pages, in the folder of a render
LOG = "render.log"  # In the folder of the caches


def render(book: Path, folder: Path, built: PageIndex, log: Path) -> Path:
    """Render the pages that changed since the last good render in a folder.

    Args:
        book: folder with `conf.py`, `_config.yml`, `_toc.yml` and the pages.
        folder: of Sphinx's output; an empty one renders all pages.
        built: the executed pages.
        log: gets what Sphinx prints.

    Returns:
        The folder of the pages.

    Raises:
        ProjectError: Sphinx failed or gave a warning; the message lists all of them.
    """
    html, doctrees = folder / HTML, folder / DOCTREES
    doctrees.mkdir(parents=True, exist_ok=True)
    # A render that failed or was killed has read pages that it has not written.
    (doctrees / ENVIRONMENT).unlink(missing_ok=True)
    if (doctrees / GOOD).is_file():
        shutil.copy(doctrees / GOOD, doctrees / ENVIRONMENT)
    variables = built.write(folder / EXECUTED)
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going"]
    command += ["-d", str(doctrees), str(book), str(html)]
    with log.open("w") as stream:
        done = subprocess.run(
            command,
            env=sphinx_environment(variables),
            stdout=stream,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=end_with_parent(),
        )
        stream.write(done.stderr)
    if done.returncode:
        complaints = dict.fromkeys(filter(str.strip, done.stderr.splitlines()))
        how = f"Sphinx stopped with {ended(done.returncode)}. Its log is in {log}"
        raise ProjectError("\n".join([*complaints, how]))
    shutil.copy(doctrees / ENVIRONMENT, doctrees / GOOD)
    return html


def live(port: int, book: Path, cache: Path) -> int:
    """Show a book on localhost while it is written, until Ctrl-C; return the exit status.

    It begins with the pages and runs of the last `make book`. A page whose code changed
    is shown with the outputs of its last run.

    Args:
        port: of localhost; 0 takes a free one.
        book: the folder of the pages.
        cache: the cache folder.

    Raises:
        ProjectError: the book was never built.
    """
    last, folder = cache / KEPT, cache / "live"
    if not (last / DOCTREES / GOOD).is_file():
        raise ProjectError("The book was not built yet. Build it: make book")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(last, folder)
    shutil.copy2(folder / DOCTREES / GOOD, folder / DOCTREES / ENVIRONMENT)
    variables = {EXECUTED_PAGES: str(last / EXECUTED), LAST_OUTPUTS: "1"}
    command = [sys.executable, "-m", "sphinx_autobuild", f"--port={port}"]
    command += [f"--watch={ROOT / 'robo_genesis'}", f"--watch={last / EXECUTED}"]
    command += [f"--ignore={book / PUBLISHED}", f"--ignore={book / f'.{PUBLISHED}.*'}"]
    command += ["-d", str(folder / DOCTREES), str(book), str(folder / HTML)]
    return subprocess.run(command, env=sphinx_environment(variables)).returncode


def sphinx_environment(variables: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of Sphinx with further variables."""
    return {**os.environ, **variables, "PYTHONPATH": str(ROOT)}
