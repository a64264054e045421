"""`make book` on tiny books: what it publishes, and what stops it with the old site in place."""

import os
import re
import signal
import time
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from loading import ENGINE, JUPYTER, run_watched
from tiny_book import (
    accept,
    cell,
    fails,
    lab,
    make_book,
    notebook,
    old_site,
    refuse,
    start,
    wait,
)

from robo_genesis.core import project
from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline import up_to_date
from robo_genesis.pipeline.pages.book import PageError
from robo_genesis.pipeline.pages.kernels import kill_with_descendants
from robo_genesis.pipeline.stages import Build, BuildError, build_lock, run_build

LAB, PIN = lab("cpu"), project.engine_pin()


def build(folder: Path, said: list[str] | None = None, **settings) -> list[str]:
    settings = {
        "verify": accept,
        "say": (said if said is not None else []).append,
    } | settings
    return run_build(Build(book=folder / "book", cache=folder / "cache", **settings))


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> SimpleNamespace:
    """A book that was built twice; its home page was edited during the first build."""
    folder = tmp_path_factory.mktemp("built")
    book = make_book(folder, lab=LAB, lecture=notebook(cell("print('seen')")))
    marker = old_site(book)
    gone = folder / "cache/pages/gone/fingerprint"
    gone.mkdir(parents=True)
    said: list[str] = []

    def edit_meanwhile(line: str) -> None:
        said.append(line)
        if "] render " in line:
            (book / "index.md").write_text("# Home\n\nEdited meanwhile.\n")

    with pytest.MonkeyPatch.context() as changed:
        changed.setenv("SOLUTIONS", "1")  # as the command sets it
        last = build(folder, say=edit_meanwhile)
        record = book / "_build" / up_to_date.RECORD
        assert not record.exists()  # so it is built again
        again = build(folder)
    assert marker.read_text() != "the old site"
    assert not gone.exists()  # the book no longer has the page
    return SimpleNamespace(folder=folder, said=said, last=last, again=again)


def test_a_build_publishes_site_and_evidence_and_says_with_what(built):
    book = built.folder / "book"
    assert (book / "_build/evidence/l04/cpu/manifest.json").is_file()
    assert built.last == [
        f"Site: {book / '_build/html/index.html'}",
        "Solutions: shown. SOLUTIONS=0 leaves them out.",
        "Address: none. SITE_URL=https://example.org/course/ gives one.",
        f"Engine: genesis-world {built.last[3].split()[-1]}",
        "Renderer: llvmpipe",
        "Pages: 2 executed, 0 reused.",
        "Checks passed: 2 on what was measured, all on the site.",
    ]
    stages = list(dict.fromkeys(line.split("] ")[1].split()[0] for line in built.said))
    assert stages == ["execute", "verify", "render", "check", "publish"]
    assert "Pages: 0 executed, 2 reused." in built.again


def test_a_build_without_work_repeats_the_last_lines_and_loads_no_heavy_package(built):
    arguments = ("--book", str(built.folder / "book"))
    said, loaded = run_watched("book.py", *arguments)
    assert said.splitlines() == [
        "Nothing changed: the site is up to date.",
        *built.again,
    ]
    assert not loaded & {*ENGINE, *JUPYTER, "numpy"}


def test_a_release_requires_evidence(built, monkeypatch):
    reasons = ["l04 requires evidence"]
    monkeypatch.setattr(
        "robo_genesis.pipeline.stages.missing_for_release", lambda *given: reasons
    )
    site = built.folder / "book/_build/html/index.html"
    before = site.stat()
    with pytest.raises(
        BuildError, match=r"RELEASE=1 cannot be met\.\nl04 requires evidence"
    ):
        build(built.folder, release=True)
    assert site.stat() == before


def test_a_site_with_a_problem_is_not_published(tmp_path, monkeypatch):
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    marker = old_site(make_book(tmp_path, lab="# A\n\nA word[^note].\n"))
    with pytest.raises(BuildError, match="leftovers: lab"):
        build(tmp_path)
    assert marker.read_text() == "the old site"


def test_failed_and_refused_pages_are_named_at_once_and_reported_together(tmp_path):
    marker = old_site(make_book(tmp_path, lab=LAB, broken=notebook(cell("1 / 0"))))
    report = r"1 of 2 pages failed\.(?s:.*)ZeroDiv(?s:.*)\nlab: the bundle .* is refused: metrics"
    for first in ("lab  executed", "lab  reused"):
        said: list[str] = []
        with pytest.raises(BuildError, match=report):
            build(tmp_path, said, verify=refuse, jobs=1)
        for event in (
            f"execute  {first}",
            "verify   lab  refused: metrics: metr",
            r"execute  broken  failed in \d+ s: ZeroDiv",
        ):
            assert any(re.search(event, line) for line in said), event
    assert marker.read_text() == "the old site"


def test_a_broken_page_fails_with_status_1_a_report_and_the_old_site(tmp_path):
    broken = cell("import sys\nprint('engine: last words', file=sys.stderr)\n1 / 0")
    marker = old_site(make_book(tmp_path, broken=notebook(broken), good=LAB))
    report = fails("book", tmp_path, "--jobs=2")
    assert "1 of 2 pages failed." in report
    assert "broken, code cell 1, line 12: 1 / 0" in report
    log = tmp_path / "cache/logs/broken.log"
    assert f"last lines of {log}:" in report
    assert "| engine: last words" in report
    assert report.endswith("FAILED: nothing was published.\n")
    assert marker.read_text() == "the old site"


def test_a_build_repairs_what_a_kill_left_before_it_reads_a_page(tmp_path):
    stale = tmp_path / "cache/engine/1-a/kernels/qdcache.lock"
    stale.parent.mkdir(parents=True)
    kernel = stale.with_name("kernel.ll")
    for path in (stale, kernel):
        path.touch()
    book = make_book(tmp_path)
    old_site(book)
    (book / "_build").rename(book / "._build.old")
    stored = tmp_path / "cache/pages/page/fingerprint"
    (stored.parent / ".fingerprint.old").mkdir(parents=True)
    (book / "_toc.yml").unlink()
    with pytest.raises(PageError):
        build(tmp_path)
    assert (stale.exists(), kernel.exists()) == (False, True)
    assert stored.is_dir()
    assert (book / "_build/html/index.html").read_text() == "the old site"


def test_a_lock_that_does_not_follow_the_pin_is_named_before_a_page(
    tmp_path, monkeypatch
):
    make_book(tmp_path, page=notebook(cell("1")))
    said: list[str] = []
    lock = (ROOT / "requirements.lock").read_text()
    (tmp_path / "requirements.lock").write_text(lock.replace(f"=={PIN}", "==9.8.7"))
    monkeypatch.setattr(project, "ROOT", tmp_path)
    monkeypatch.setattr(project, "engine_pin", lambda: PIN)
    with pytest.raises(
        BuildError, match=f"pins genesis-world {PIN}, but .* `make lock`"
    ):
        build(tmp_path, said)
    assert said == []


def test_python_without_docstrings_is_refused_with_its_variable(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONOPTIMIZE", "2")
    assert fails("book", tmp_path).startswith("PYTHONOPTIMIZE=2 removes docstrings")


def test_a_cache_that_cannot_be_written_is_named(tmp_path, no_file):
    make_book(tmp_path)
    report = fails("book", tmp_path, "--cache", str(no_file))
    assert f"Not a directory: '{no_file}" in report
    assert "free space or write access" in report


WAITS = """\
import os, pathlib, signal, time
{before}
pathlib.Path({file!r}).write_text(str(os.getpid()))
while True: time.sleep(0.1)"""
DEAF = "signal.signal(signal.SIGINT, signal.SIG_IGN)"


@pytest.mark.parametrize(
    ("sent", "to", "status"),
    [
        (
            signal.SIGINT,
            os.killpg,
            130,
        ),  # as a terminal sends Ctrl-C: to all of its processes
        (signal.SIGINT, os.kill, 130),
        (signal.SIGTERM, os.kill, 130),
        (signal.SIGKILL, os.kill, -9),
    ],
)
def test_an_end_by_signal_leaves_the_old_site_and_no_process(
    tmp_path, sent, to, status
):
    pids = {tmp_path / "one.pid": "", tmp_path / "two.pid": DEAF}
    pages = (
        notebook(cell(WAITS.format(file=str(f), before=b))) for f, b in pids.items()
    )
    book = make_book(tmp_path, **dict(zip(("one", "two"), pages, strict=True)))
    marker = old_site(book)
    process = start("book", tmp_path, "--jobs=2", own_group=True)
    wait(process, *pids)
    below = {
        child.pid: child
        for child in psutil.Process(process.pid).children(recursive=True)
    }
    kernels = [below[int(path.read_text())] for path in pids]
    scratch = Path(kernels[0].cwd()).parents[1]
    assert scratch.name.startswith("robo-")
    to(process.pid, sent)
    _, err = process.communicate(timeout=60)
    assert process.returncode == status
    assert status < 0 or "Interrupted: nothing was published." in err
    assert "Traceback" not in err
    assert psutil.wait_procs(below.values(), timeout=15)[1] == []
    assert not list((tmp_path / "cache/pages").rglob("*.ipynb"))
    assert status < 0 or not scratch.exists()
    assert marker.read_text() == "the old site"


def test_sphinx_ends_with_a_killed_build(tmp_path):
    """The kernel kills with SIGKILL when memory is short. Sphinx waits in a pipe that is a page."""
    text = "# Text\n\n```{literalinclude} pipe\n```\n"
    book = make_book(tmp_path, text=text, page=notebook(cell("1")))
    marker, pipe, cache = old_site(book), book / "pipe", tmp_path / "cache"
    os.mkfifo(pipe)
    process = start("book", tmp_path)
    wait(process, cache / "render/executed-pages.json")
    while not (below := psutil.Process(process.pid).children(recursive=True)):
        time.sleep(0.05)
    process.kill()
    process.communicate()
    try:
        assert psutil.wait_procs(below, timeout=5)[1] == []
    finally:
        for child in below:
            kill_with_descendants(child.pid)
    assert marker.read_text() == "the old site"
    pipe.unlink()
    pipe.write_text("text")
    build(tmp_path)
    assert marker.read_text() != "the old site"


def test_a_page_of_the_book_is_executed_alone_into_the_store(tmp_path):
    make_book(tmp_path, lab=LAB, page=notebook(cell("1")))
    folders = "--book", str(tmp_path / "book"), "--cache", str(tmp_path / "cache")
    said = run_watched("execute.py", *folders, "page")[0]
    assert "Executed page: " in said
    assert [p.name for p in (tmp_path / "cache/pages").iterdir()] == ["page"]
    report = fails("execute", tmp_path, "l05/lab")
    assert "'l05/lab' is not valid. Executed pages of this book: lab, page." in report


def test_a_second_build_at_the_same_time_is_refused_with_the_first_one_s_process(
    tmp_path,
):
    make_book(tmp_path)
    said = rf"runs here \(process {os.getpid()}\)\. Wait .* `kill {os.getpid()}`"
    with build_lock(tmp_path / "cache"), pytest.raises(ProjectError, match=said):
        build(tmp_path)
