"""Measure the course's commands against bare counterparts: `make bench`.

A row has a limit for the ratio of its medians. Above the limit, a line says where the time goes.

Environment: ROWS (names of rows, by default all) and RUNS (of each side, by default 3). It checks
the last commit out in `.cache/bench`, with the compiled kernels and the executed pages of this
checkout; uncommitted changes are not measured. The two sides of a row run in turn. Nothing else
should run on the machine. Exit status: 0 measured, 1 a command failed, 130 interrupted.
"""

import os
import re
import shutil
import statistics
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from itertools import pairwise

import nbformat
import yaml

from robo_genesis.core import project, tables
from robo_genesis.pipeline.command import run
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.pipeline.pages.store import folders
from robo_genesis.pipeline.worktree import environment, worktree

Sides = tuple[Callable[[], float], Callable[[], float]]
"""Run the course's command, or its bare counterpart, and return the elapsed time [s]."""

TREE = project.CACHE / "bench"
LONGEST = 300
"""Seconds until `make live` must show an edit."""
STAGE = re.compile(r"^\[ *([\d.]+) s\] (\w+)", re.MULTILINE)
"""A line of progress: seconds since the command began, and the stage."""
SETTINGS = ("RENDER", "JOBS", "SITE_URL", project.RENDER, project.BACKEND)
"""Further variables that would change a measured command."""

BARE_CONFIG = """\
extensions = ["myst_nb", "sphinx_external_toc", "sphinx_design", "sphinx_book_theme"]
extensions += ["robo_genesis.site.executed_pages"]  # reads the executed pages
html_theme = "sphinx_book_theme"
external_toc_path, external_toc_exclude_missing = "_toc.yml", True
exclude_patterns = ["_build*", "_decisions"]
myst_enable_extensions = {}
"""
NBCLIENT = "import nbclient, nbformat, sys; nbclient.execute(nbformat.read(sys.argv[1], 4))"


class BenchError(project.ProjectError):
    """A command failed or did other work than intended; the message says which and why."""


output = ""
"""What the measured command printed last."""
row_end = ExitStack()
"""Gets what has to be done after the last run of a row."""


def seconds(*command: str, says: str = "", **variables: str) -> float:
    """Run a command in the worktree, with more environment variables; return its duration [s].

    Raises:
        BenchError: it failed, or its output lacks the words `says`.
    """
    global output
    passed_on = environment(TREE, *SETTINGS) | variables
    begin = time.monotonic()
    done = subprocess.run(command, cwd=TREE, env=passed_on, capture_output=True, check=False)
    elapsed = time.monotonic() - begin
    output = (done.stdout + done.stderr).decode("utf8", "replace")
    if done.returncode or says not in output:
        raise BenchError(
            f"{' '.join(command)}: exit status {done.returncode}, expected 0 and the words "
            f"{says!r}. The output ends with:\n" + "\n".join(output.rstrip().splitlines()[-15:])
        )
    return elapsed


python = partial(seconds, sys.executable)
make = partial(seconds, "make", f"PYTHON={sys.executable}")


def last_lab() -> Page:
    """Return the last page of the book that is the lab of a lesson."""
    return [page for page in find_pages(TREE / "book") if page.page == "lab"][-1]


def bare_sphinx() -> Callable[..., float]:
    """Build the site, and its executed pages by bare Sphinx; return what repeats the latter."""
    make("book")
    book, folder, store = TREE / "book", TREE / "bare", project.CACHE / project.STORE
    folder.mkdir(exist_ok=True)
    newest = {page.docname: folders(store, page)[0] for page in find_pages(book)}
    built = BuiltPages(folders=newest).write(folder / "executed-pages.json")
    parse = yaml.safe_load((book / "_config.yml").read_text("utf8"))["parse"]
    (folder / "conf.py").write_text(BARE_CONFIG.format(parse["myst_enable_extensions"]), "utf8")
    command = ("-m", "sphinx", "-c", str(folder), str(book), str(folder / "html"))
    build = partial(python, *command, **built)
    build()
    return build


def unchanged() -> Sides:
    """Return builds where nothing changed."""
    bare = partial(bare_sphinx(), says="no targets are out of date")
    return partial(make, "book", says="Nothing changed"), bare


def prose() -> Sides:
    """Return builds after a sentence was added to one page; both sides see the same edit."""
    bare, page = bare_sphinx(), last_lab().path

    def edited() -> float:
        page.write_text(page.read_text("utf8") + "\n\nOne more sentence.\n", "utf8")
        return make("book", says="Pages: 0 executed")

    return edited, partial(bare, says="build succeeded")


def live() -> Sides:
    """Return the time from an edit until `make live` serves it, and builds by Sphinx."""
    bare, page = bare_sphinx(), last_lab()
    command, given = ("make", f"PYTHON={sys.executable}", "live"), environment(TREE, *SETTINGS)
    server = subprocess.Popen(
        command, cwd=TREE, env=given | {"PORT": "0"}, stdout=subprocess.PIPE, text=True
    )
    row_end.callback(server.wait)
    row_end.callback(server.terminate)  # called first
    address = served_at(server)

    def shown() -> float:
        sentence, begin = f"Sentence {time.time_ns()}.", time.monotonic()
        page.path.write_text(f"{page.path.read_text('utf8')}\n\n{sentence}\n", "utf8")
        while time.monotonic() - begin < LONGEST:
            with urllib.request.urlopen(f"{address}{page.docname}.html") as answer:
                if sentence in answer.read().decode():
                    return time.monotonic() - begin
            time.sleep(0.02)
        raise BenchError(f"make live did not show {sentence!r} within {LONGEST} s.")

    return shown, partial(bare, says="build succeeded")


def served_at(server: subprocess.Popen[str]) -> str:
    """Return the address that a server prints when it is ready.

    Raises:
        BenchError: the server ended before.
    """
    assert server.stdout is not None
    line = next((line for line in server.stdout if line.startswith("http")), None)
    if line is None:
        raise BenchError(f"make live ended with status {server.wait()}, expected an address.")
    return line.split()[0]


def verify() -> Sides:
    """Return the verification of all bundles, and a start of Python with its two packages."""
    return partial(make, "verify"), partial(python, "-c", "import numpy, pydantic")


def jobs() -> Sides:
    """Return builds that execute all pages and compile their kernels, two at once and in turn."""
    cache = TREE / "cold"

    def cold(number: str) -> float:
        for folder in (cache, TREE / "book" / "_build"):  # without a site, there is work
            shutil.rmtree(folder, ignore_errors=True)
        cache.mkdir()
        (cache / "npm").symlink_to(project.CACHE / "npm")
        command = ("build_scripts/book.py", "--cache", str(cache))
        return python(*command, says="executed, 0 reused", JOBS=number)

    return partial(cold, "2"), partial(cold, "1")


def lab() -> Sides:
    """Return executions of one lab with compiled kernels, by the course and by nbclient."""
    page, cache = last_lab(), TREE / "warm"
    cache.mkdir()
    (cache / "engine").symlink_to(project.CACHE / "engine")
    nbformat.write(page.notebook, cache / "lab.ipynb")
    compiled = project.engine_cache_environment(TREE)

    def anew() -> float:
        shutil.rmtree(cache / project.STORE, ignore_errors=True)
        where = {"PAGE": page.docname, "TO": str(cache / "exported")}
        return python("build_scripts/execute.py", "--cache", str(cache), **where)

    anew()  # compiles what is not compiled yet
    return anew, partial(python, "-c", NBCLIENT, str(cache / "lab.ipynb"), **compiled)


ROWS = {
    "unchanged": ("make book, nothing changed", "bare Sphinx", unchanged, 1.5),
    "prose": ("make book, one page's prose edited", "bare Sphinx, kept doctrees", prose, 1.5),
    "live": (
        "make live, until the page has a new sentence",
        "bare Sphinx, kept doctrees",
        live,
        0.7,
    ),
    "verify": ("make verify", "start of Python, NumPy and pydantic", verify, None),
    "lab": ("make execute, last lab, kernels compiled", "nbclient on its cells", lab, 1.2),
    "jobs": ("make book, empty caches, JOBS=2", "the same with JOBS=1", jobs, None),
}
"""Name to the course's command, its bare counterpart, what prepares both, and the limit of the
ratio, None where the row has none."""


def chosen(given: str) -> list[str]:
    """Return the rows that a list names, separated by spaces or commas; all if it is empty."""
    names = given.replace(",", " ").split()
    if unknown := [name for name in names if name not in ROWS]:
        raise BenchError(f"ROWS names {', '.join(unknown)}. Choices: {', '.join(ROWS)}.")
    return names or list(ROWS)


def ratio(pairs: Sequence[tuple[float, float]]) -> float:
    """Return the ratio of the medians of both sides."""
    course, bare = (statistics.median(side) for side in zip(*pairs, strict=True))
    return course / bare


def over_limit(name: str, pairs: Sequence[tuple[float, float]], printed: str) -> list[str]:
    """Return a line that says where the time goes, none if the row keeps its limit.

    Args:
        name: of the row.
        pairs: elapsed times of both sides [s].
        printed: what the command printed in its last run.
    """
    limit, found, starts = ROWS[name][3], ratio(pairs), dict[str, float]()
    if limit is None or found <= limit:
        return []
    for at, stage in STAGE.findall(printed):
        starts.setdefault(stage, float(at))
    spans = zip(starts, pairwise(starts.values()), strict=False)  # the last stage has no end
    where = ", ".join(f"{stage} {end - begin:.1f} s" for stage, (begin, end) in spans)
    where = where or "a command without stages"
    return [f"{name}: the ratio is {found:.2f}, the limit {limit}. The time goes into: {where}."]


def table(samples: Mapping[str, Sequence[tuple[float, float]]]) -> str:
    """Return a Markdown table with two lines a row: the command and its bare counterpart.

    Args:
        samples: by name of the row, pairs of elapsed times [s]. The ratio is that of the medians.
    """
    lines = []
    for name, pairs in samples.items():
        sides = list(zip(*pairs, strict=True))
        for label, side, shown in zip(
            ROWS[name][:2], sides, (f"{ratio(pairs):.2f}", ""), strict=True
        ):
            figures = {"min": min(side), "median": statistics.median(side), "max": max(side)}
            rounded = {f"{key} [s]": round(value, 2) for key, value in figures.items()}
            limit = (ROWS[name][3] or "") if shown else ""
            cells = {"row": name, "command": label} | rounded
            lines.append(cells | {"ratio": shown, "limit": limit})
    return tables.markdown(lines)


def measure() -> list[str]:
    """Measure the rows that ROWS names, RUNS times, and return the table."""
    names, runs = chosen(os.environ.get("ROWS") or ""), os.environ.get("RUNS") or "3"
    if not (runs.isdecimal() and int(runs) > 0):
        raise BenchError(f"RUNS={runs!r} is not valid. Give a number from 1.")
    samples: dict[str, list[tuple[float, float]]] = {}
    notes: list[str] = []
    with worktree(project.ROOT, TREE, project.CACHE):
        for name in names:
            print(f"{name}: preparation, then {runs} runs of each side", flush=True)
            with row_end:
                course, bare = ROWS[name][2]()
                samples[name], said = [], ""
                for _ in range(int(runs)):
                    elapsed, said = course(), output
                    samples[name].append((elapsed, bare()))
            notes += over_limit(name, samples[name], said)
    return [table(samples), *notes]


if __name__ == "__main__":
    sys.exit(run(measure, "measured"))
