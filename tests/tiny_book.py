"""Tiny books for the tests of the build: pages that run in a second, without the engine."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import yaml

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.evidence.bundle import sha256
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.command import TIMEOUT
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.execute import execute_pages
from robo_genesis.pipeline.pages.results import PageResult
from robo_genesis.pipeline.pages.store import places

FRONT = "---\nfile_format: mystnb\nkernelspec: {{name: python3}}\n{front}---\n# {title}\n\nPage.\n"
CELL = "\n```{{code-cell}}\n{options}{code}\n```\n"

# A lab's cell that leaves the least that counts as a bundle of this run.
WRITE_BUNDLE = """\
import json, os, pathlib
folder = pathlib.Path(os.environ["ROBO_GENESIS_OUTPUTS_DIR"], "l04", "lab", "cpu")
folder.mkdir(parents=True)
manifest = {"run_id": os.environ["ROBO_GENESIS_RUN_ID"]}
(folder / "manifest.json").write_text(json.dumps(manifest))"""

# A cell that leaves what a recording looks at, as if it had run on this backend.
RECORDED_LAB = """\
import json, os, pathlib
asked, actual = os.environ["ROBO_GENESIS_BACKEND"], {actual!r}
folder = pathlib.Path(os.environ["ROBO_GENESIS_OUTPUTS_DIR"], "l04", "lab", actual)
folder.mkdir(parents=True)
camera = os.environ["ROBO_GENESIS_RENDER"] == "1"
facts = dict(
    lesson="l04",
    page="lab",
    run_id=os.environ["ROBO_GENESIS_RUN_ID"],
    command=os.environ["ROBO_GENESIS_COMMAND"],
    backend=dict(requested=asked, actual=actual, device_name="a device", torch_version="2.13.0"),
    engine=dict(version="1.2.3", quadrants_version="0.9"),
    render=dict(mode="camera" if camera else "skip", renderer="llvmpipe", software=True),
    checks=[dict(passed=True), dict(passed=True)],
    passed="2 of 2",
    warnings=["Approximating tendon."],
    git=dict(commit="0123456789abcdef", dirty=True),
)
(folder / "manifest.json").write_text(json.dumps(facts))
(folder / "log.txt").write_text("new")"""

LAB_FRONT = "robo_genesis: {lesson: l04, page: lab}\n"


def cell(code: str, options: str = "") -> str:
    """Return one code cell; options are lines like ':tags: [a]'."""
    return CELL.format(code=code, options=options)


def paragraphs(*texts: str) -> str:
    """Return paragraphs and blocks of a page with an empty line between them."""
    return "\n\n".join(texts) + "\n"


def raising(code: str, expects: str | None) -> str:
    """Return a cell tagged raises-exception."""
    says = f':expects: "{expects}"\n' if expects else ""
    return cell(code, f":tags: [raises-exception]\n{says}")


def notebook(*cells: str, front: str = "", title: str = "Page") -> str:
    """Return the text of an executed page."""
    return FRONT.format(front=front, title=title) + "".join(cells)


def lab(actual: str, more: str = "") -> str:
    """Return a lab that can be recorded, and ends with more code."""
    return notebook(cell(RECORDED_LAB.format(actual=actual) + more), front=LAB_FRONT)


def run_pages(pages: list[Page], folder: Path, **settings: Any) -> list[PageResult]:
    """Execute pages into the store of a folder; return their results."""
    settings = {
        "seconds": {},
        "jobs": 1,
        "timeout": TIMEOUT,
        "environment": {},
        "logs": folder / "logs",
        "say": Mock(),
        "accept": Mock(),
        **settings,
    }
    return execute_pages(pages, places(pages, folder / "store"), **settings)


def accept(folder: Path) -> SimpleNamespace:
    """Replace the verification of evidence, which needs the engine's records."""
    text = (folder / "manifest.json").read_text()
    return json.loads(text, object_hook=lambda fields: SimpleNamespace(**fields))


def refuse(folder: Path) -> SimpleNamespace:
    raise BundleRefused(
        "metrics", "metrics.json g1.rise_time is not what the arrays say."
    )


def make_book(folder: Path, **pages: str) -> Path:
    """Write a book with a home page, the given pages and the course's own configuration."""
    book = folder / "book"
    book.mkdir(parents=True, exist_ok=True)
    (book / "index.md").write_text("# Home\n\nWelcome.\n")
    for name, text in pages.items():
        (book / f"{name}.md").write_text(text)
    chapters = [{"file": name} for name in pages]
    toc = {"format": "jb-book", "root": "index", "chapters": chapters}
    (book / "_toc.yml").write_text(yaml.safe_dump(toc))
    for name in ("conf.py", "_config.yml"):
        shutil.copy(BOOK / name, book)
    shutil.copytree(BOOK / "_static", book / "_static", dirs_exist_ok=True)
    return book


def contents(folder: Path) -> dict[str, bytes]:
    """Return all files of a folder."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def old_site(book: Path) -> Path:
    """Publish an old site and return a file of it that a failed build must leave alone."""
    marker = book / "_build" / "html" / "index.html"
    marker.parent.mkdir(parents=True)
    marker.write_text("the old site")
    return marker


def old_bundle(folder: Path, backend: str) -> Path:
    """Put an older bundle in place and return a file that a refused recording must leave."""
    place = folder / "kept" / "l04" / backend
    place.mkdir(parents=True)
    (place / "manifest.json").write_text("{}")
    (place / "log.txt").write_text("old")
    (place / "of the old one.txt").touch()
    return place / "log.txt"


def start(
    command: str, folder: Path, *more: str, own_group: bool = False
) -> subprocess.Popen[str]:
    """Start a command on a folder's tiny book, with more arguments.

    In a process group of its own, it can be sent what a terminal sends on Ctrl-C.
    """
    places = ["--book", str(folder / "book"), "--cache", str(folder / "cache")]
    return subprocess.Popen(
        [sys.executable, "-m", "robo_genesis", command, *places, *more],
        process_group=0 if own_group else None,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )


def fails(command: str, folder: Path, *more: str) -> str:
    """Run a command on a folder's tiny book that ends with status 1; return its report."""
    process = start(command, folder, *more)
    _, report = process.communicate(timeout=120)
    assert process.returncode == 1, report
    assert "Traceback" not in report
    return report


def wait(process: subprocess.Popen[str], *files: Path) -> None:
    """Wait until a process, or what it started, has written to each of these files."""
    end = time.monotonic() + 60
    while not all(path.exists() and path.read_text() for path in files):
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.05)


def git(root: Path, *words: str) -> str:
    """Return what git prints in a folder, where it can commit."""
    settings = {"user.name": "a", "user.email": "a@b", "commit.gpgsign": "false"}
    given = [word for item in settings.items() for word in ("-c", "=".join(item))]
    command = ["git", "-C", str(root), *given, *words]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def commit(root: Path) -> None:
    """Commit everything in a folder, which becomes a repository."""
    git(root, "init", "--quiet")
    git(root, "add", ".")
    git(root, "commit", "--quiet", "--message", "a")


def seal(place: Path) -> None:
    """Make the digests of an executed page's record right again."""
    record = json.loads((place / "page.json").read_text())
    files = [
        path
        for path in place.rglob("*")
        if path.is_file() and path != place / "page.json"
    ]
    record["files"] = {
        path.relative_to(place).as_posix(): sha256(path) for path in files
    }
    (place / "page.json").write_text(json.dumps(record))
