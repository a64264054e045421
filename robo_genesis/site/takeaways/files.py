"""Files that a reader takes from a lab: notebooks, arrays with units, figures, the package.

The package is a wheel, built without the network: the same files give the same bytes.
"""

import os
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache, partial
from itertools import cycle
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
from nbformat import NotebookNode
from sphinx.config import Config

from robo_genesis.core import project
from robo_genesis.core.files import (
    NO_SOURCE,
    derived,
    files_below,
    files_digest,
    write_whole,
)
from robo_genesis.core.trace import TimeSeries
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.pipeline.command import output_of
from robo_genesis.pipeline.html.address import site_address
from robo_genesis.pipeline.pages import page_index
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.sources import PACKAGE
from robo_genesis.site.evidence.ledger_data import csv_bytes
from robo_genesis.site.evidence.values import measured

from .notebooks import (
    CHECK,
    executed_notebook,
    student_notebook,
)
from .plain_markdown import Writer

# Replaces in the student notebook a value that the site measured.
NOT_SHOWN = "*(your run measures it)*"

AXES = {
    "axis": ("x", "y", "z"),
    "wxyz": ("w", "x", "y", "z"),
    "finger": ("left", "right"),
}

# The field that holds the value before the first step, where it was read.
AT_REST = {"qd": "start_qd", "control_force": "start_control_force"}

# Packages of Debian that a fresh system lacks.
DEBIAN = "python3-venv libegl1 libgl1"

CONSTRAINTS = "constraints.txt"  # The lock, beside the wheel

SOURCES = ("pyproject.toml", "README.md", "LICENSE")
EPOCH = "315532800"  # 1980-01-01, the oldest time that a zip can hold

BUILD = "import sys; from setuptools import build_meta; print(build_meta.build_wheel(sys.argv[1]))"


def write_takeaways(page: Page, folder: Path, config: Config) -> dict[str, Any]:
    """Write everything that a reader takes from a lab; return what `box.md` names.

    Args:
        page: the lab, whose bundle of this build was accepted.
        folder: gets the wheel, the constraints, and a folder for the lab.
        config: of the book.
    """
    name = f"{page.lesson}-{page.page}"
    executed = page_index.executed_notebook(page.docname, page.notebook)
    run = page_index.page_bundle(f"{page.lesson}/{page.page}")
    own = folder / name
    shutil.rmtree(own, ignore_errors=True)
    own.mkdir(parents=True)
    wheel = build_wheel(folder)
    lock = project.ROOT / "requirements.lock"
    student, ran = own / f"{name}.ipynb", own / f"{name}-executed.ipynb"
    commands = run_commands(config.torch_index, student.name)
    origin = partial(origin_of, page, bundle.read_manifest(run), commands, config)
    needed = {
        project.ENGINE: project.engine_pin(),
        project.COURSE: package_facts()["version"],
    }
    check = CHECK.format(needed=needed, wheel=wheel.name)
    writer = writer_of(page.path, page.docname)
    hidden = replace(writer, measured=lambda _: NOT_SHOWN)
    _write(student, student_notebook(page, origin("student notebook"), check, hidden))
    _write(ran, executed_notebook(page, executed, origin("executed notebook"), writer))
    return {
        "student": student,
        "executed": ran,
        "wheel": wheel,
        "constraints": Path(shutil.copy(lock, folder / CONSTRAINTS)),
        "units": Path(shutil.copy(run / "arrays.json", own)),
        "arrays": [*_arrays(run, own)],  # (case, its CSV, its npz)
        "figures": [*_figures(page, executed, own)],
        "commands": commands,
    }


def writer_of(source: Path, docname: str) -> Writer:
    """Return the writer of a page's prose with the values of this build."""
    address = f"{site_address()}{docname}.html" if site_address() else ""
    return Writer(source.parent, lambda text: measured(*text.split(" ", 1))[0], address)


def run_commands(torch_index: str, notebook: str = "") -> tuple[str, ...]:
    """Return the commands that run a student notebook in an environment of its own.

    Args:
        torch_index: address of an index with builds of Torch for the CPU.
        notebook: file name of the notebook; all files are in the current folder.
    """
    packages = f"./{wheel_name()} jupyterlab"
    return (
        "python3 -m venv course",
        f"course/bin/pip install -c {CONSTRAINTS} {packages} \\\n"
        f"  --extra-index-url {torch_index}",
        f"course/bin/jupyter lab {notebook}".rstrip(),
    )


def system() -> str:
    """Return the system that the commands need."""
    python = package_facts()["requires-python"].replace(",", ", ")
    return f"Linux with Python {python} (Debian: `apt install {DEBIAN}` first)"


def wheel_name() -> str:
    """Return the name of the wheel's file."""
    return f"{PACKAGE}-{package_facts()['version']}-py3-none-any.whl"


def package_facts() -> dict[str, str]:
    """Return the `project` table of pyproject.toml."""
    return tomllib.loads((project.ROOT / "pyproject.toml").read_text("utf8"))["project"]


def origin_of(
    page: Page,
    ran: bundle.Manifest,
    commands: Iterable[str],
    config: Config,
    kind: str,
) -> str:
    """Return Markdown on the origin of a notebook of a lab, and how to run it."""
    lines = (line for cell in page.notebook.cells for line in cell.source.splitlines())
    title = next(line[2:] for line in lines if line.startswith("# "))
    console = "\n".join(commands)
    return (
        f"> {config.html_title}, *{title}*: {kind}. Written for Genesis "
        f"{project.engine_pin()}; the site shows run {ran.run_id[:8]} of {ran.started[:10]}.\n"
        f"> © {config.author}. Code: MIT licence. Text and figures: CC BY 4.0.\n\n"
        f"To run it on {system()}, put `{wheel_name()}` and `{CONSTRAINTS}` from the lab's page "
        f"beside it, and in that folder:\n\n```console\n{console}\n```"
    )


def _write(path: Path, notebook: NotebookNode) -> None:
    path.write_text(project.without_folders(nbformat.writes(notebook)) + "\n", "utf8")


def _arrays(run: Path, folder: Path) -> Iterator[tuple[str, Path, Path]]:
    """Copy each case's archive, and write it as a table; yield (case, CSV, npz)."""
    described = bundle.read_arrays(run)
    for case, arrays in described.cases.items():
        archive, table = folder / f"{case}.npz", folder / f"{case}.csv"
        shutil.copy(run / arrays.file, archive)
        trace = read_any_trace(run, described, case)
        table.write_text(csv_text(trace, described, case), "utf8", newline="")
        yield case, table, archive


def csv_text(trace: TimeSeries, described: bundle.Arrays, case: str) -> str:
    """Return a run as a table: one row per state, one column per number, units in the head.

    The first row is the state before any step. A quantity that is read only after a
    step is empty there. A quantity of the whole run is repeated in each row. Each
    number is the shortest text that reproduces the recorded value.
    """
    columns: dict[str, list[str]] = {}
    for field, (name, dims, *_) in trace.arrays().items():
        if field in AT_REST.values():
            continue
        labels = _labels(field, described.cases[case].variables[name], described)
        rows = _by_state(trace, field, dims)
        for label, column in zip(labels, zip(*rows, strict=True), strict=True):
            columns[label] = ["" if value is None else str(value) for value in column]
    return csv_bytes([list(columns), *zip(*columns.values(), strict=True)]).decode()


def _by_state(trace: TimeSeries, field: str, dims: Sequence[str]) -> list[Any]:
    """Return the numbers of a field at each state, None where nothing was read."""
    values = np.asarray(getattr(trace, field))
    if dims[0] not in ("state", "step"):
        return [values.ravel()] * len(trace.t)
    rows = list(values.reshape(len(values), -1))
    if dims[0] == "state":
        return rows
    at_rest = AT_REST.get(field)
    return [getattr(trace, at_rest) if at_rest else [None] * len(rows[0]), *rows]


def _labels(
    field: str, variable: bundle.Variable, described: bundle.Arrays
) -> list[str]:
    """Return the head of each column: field, environment, joint or link, axis and unit."""
    names = [field]
    for dim, size in zip(variable.dims, variable.shape, strict=True):
        if dim not in ("state", "step"):
            parts = described.coords.get(dim, AXES.get(dim)) or [
                f"{dim} {k}" for k in range(size)
            ]
            names = [f"{name} {part}" for name in names for part in parts]
    units = variable.unit if isinstance(variable.unit, list) else [variable.unit]
    return [f"{name} [{unit}]" for name, unit in zip(names, cycle(units), strict=False)]


def _figures(page: Page, executed: NotebookNode, folder: Path) -> Iterator[Path]:
    """Write each figure of a cell as SVG, under the name that the page gives it."""
    cells = [cell for cell in page.notebook.cells if cell.cell_type == "code"]
    for number, (cell, ran) in enumerate(zip(cells, executed.cells, strict=True), 1):
        for output in ran.outputs:
            drawn = output.get("data", {}).get("image/svg+xml")
            if drawn:
                figure = cell.metadata.get("mystnb", {}).get("figure", {})
                path = folder / f"{figure.get('name', f'figure-{number}')}.svg"
                path.write_text(drawn.strip(), "utf8")
                yield path


@cache
def build_wheel(folder: Path, root: Path = project.ROOT) -> Path:
    """Write the wheel and return its path; the labs of one site share it.

    Args:
        folder: gets the wheel.
        root: the checkout.

    Raises:
        ProjectError: setuptools failed; the message contains its output.
    """
    package = sorted(files_below(root / PACKAGE, left_out=NO_SOURCE))
    digest = files_digest(root, [*(root / source for source in SOURCES), *package])
    wheel = folder / wheel_name()
    write_whole(wheel, derived("wheel", [digest.encode()], lambda: built_wheel(root)))
    return wheel


def built_wheel(root: Path) -> bytes:
    """Return the content of the wheel; setuptools writes into a copy of the sources."""
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name)
        for source in SOURCES:
            shutil.copy(root / source, copy)
        ignored = shutil.ignore_patterns(*NO_SOURCE)
        shutil.copytree(root / PACKAGE, copy / PACKAGE, ignore=ignored)
        command = [sys.executable, "-c", BUILD, "."]
        settings = os.environ | {"SOURCE_DATE_EPOCH": EPOCH}
        failure = "The package's wheel cannot be built"
        printed = output_of(command, failure, cwd=copy, env=settings)
        return (copy / printed.splitlines()[-1]).read_bytes()
