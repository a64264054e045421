"""`make live` on a tiny book: what the browser gets after good and bad edits."""

import os
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from contextlib import suppress
from pathlib import Path

import psutil
import pytest
import tiny_book
from checkout import copy_checkout
from small_book import as_executed
from tiny_book import cell, fails, make_book, notebook, start

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import STORE
from robo_genesis.pipeline.html import live as live_module
from robo_genesis.pipeline.html.live import Live, LiveEndedError
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.store import places

TEXT = "# Text\n\nFirst words.\n"
SYNTAX_ERROR = "def f(:"
MODULES = "../robo_genesis"
PRINTS = "from robo_genesis.core.printed import WORDS\nprint(WORDS)"


class Running:
    """A running `make live` on a folder's book; without EXECUTE=1, its executed page was run."""

    def __init__(self, folder: Path, code: str = "1", **settings: str):
        self.book, self.folder = (
            make_book(folder, text=TEXT, page=notebook(cell(code))),
            folder,
        )
        if "EXECUTE" not in settings:
            place = places(find_pages(self.book), folder / "cache" / STORE)["page"]
            run_of(folder / "other", place, code)
        self.process = start("live.py", folder, PORT="0", **settings)
        os.set_blocking(self.process.stdout.fileno(), False)
        self.said = ""
        self.wait(lambda: "Ctrl-C ends it." in self.output())
        self.address = self.said.split("Ctrl-C")[0].split()[-1]

    def output(self) -> str:
        with suppress(BlockingIOError):
            self.said += os.read(self.process.stdout.fileno(), 2**16).decode()
        return self.said

    def wait(self, condition) -> None:
        end = time.monotonic() + 120
        while not condition():
            assert self.process.poll() is None, self.process.stderr.read()
            assert time.monotonic() < end, self.output()
            time.sleep(0.05)

    def shown(self, page: str = "text.html") -> str:
        with urllib.request.urlopen(self.address + page) as answer:
            return answer.read().decode()

    def article(self, page: str = "text.html") -> str:
        return self.shown(page).partition("<article")[2]

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    running = Running(tmp_path_factory.mktemp("live"))
    yield running
    running.end()


@pytest.fixture(scope="module")
def executing(tmp_path_factory):
    """With EXECUTE=1, from a copy of the course, whose modules a test may change."""
    course = copy_checkout(tmp_path_factory.mktemp("course"))
    (course / "robo_genesis/core/printed.py").write_text("WORDS = 'printed words'\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tiny_book, "ROOT", course)
        patch.chdir(course)  # first in the path of `python -m`
        running = Running(course / "tiny", PRINTS, EXECUTE="1")
    yield running
    running.end()


def test_a_changed_page_is_shown_and_nothing_is_published(live):
    assert "live-reload" in live.shown()
    (live.book / "text.md").write_text(TEXT + "\nMore words.\n")
    live.wait(lambda: "More words." in live.shown())
    assert not (live.book / "_build").exists()


@pytest.mark.parametrize(
    ("file", "content", "said"),
    [
        ("text.md", TEXT + "\n{doc}`nowhere`\n", "nowhere"),
        ("text.md", "---\na: [\n---\n" + TEXT, "text"),
        ("_toc.yml", "root: [", "_toc.yml:1: it cannot be read"),
        ("page.md", notebook(cell(SYNTAX_ERROR)), "page.md:10: SyntaxError: "),
    ],
    ids=["link", "front matter", "broken contents", "code"],
)
def test_a_bad_edit_is_reported_and_the_last_good_state_stays(
    live, file, content, said
):
    path, before = live.book / file, live.article()
    good, begin = path.read_text(), len(live.output())
    write_whole(path, content.encode())  # at once, so that no half of it is seen
    live.wait(lambda: "keeps the last good state" in live.output()[begin:])
    assert said in live.said[begin:]
    assert len(live.said[begin:].splitlines()) <= 4
    assert live.article() == before
    write_whole(path, good.encode())
    live.wait(lambda: "Shown: " in live.output()[begin:])
    assert live.article() == before


@pytest.mark.parametrize(
    ("where", "file", "content", "said"),
    [
        ("live", "book/page.md", notebook(cell("1 / 0")), "EXECUTE=1 runs it"),
        ("executing", "book/page.md", notebook(cell("1 / 0")), "line 10: 1 / 0\n"),
        (
            "executing",
            f"{MODULES}/core/printed.py",
            SYNTAX_ERROR,
            "(printed.py, line 1)",
        ),
        (
            "executing",
            f"{MODULES}/pipeline/html/sphinx_process.py",
            SYNTAX_ERROR,
            "Sphinx stopped",
        ),
    ],
    ids=["cell", "executed cell", "module of a page", "module of the site"],
)
def test_after_an_error_in_code_the_last_outputs_are_shown(
    request, where, file, content, said
):
    live = request.getfixturevalue(where)
    path, before, begin = (
        live.folder / file,
        live.article("page.html"),
        len(live.output()),
    )
    good, last = (
        path.read_text(),
        "Shown: " if "Sphinx" not in said else "keeps the last good",
    )
    assert ("printed words" in before) == (where == "executing")
    write_whole(path, content.encode())
    live.wait(lambda: last in live.output()[begin:].partition(said)[2])
    shown, begin = live.article("page.html"), len(live.said)
    assert (shown != before) == (path.suffix == ".md")
    assert ("printed words" in shown) == (where == "executing")
    write_whole(path, good.encode())
    live.wait(lambda: "Shown: " in live.output()[begin:])
    assert live.article("page.html") == before


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_end_by_signal_leaves_no_process(tmp_path, sent):
    running = Running(tmp_path)
    below = psutil.Process(running.process.pid).children(recursive=True)
    assert below
    running.process.send_signal(sent)
    _, report = running.process.communicate(timeout=30)
    assert running.process.returncode == 130
    assert "Traceback" not in report
    assert psutil.wait_procs(below, timeout=15)[1] == []


def test_invalid_settings_are_refused(tmp_path):
    report = fails("live.py", make_book(tmp_path).parent, PORT="none")
    assert "PORT='none' is not valid" in report


def test_a_second_server_with_the_same_cache_is_refused_with_the_process(live):
    report = fails("live.py", live.folder, PORT="0")
    assert f"Another make live runs here (process {live.process.pid})" in report


def test_sphinx_is_started_again_after_it_was_killed(live):
    children = psutil.Process(live.process.pid).children()
    for child in children:
        child.kill()
    # Until its child has ended, the process of make live would give it the next order.
    live.wait(
        lambda: all(
            c.status() == psutil.STATUS_ZOMBIE for c in children if c.is_running()
        )
    )
    (live.book / "text.md").write_text(TEXT + "\nWords after the kill.\n")
    live.wait(lambda: "Words after the kill." in live.shown())


def run_of(folder: Path, place: Path, code: str) -> None:
    """Store a run of the page `page` with other code."""
    [page] = find_pages(make_book(folder, page=notebook(cell(code))))
    as_executed(page, place, [1.0])


@pytest.fixture
def said(monkeypatch) -> list[str]:
    """The lines that are printed."""
    lines: list[str] = []
    monkeypatch.setattr(live_module, "say", lines.append)
    return lines


@pytest.mark.parametrize(
    ("stored", "shown"),
    [
        ({}, None),
        ({"a": "2"}, "a"),
        ({"a": "1", "b": "2"}, "a"),
        ({"a": "3", "b": "2"}, "b"),
        ({"a": "1", "here": "1", "b": "1"}, "here"),
    ],
    ids=["nothing", "other code", "its code, older", "the newest", "nothing changed"],
)
def test_the_run_of_the_same_code_is_shown_and_else_the_newest(
    said, tmp_path, stored, shown
):
    book = make_book(tmp_path, page=notebook(cell("1")))
    pages = find_pages(book)
    place = places(pages, tmp_path / "cache" / STORE)["page"]
    for second, (name, code) in enumerate(stored.items()):
        folder = place if name == "here" else place.with_name(name)
        run_of(tmp_path / "other", folder, code)
        os.utime(folder, (second, second))
    found = Live(book, tmp_path / "cache").built(pages).folders.get("page")
    assert (found and ("here" if found == place else found.name)) == shown
    assert ["EXECUTE=1 runs it" in line for line in said] == [True] * (shown != "here")


def test_a_page_that_fails_is_reported_once_and_its_last_run_is_shown(said, tmp_path):
    book = make_book(tmp_path, page=notebook(cell("a = 1\nraise OSError('no robot')")))
    pages = find_pages(book)
    last = tmp_path / "cache" / STORE / "page" / "last"
    run_of(tmp_path / "other", last, "2")
    live = Live(book, tmp_path / "cache", execute=True)
    assert [live.built(pages).folders for _ in range(2)] == [{"page": last}] * 2
    begin, report, end = said
    assert begin == "page: runs ..."
    assert "page, code cell 1, line 11: raise OSError('no robot')" in report
    assert "nothing was exported" not in report
    assert end.startswith("page: the outputs of its last run are shown.")


def test_what_starts_after_the_end_is_ended(tmp_path):
    live = Live(make_book(tmp_path), tmp_path)
    live.stop()
    with pytest.raises(LiveEndedError):
        live.note(
            subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
        )
    assert live.started[0].returncode == -signal.SIGTERM


def test_a_file_that_cannot_be_read_after_a_render_ends_nothing(tmp_path):
    live = Live(make_book(tmp_path), tmp_path)
    live.remember()
    (live.book / "_toc.yml").write_text("root: [")
    live.remember()
    shutil.rmtree(live.book)
    live.remember()
    assert not live.update(set())


def test_shown_files_are_replaced_whole_whatever_their_size_and_time(tmp_path):
    live = Live(make_book(tmp_path), tmp_path)
    new, shown = (
        folder / "a.html" for folder in (live.work / "_build/html", live.site)
    )
    new.parent.mkdir(parents=True)
    for text in ("one", "two"):
        new.write_text(text)
        os.utime(new, (0, 0))
        old = shown.open() if shown.is_file() else None
        live.show()
        assert [(path.name, path.read_text()) for path in live.site.iterdir()] == [
            ("a.html", text)
        ]
    with old:
        assert old.read() == "one"
