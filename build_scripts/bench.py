"""Measure the course's commands against bare counterparts: `make bench`.

| row | the course's command | bare counterpart |
|---|---|---|
| unchanged | `make book`, nothing changed | Sphinx with kept doctrees |
| prose | `make book`, one page's prose edited | the same |
| live | `make live`, until it serves an edit | the same |
| lab | `make execute` of the last lab, kernels compiled | nbclient on its cells |

Environment: ROWS (names of rows, by default all) and RUNS (of each side, by default 3).
    It checks
the last commit out in `.cache/bench`, with the compiled kernels and the executed pages
of this checkout; uncommitted changes are not measured. The two sides of a row run in
turn. Nothing else should run on the machine. Exit status: 0 measured, 1 a command
failed, 130 interrupted.
"""

import os
import subprocess
import sys
import time
from contextlib import ExitStack
from functools import partial
from shlex import quote
from statistics import median
from timeit import timeit
from urllib.request import urlopen

from robo_genesis.core import project
from robo_genesis.pipeline.command import output_of, positive, run
from robo_genesis.pipeline.fresh_checkout import (
    CHECKOUT,
    SETTINGS,
    environment,
    fresh_checkout,
)
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.pipeline.pages.folder import NOTEBOOK
from robo_genesis.pipeline.pages.store import folders

# The limit of the ratio of medians, by the name of the row.
LIMITS = {"unchanged": 1.5, "prose": 1.5, "live": 0.7, "lab": 1.2}

FOLDER, STORE = project.CACHE / "bench", project.CACHE / project.STORE
TREE = FOLDER / CHECKOUT
VARIABLES = environment(TREE, *SETTINGS)
PYTHON = quote(sys.executable)
MAKE = f"make PYTHON={PYTHON}"
SPHINX = f"{PYTHON} -m sphinx -c bare book bare/html"
LAB = f"rm -rf warm/{project.STORE} && {PYTHON} build_scripts/execute.py --cache warm"
NBCLIENT = (
    "import nbclient, nbformat, sys; nbclient.execute(nbformat.read(sys.argv[1], 4))"
)
BARE_CONFIG = """\
import yaml
extensions = ["myst_nb", "sphinx_external_toc", "sphinx_design", "sphinx_book_theme"]
extensions += ["robo_genesis.site.frame.executed"]  # reads the executed pages
external_toc_path, external_toc_exclude_missing = "_toc.yml", True
html_theme, exclude_patterns = "sphinx_book_theme", ["_build*", "_decisions"]
parse = yaml.safe_load(open("../book/_config.yml"))["parse"]
myst_enable_extensions = parse["myst_enable_extensions"]
"""


def shell(line: str, says: str = "", **variables: str) -> None:
    """Run a line of the shell in the checkout.

    Raises:
        ProjectError: it failed, or its output lacks the words `says`.
    """
    said = output_of(["sh", "-c", line], line, cwd=TREE, env=VARIABLES | variables)
    if says not in said:
        raise project.ProjectError(f"{line}: {says!r} expected in:\n{said}")


def bare_sphinx() -> partial[None]:
    """Build the site, then its pages by bare Sphinx; return what runs bare Sphinx again."""
    shell(f"{MAKE} book && mkdir -p bare")
    (TREE / "bare" / "conf.py").write_text(BARE_CONFIG, "utf8")
    newest = {
        page.docname: folders(STORE, page)[0] for page in find_pages(TREE / "book")
    }
    built = BuiltPages(folders=newest).write(TREE / "bare" / "executed-pages.json")
    shell(SPHINX, **built)
    return partial(shell, SPHINX, **built)


def add_sentence(page: Page) -> str:
    """Add a new sentence to a page, and return it."""
    sentence = f"Sentence {time.time_ns()}."
    page.path.write_text(f"{page.path.read_text('utf8')}\n\n{sentence}\n", "utf8")
    return sentence


def build_edited(page: Page) -> None:
    """Edit a page and build the site."""
    add_sentence(page)
    shell(f"{MAKE} book", "Pages: 0 executed")


def serve_edited(page: Page, address: str) -> None:
    """Edit a page and wait until an address has the new sentence."""
    sentence = add_sentence(page).encode()
    for _ in range(3000):  # at least a minute
        if sentence in urlopen(address).read():
            return
        time.sleep(0.02)
    raise project.ProjectError("make live does not serve an edit within a minute.")


def sides(name: str, started: ExitStack) -> tuple[partial[None], partial[None]]:
    """Prepare a row; return what runs the course's command, and what runs the bare counterpart.

    Args:
        name: of the row.
        started: ends, after the row, what the preparation starts.
    """
    page = [page for page in find_pages(TREE / "book") if page.page == "lab"][-1]
    if name == "lab":
        shell(f"mkdir warm && ln -s ../.cache/{project.COMPILED} warm")
        course = partial(shell, LAB, PAGE=page.docname, TO="warm/exported")
        course()  # compiles what is not compiled yet
        notebook = quote(str(folders(STORE, page)[0] / NOTEBOOK))
        compiled = project.engine_cache_environment(TREE)
        return course, partial(
            shell, f'{PYTHON} -c "{NBCLIENT}" {notebook}', **compiled
        )
    bare = bare_sphinx()
    if name == "unchanged":
        return partial(shell, f"{MAKE} book", "Nothing changed"), bare
    if name == "prose":  # both sides see the same edit
        return partial(build_edited, page), bare
    command, given = (
        ["make", f"PYTHON={sys.executable}", "live"],
        VARIABLES | {"PORT": "0"},
    )
    live = subprocess.Popen(
        command, cwd=TREE, env=given, stdout=subprocess.PIPE, text=True
    )
    started.enter_context(live)
    started.callback(live.terminate)
    address = next(
        line.split()[0] for line in live.stdout or () if line.startswith("http")
    )
    return partial(serve_edited, page, f"{address}{page.docname}.html"), bare


def result(name: str, pairs: list[list[float]]) -> str:
    """Return a row with the times of all its runs.

    Args:
        name: of the row.
        pairs: elapsed times of the course's command and of its bare counterpart [s].
    """
    sides = [sorted(times) for times in zip(*pairs, strict=True)]
    ratio, limit = median(sides[0]) / median(sides[1]), LIMITS[name]
    course, bare = (" ".join(f"{time:.2f}" for time in times) for times in sides)
    above = "ABOVE its " * (ratio > limit)
    return f"{name}: ratio {ratio:.2f}, {above}limit {limit}; course {course} s, bare {bare} s"


def measured(name: str, runs: int) -> str:
    """Measure a row and return its result."""
    print(f"{name}: preparation, then {runs} runs of each side", flush=True)
    with ExitStack() as started:
        both = sides(name, started)
        return result(
            name, [[timeit(side, number=1) for side in both] for _ in range(runs)]
        )


def measure() -> list[str]:
    """Measure the rows that ROWS names, RUNS times."""
    names = os.environ.get("ROWS", "").replace(",", " ").split() or [*LIMITS]
    runs = positive("RUNS", 3)
    if unknown := [name for name in names if name not in LIMITS]:
        raise project.ProjectError(
            f"ROWS names {unknown}. Choices: {', '.join(LIMITS)}."
        )
    with fresh_checkout(project.ROOT, FOLDER, project.CACHE):
        return [measured(name, runs) for name in names]


if __name__ == "__main__":
    sys.exit(run(measure, "measured"))
