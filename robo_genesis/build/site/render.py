"""Render the book with Sphinx into a fresh folder, from executed pages and nothing else."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.kernels import end_with_parent
from robo_genesis.build.page_results import ANSI
from robo_genesis.core.project import ROOT, ProjectError

COMMAND = """\
from robo_genesis.build.command import collect_rarely
collect_rarely()
from jupyter_book.cli.main import main
main()
"""
COMPLAINT = re.compile(r"WARNING|ERROR|CRITICAL|[Ee]rror:")


class RenderError(ProjectError):
    """Sphinx failed or warned; the message holds its complaints and the place of the log."""


def render(book: Path, staging: Path, built: BuiltPages, log: Path) -> Path:
    """Render every page of a book.

    Args:
        book: folder with `_config.yml`, `_toc.yml` and the pages.
        staging: folder for the result; its older content is removed.
        built: the executed pages.
        log: file for the output of Sphinx.

    Returns:
        The folder with the site's HTML.

    Raises:
        RenderError: Sphinx failed or gave a warning.
    """
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(parents=True)
    log.parent.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-c", COMMAND, "build", str(book), "--path-output", str(staging)]
    command += ["-n", "-W", "--keep-going", "--all", "--builder", "html"]
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        **built.write(staging / "executed-pages.json"),
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
    html = staging / "_build" / "html"
    if done.returncode != 0 or not (html / "index.html").is_file():
        raise RenderError(f"{_complaints(log)}\nThe complete log is in {log}")
    return html


def _complaints(log: Path) -> str:
    """Return the warnings and errors of a log, or its end where it names none."""
    lines = ANSI.sub("", log.read_text("utf8", errors="replace")).splitlines()
    found = list(dict.fromkeys(line for line in lines if COMPLAINT.search(line)))
    return "\n".join(found or lines[-20:])
