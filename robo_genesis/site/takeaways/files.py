"""Files that a reader takes from a lab: notebooks, arrays with units, figures, the package.

The package is a wheel, built without the network: the same files give the same bytes.
"""

import os
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import nbformat
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
from robo_genesis.evidence import bundle
from robo_genesis.pipeline.command import output_of
from robo_genesis.pipeline.html.address import site_address
from robo_genesis.pipeline.html.archive import sums
from robo_genesis.pipeline.pages import page_index
from robo_genesis.pipeline.pages.book import Page, code_cells
from robo_genesis.pipeline.pages.sources import PACKAGE
from robo_genesis.site.evidence.values import measured
from robo_genesis.site.text.solutions import answer_left_out

from .notebooks import (
    CHECK,
    executed_notebook,
    student_notebook,
)
from .plain_markdown import Writer

# Replaces in the student notebook a value that the site measured.
NOT_SHOWN = "*(your run measures it)*"

# Packages of Debian that a fresh system lacks.
DEBIAN = "python3-venv libegl1 libgl1"

CONSTRAINTS = "constraints.txt"  # The lock, beside the wheel
LOCK = project.ROOT / "requirements.lock"

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
    found = {
        "student": student,
        "wheel": wheel,
        "constraints": Path(shutil.copy(LOCK, folder / CONSTRAINTS)),
        "commands": commands,
    }
    if answer_left_out(page.page):
        return found
    _write(ran, executed_notebook(page, executed, origin("executed notebook"), writer))
    return found | {
        "executed": ran,
        "units": Path(shutil.copy(run / "arrays.json", own)),
        "arrays": [*_arrays(run, own)],
        "figures": [*_figures(page, executed, own)],
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


def check_command(folder: Path) -> str:
    """Return the command that compares downloads with the wheel and the constraints of the site."""
    wheel = build_wheel(folder)
    files = ((wheel.name, wheel.read_bytes()), (CONSTRAINTS, LOCK.read_bytes()))
    return f"sha256sum --check <<< '{sums(files).decode().strip()}'"


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


def _arrays(run: Path, folder: Path) -> Iterator[Path]:
    """Copy the archive of each case, and yield the copy."""
    for case, arrays in bundle.read_arrays(run).cases.items():
        yield Path(shutil.copy(run / arrays.file, folder / f"{case}.npz"))


def _figures(page: Page, executed: NotebookNode, folder: Path) -> Iterator[Path]:
    """Write each figure of a cell as SVG, under the name that the page gives it."""
    pairs = zip(code_cells(page.notebook), executed.cells, strict=True)
    for number, (cell, ran) in enumerate(pairs, 1):
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
