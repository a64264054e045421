"""Measure the course's commands against bare counterparts: `make bench`.

A row may have a limit for the ratio of its medians.

Environment: ROWS (names of rows, by default all) and RUNS (of each side, by default 3). It checks
the last commit out in `.cache/bench`, with the compiled kernels and the executed pages of this
checkout; uncommitted changes are not measured. The two sides of a row run in turn. Nothing else
should run on the machine. Exit status: 0 measured, 1 a command failed, 130 interrupted.
"""

import os
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from shlex import quote
from statistics import median

from robo_genesis.core import project
from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.command import run
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.pipeline.pages.folder import NOTEBOOK
from robo_genesis.pipeline.pages.store import folders
from robo_genesis.pipeline.worktree import environment, worktree

TREE = project.CACHE / "bench"
LONGEST = 300
"""Seconds until `make live` must show an edit."""
SETTINGS = ("RENDER", "JOBS", "SITE_URL", project.RENDER, project.BACKEND)
"""Further variables that would change a measured command."""

ROWS = {
    "unchanged": ("make book, nothing changed", "bare Sphinx", 1.5),
    "prose": ("make book, one page's prose edited", "bare Sphinx, kept doctrees", 1.5),
    "live": ("make live, until it serves an edit", "bare Sphinx, kept doctrees", 0.7),
    "verify": ("make verify", "start of Python, NumPy and pydantic", None),
    "lab": ("make execute, last lab, kernels compiled", "nbclient on its cells", 1.2),
    "jobs": ("make book, empty caches, JOBS=2", "the same with JOBS=1", None),
}
"""Name to the course's command, its bare counterpart, and the limit of the ratio of their medians,
None where the row has none."""

PYTHON = quote(sys.executable)
MAKE, LIVE = f"make PYTHON={PYTHON}", ["make", f"PYTHON={sys.executable}", "live"]
SPHINX = f"{PYTHON} -m sphinx -c bare book bare/html"
COLD = (  # without a site, there is work
    "rm -rf cold book/_build && mkdir cold && ln -s ../../npm cold && "
    f"JOBS={{}} {PYTHON} build_scripts/book.py --cache cold"
)
LAB = f"rm -rf warm/{project.STORE} && {PYTHON} build_scripts/execute.py --cache warm"
NBCLIENT = "import nbclient, nbformat, sys; nbclient.execute(nbformat.read(sys.argv[1], 4))"
BARE_CONFIG = """\
import yaml
extensions = ["myst_nb", "sphinx_external_toc", "sphinx_design", "sphinx_book_theme"]
extensions += ["robo_genesis.site.frame.executed"]  # reads the executed pages
html_theme = "sphinx_book_theme"
external_toc_path, external_toc_exclude_missing = "_toc.yml", True
exclude_patterns = ["_build*", "_decisions"]
myst_enable_extensions = yaml.safe_load(open("book/_config.yml"))["parse"]["myst_enable_extensions"]
"""


def shell(line: str, says: str = "", **variables: str) -> None:
    """Run a line of the shell in the worktree.

    Raises:
        ProjectError: it failed, or its output lacks the words `says`.
    """
    given = environment(TREE, *SETTINGS) | variables
    done = subprocess.run(line, shell=True, cwd=TREE, env=given, capture_output=True, text=True)
    if done.returncode or says not in done.stdout:
        output = "\n".join(f"{done.stdout}{done.stderr}".splitlines()[-15:])
        raise ProjectError(f"{line}: status {done.returncode}, expected {says!r} in:\n{output}")


def executed(page: Page) -> Path:
    """Return the folder of the last run of a page."""
    return folders(project.CACHE / project.STORE, page)[0]


def bare_sphinx() -> dict[str, str]:
    """Build the site, then its pages by bare Sphinx; return the variables that Sphinx needs."""
    shell(f"{MAKE} book && mkdir -p bare")
    (TREE / "bare" / "conf.py").write_text(BARE_CONFIG, "utf8")
    newest = {page.docname: executed(page) for page in find_pages(TREE / "book")}
    built = BuiltPages(folders=newest).write(TREE / "bare" / "executed-pages.json")
    shell(SPHINX, **built)
    return built


def add_sentence(page: Page) -> str:
    """Add a new sentence to a page, and return it."""
    sentence = f"Sentence {time.time_ns()}."
    page.path.write_text(f"{page.path.read_text('utf8')}\n\n{sentence}\n", "utf8")
    return sentence


def served(address: str, page: Page) -> None:
    """Edit a page and wait until an address has the new sentence."""
    sentence, end = add_sentence(page).encode(), time.monotonic() + LONGEST
    while sentence not in urllib.request.urlopen(address).read():
        if time.monotonic() > end:
            raise ProjectError(f"make live did not show {sentence!r} within {LONGEST} s.")
        time.sleep(0.02)


@contextmanager
def sides(name: str) -> Iterator[tuple[Callable[[], object], ...]]:
    """Prepare a row; give what runs the course's command, and what runs the bare counterpart."""
    page = [page for page in find_pages(TREE / "book") if page.page == "lab"][-1]
    if name == "unchanged":
        bare = partial(shell, SPHINX, "no targets are out of date", **bare_sphinx())
        yield partial(shell, f"{MAKE} book", "Nothing changed"), bare
    elif name == "prose":  # both sides see the same edit
        bare = partial(shell, SPHINX, "build succeeded", **bare_sphinx())
        yield lambda: add_sentence(page) and shell(f"{MAKE} book", "Pages: 0 executed"), bare
    elif name == "live":
        bare = partial(shell, SPHINX, "build succeeded", **bare_sphinx())
        given = environment(TREE, *SETTINGS) | {"PORT": "0"}
        with subprocess.Popen(LIVE, cwd=TREE, env=given, stdout=subprocess.PIPE, text=True) as live:
            try:
                lines = (line.split()[0] for line in live.stdout or () if line.startswith("http"))
                address = next(lines, "make live ended without an address: ")
                yield partial(served, f"{address}{page.docname}.html", page), bare
            finally:
                live.terminate()
    elif name == "verify":
        bare = partial(shell, f"{PYTHON} -c 'import numpy, pydantic'")
        yield partial(shell, f"{MAKE} verify"), bare
    elif name == "jobs":
        yield tuple(partial(shell, COLD.format(n), "executed, 0 reused") for n in (2, 1))
    else:
        shell("mkdir warm && ln -s ../../engine warm")
        course = partial(shell, LAB, PAGE=page.docname, TO="warm/exported")
        course()  # compiles what is not compiled yet
        notebook = quote(str(executed(page) / NOTEBOOK))
        compiled = project.engine_cache_environment(TREE)
        yield course, partial(shell, f'{PYTHON} -c "{NBCLIENT}" {notebook}', **compiled)


def seconds(side: Callable[[], object]) -> float:
    """Return the elapsed time of one side [s]."""
    begin = time.monotonic()
    side()
    return time.monotonic() - begin


def result(name: str, pairs: list[list[float]]) -> list[str]:
    """Return the lines of a row.

    Args:
        name: of the row.
        pairs: elapsed times of both sides [s].
    """
    *labels, limit = ROWS[name]
    sides = [*zip(*pairs, strict=True)]
    ratio = median(sides[0]) / median(sides[1])
    above = "ABOVE its limit" if limit and ratio > limit else "limit"
    lines = [f"{name}: ratio {ratio:.2f}, {above} {limit or 'none'}; min, median and max [s]:"]
    for label, side in zip(labels, sides, strict=True):
        lines.append(f"  {min(side):8.2f} {median(side):8.2f} {max(side):8.2f}  {label}")
    return lines


def measure() -> list[str]:
    """Measure the rows that ROWS names, RUNS times."""
    names = os.environ.get("ROWS", "").replace(",", " ").split() or [*ROWS]
    runs, lines = os.environ.get("RUNS") or "3", list[str]()
    if unknown := [name for name in names if name not in ROWS]:
        raise ProjectError(f"ROWS names {', '.join(unknown)}. Choices: {', '.join(ROWS)}.")
    if not (runs.isdecimal() and int(runs) > 0):
        raise ProjectError(f"RUNS={runs!r} is not valid. Give a number from 1.")
    with worktree(project.ROOT, TREE, project.CACHE):
        for name in names:
            print(f"{name}: preparation, then {runs} runs of each side", flush=True)
            with sides(name) as both:
                lines += result(name, [[*map(seconds, both)] for _ in range(int(runs))])
    return lines


if __name__ == "__main__":
    sys.exit(run(measure, "measured"))
