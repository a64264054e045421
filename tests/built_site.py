"""Fixtures of the site that `make book` builds, and the lists of its pages."""

import gzip
import os
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING
from unittest.mock import patch

import pytest
from browsers import launched
from bs4 import BeautifulSoup

from robo_genesis.core.project import BOOK, CACHE, ROOT, STORE
from robo_genesis.lessons import LESSONS, find_lesson
from robo_genesis.pipeline.html.archive import ARCHIVE, FOLDER
from robo_genesis.pipeline.pages.book import find_pages, page_files
from robo_genesis.pipeline.pages.page_index import PageIndex
from robo_genesis.pipeline.pages.store import places, stored_result

if TYPE_CHECKING:
    from playwright.sync_api import Browser

PAGES = tuple(page_files(BOOK))  # Every page of the book in reading order

EXECUTED = {page.docname: (page.lesson, page.page) for page in find_pages(BOOK)}
LESSON_PAGES = {
    EXECUTED.get(name)
    or (Path(name).parent.name.partition("-")[0], Path(name).name): name
    for name in PAGES
    if name.startswith("lessons/")
}
"""The pages of lessons by lesson and page."""

# Lesson and page of each page that leaves a bundle.
MEASURING_PAGES = [(name, page) for name in LESSONS for page in find_lesson(name).pages]

TEXT = {
    ".html",
    ".css",
    ".js",
    ".json",
    ".svg",
    ".txt",
}  # The files that a web server compresses

# The environment of the tests. The engine sets switches when a test imports it, and a
# build with other switches would execute every page again.
OUTSIDE = dict(os.environ)


def executed_pages() -> PageIndex:
    """Return the executed pages from which the site was built."""
    pages = find_pages(BOOK)
    with patch.dict(os.environ, OUTSIDE, clear=True):
        into = places(pages, CACHE / STORE)
    results = [stored_result(page, into[page.docname]) for page in pages]
    absent = [
        page.docname for page, found in zip(pages, results, strict=True) if not found
    ]
    assert absent == [], "Not executed with this code. Run: make book"
    return PageIndex.of(results)


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *args) -> None:
        pass


@cache  # each page loads most files again
def compressed(data: bytes) -> bytes:
    return gzip.compress(data, compresslevel=6)


class CompressingHandler(QuietHandler):
    """Serves files as a web server does: text compressed."""

    def do_GET(self) -> None:
        path = Path(self.translate_path(self.path))
        if not path.is_file() or path.suffix not in TEXT:
            return super().do_GET()
        data = compressed(self.read(path))
        self.send_response(200)
        self.send_header("Content-Type", self.guess_type(path))
        self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def read(self, path: Path) -> bytes:
        """Return the content of a file of the site."""
        return path.read_bytes()


@pytest.fixture(scope="session")
def build_output() -> str:
    command = [sys.executable, str(ROOT / "build_scripts" / "book.py")]
    environment = OUTSIDE | {"RENDER": "1", "SITE_URL": "", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def site(build_output) -> Path:
    return BOOK / "_build" / "html"


@pytest.fixture(scope="session")
def unpacked(site, tmp_path_factory) -> Path:
    """The site as it is read from disk: out of its archive."""
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(site / ARCHIVE) as archive:
        archive.extractall(folder)
    return folder / FOLDER


def parsed(site: Path, name: str) -> BeautifulSoup:
    """Return a page of the site."""
    return BeautifulSoup((site / f"{name}.html").read_text(), "html.parser")


@pytest.fixture(scope="session")
def parsed_pages(site) -> dict[str, BeautifulSoup]:
    """Every page of the book by name, parsed once. No test may change them."""
    return {name: parsed(site, name) for name in PAGES}


@contextmanager
def served(site: Path, handler: type[QuietHandler] = QuietHandler) -> Iterator[str]:
    """Serve the site in a thread; the value is its address."""
    server = ThreadingHTTPServer(
        ("127.0.0.1", 0), partial(handler, directory=str(site))
    )
    Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()


@pytest.fixture(scope="session")
def address(site, tmp_path_factory) -> Iterator[str]:
    """The site's address in a folder of its server, as most schools publish a course."""
    root = tmp_path_factory.mktemp("server")
    (root / "course").symlink_to(site)
    with served(root) as address:
        yield f"{address}/course"


@pytest.fixture(scope="module")
def browser() -> Iterator["Browser"]:
    with launched() as browser:
        yield browser
