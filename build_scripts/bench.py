"""Measure the course's commands against bare counterparts: `make bench`.

A row has a limit for the ratio of its medians. Above the limit, the stages of the slow command are
printed.

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

Side = Callable[[], str]
"""Does the work that is measured, and returns what was printed."""

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
MAKE = f"make PYTHON={PYTHON}"
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
extensions += ["robo_genesis.site.executed_pages"]  # reads the executed pages
html_theme = "sphinx_book_theme"
external_toc_path, external_toc_exclude_missing = "_toc.yml", True
exclude_patterns = ["_build*", "_decisions"]
myst_enable_extensions = yaml.safe_load(open("book/_config.yml"))["parse"]["myst_enable_extensions"]
"""


def shell(line: str, says: str = "", **variables: str) -> str:
    """Run a line of the shell in the worktree and return what it printed.

    Raises:
        ProjectError: it failed, or its output lacks the words `says`.
    """
    given, out = environment(TREE, *SETTINGS) | variables, subprocess.PIPE
    done = subprocess.run(
        line, shell=True, cwd=TREE, env=given, stdout=out, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode or says not in done.stdout:
        raise ProjectError(
            f"{line}: exit status {done.returncode}, expected 0 and the words {says!r}. The output "
            "ends with:\n" + "\n".join(done.stdout.splitlines()[-15:])
        )
    return done.stdout


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


@contextmanager
def live() -> Iterator[str]:
    """Run `make live`, and give the address that it prints when it is ready."""
    given = environment(TREE, *SETTINGS) | {"PORT": "0"}
    command = ["make", f"PYTHON={sys.executable}", "live"]
    with subprocess.Popen(
        command, cwd=TREE, env=given, stdout=subprocess.PIPE, text=True
    ) as server:
        try:
            lines = (line.split()[0] for line in server.stdout or () if line.startswith("http"))
            yield next(lines, "make live ended without an address: ")
        finally:
            server.terminate()


def served(address: str, page: Page) -> str:
    """Edit a page and wait until the server has the new sentence."""
    sentence, end = add_sentence(page), time.monotonic() + LONGEST
    while time.monotonic() < end:
        with urllib.request.urlopen(f"{address}{page.docname}.html") as answer:
            if sentence in answer.read().decode():
                return ""
        time.sleep(0.02)
    raise ProjectError(f"make live did not show {sentence!r} within {LONGEST} s.")


@contextmanager
def sides(name: str) -> Iterator[tuple[Side, Side]]:
    """Prepare a row; give what runs the course's command, and what runs the bare counterpart."""
    page = [page for page in find_pages(TREE / "book") if page.page == "lab"][-1]
    if name in ("unchanged", "prose", "live"):
        built, done = bare_sphinx(), "no targets are out of date"
        bare = partial(shell, SPHINX, done if name == "unchanged" else "build succeeded", **built)
    if name == "unchanged":
        yield partial(shell, f"{MAKE} book", "Nothing changed"), bare
    elif name == "prose":  # both sides see the same edit
        yield lambda: add_sentence(page) and shell(f"{MAKE} book", "Pages: 0 executed"), bare
    elif name == "live":
        with live() as address:
            yield partial(served, address, page), bare
    elif name == "verify":
        bare = partial(shell, f"{PYTHON} -c 'import numpy, pydantic'")
        yield partial(shell, f"{MAKE} verify"), bare
    elif name == "jobs":
        one, two = (partial(shell, COLD.format(n), "executed, 0 reused") for n in (1, 2))
        yield two, one
    else:
        shell("mkdir warm && ln -s ../../engine warm")
        course = partial(shell, LAB, PAGE=page.docname, TO="warm/exported")
        course()  # compiles what is not compiled yet
        notebook = quote(str(executed(page) / NOTEBOOK))
        compiled = project.engine_cache_environment(TREE)
        yield course, partial(shell, f'{PYTHON} -c "{NBCLIENT}" {notebook}', **compiled)


def seconds(side: Side) -> tuple[float, str]:
    """Return the elapsed time [s] of one side, and what was printed."""
    begin = time.monotonic()
    said = side()
    return time.monotonic() - begin, said


def result(name: str, pairs: list[tuple[float, float]], said: str) -> list[str]:
    """Return the lines of a row, and the stages of its command if it is above its limit.

    Args:
        name: of the row.
        pairs: elapsed times of both sides [s].
        said: what the course's command printed in its last run.
    """
    *labels, limit = ROWS[name]
    sides = [*zip(*pairs, strict=True)]
    ratio = median(sides[0]) / median(sides[1])
    lines = [f"{name}: ratio {ratio:.2f}, limit {limit or 'none'}; min, median and max [s]:"]
    for label, side in zip(labels, sides, strict=True):
        lines.append(f"  {min(side):8.2f} {median(side):8.2f} {max(side):8.2f}  {label}")
    if limit and ratio > limit:
        lines += ["  Above the limit. The time goes into:"]
        lines += [f"    {line}" for line in said.splitlines() if line.startswith("[")]
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
                found = [[seconds(side) for side in both] for _ in range(int(runs))]
            lines += result(name, [(a[0], b[0]) for a, b in found], found[-1][0][1])
    return lines


if __name__ == "__main__":
    sys.exit(run(measure, "measured"))
