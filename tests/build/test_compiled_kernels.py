"""Which page may start while the engine's cache lacks the kernels that pages share."""

from pathlib import Path

import pytest
from nbformat.v4 import new_notebook
from tiny_book import cell, make_book, notebook

from robo_genesis.build.execute import CompiledKernels, execute_pages, kernel_environment
from robo_genesis.build.page_progress import Lines
from robo_genesis.build.page_store import places
from robo_genesis.core.project import ROOT
from robo_genesis.lessons.book_pages import Page, find_pages


def page(name: str) -> Page:
    """Return a page such as `l02/lab`, or `text`, which belongs to no lesson."""
    lesson, _, kind = name.partition("/")
    return Page(name, Path(name), new_notebook(), *((lesson, kind) if kind else ()))


def following(
    waiting: str, running: str = "", executed: str = "", environment: dict | None = None
) -> str | None:
    """Return the name of the page that starts next, by names that blanks separate."""
    sets = [[page(name) for name in names.split()] for names in (waiting, running, executed)]
    in_order = sorted((p for pages in sets for p in pages), key=lambda page: page.docname)
    kernels = CompiledKernels(in_order, environment or {})
    for done in sets[2]:
        kernels.add(done)
    found = kernels.next_page(sets[0], sets[1])
    return found.docname if found else None


@pytest.mark.parametrize(
    ("waiting", "running", "executed", "name"),
    [
        ("l03/a l02/b l02/a", "", "", "l02/a"),
        ("text l03/a l02/a", "", "", "l02/a"),
        ("l02/b l03/a", "l02/a", "", None),
        ("l02/b text", "l02/a l03/a", "", "text"),
        ("l03/a l02/a", "text", "", "l02/a"),
        ("l03/b l02/b", "l03/a", "l02/a", "l03/b"),
        ("l02/b text", "l02/a", "", "l02/b"),
        ("", "l02/a l03/a", "", None),
    ],
    ids=[
        "the book's first starts",
        "before a page of no lesson",
        "all wait for it",
        "but a page of no lesson",
        "for which none waits",
        "one has ended",
        "there is one lesson",
        "none waits",
    ],
)
def test_one_page_compiles_what_pages_share_and_the_others_wait(
    tmp_path, waiting, running, executed, name
):
    environment = kernel_environment(ROOT, tmp_path, "make book")
    assert following(waiting, running, executed, environment) == name


def test_kernels_of_another_backend_are_not_those_of_a_build(tmp_path):
    cuda, cpu = (
        kernel_environment(ROOT, tmp_path, "make book", ROBO_GENESIS_BACKEND=backend)
        for backend in ("cuda", "cpu")
    )
    following("", "", "l02/lab", cuda)
    assert following("l02/b l03/b", "l02/a", "", cpu) is None
    assert following("l02/b l03/b", "l02/a", "", cuda) == "l02/b"


def test_without_a_cache_no_page_waits():
    assert following("l02/b l03/b", "l02/a") == "l02/b"


LESSON = """\
import json, os, pathlib
folder = pathlib.Path(os.environ["ROBO_GENESIS_OUTPUTS_DIR"], "{lesson}", "{page}", "cpu")
folder.mkdir(parents=True)
manifest = {{"predicate": {{"run_id": os.environ["ROBO_GENESIS_RUN_ID"]}}}}
(folder / "manifest.json").write_text(json.dumps(manifest))
assert "{page}" != "broken\""""


def test_pages_run_one_after_the_other_until_one_succeeded(tmp_path):
    """A broken page may have ended before it compiled anything."""
    names = ["l02/broken", "l02/a", "l03/a", "l03/b"]
    texts = {}
    for number, name in enumerate(names):
        lesson, kind = name.split("/")
        code, more = LESSON.format(lesson=lesson, page=kind), [cell("1")] * (9 - number)
        front = f"robo_genesis: {{lesson: {lesson}, page: {kind}}}\n"
        texts[f"{lesson}-{kind}"] = notebook(cell(code), *more, front=front)
    pages = find_pages(make_book(tmp_path, **texts))
    events: list[tuple[str, str]] = []
    settings = {"environment": kernel_environment(ROOT, tmp_path / "cache", "make book"), "jobs": 4}
    report = Lines(lambda what, event: events.append((what, event.split()[0].rstrip(":"))))
    execute_pages(pages, places(pages, tmp_path / "store"), report=report, **settings)
    kinds = [kind for _, kind in events]
    assert kinds[:4] == ["started", "failed", "started", "executed"]
    assert kinds[4:6] == ["started", "started"]
    assert [name for name, kind in events if kind == "started"][:2] == ["l02-broken", "l02-a"]
    events.clear()
    again = {"reuse": False, "report": report} | settings
    execute_pages(pages[1:], places(pages, tmp_path / "store"), **again)
    assert [kind for _, kind in events[:3]] == ["started"] * 3
