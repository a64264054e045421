"""The store of executed pages: what is kept, exported, imported and refused."""

import json
import os
import shutil
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_output
from small_book import executed
from tiny_book import (
    LAB_FRONT,
    WRITE_BUNDLE,
    accept,
    cell,
    contents,
    make_book,
    notebook,
    refuse,
)
from tiny_book import seal as seal_page

from robo_genesis.core.files import put, replaced, settle_below
from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.bundles import of_build
from robo_genesis.pipeline.pages import folder as page_folder
from robo_genesis.pipeline.pages import store
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.folder import PageRefused
from robo_genesis.pipeline.pages.results import PageResult

LAB = "lab"
# Beside its bundle a page may leave files for its own figures.
MORE = WRITE_BUNDLE + '\n(folder.parent / "shape.npz").write_bytes(b"shape")'


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory) -> Path:
    """A book, executed once, with both of its pages exported."""
    root = tmp_path_factory.mktemp("elsewhere")
    lab = notebook(cell(MORE), cell("print('measured')"), front=LAB_FRONT)
    book = make_book(root, text=notebook(cell("print('seen')")), **{LAB: lab})
    for result in executed(find_pages(book), root):
        put(result.folder, store.exported(result.page, root / "executed"))
    return root


@pytest.fixture
def here(elsewhere, tmp_path) -> Path:
    """The same book on another machine, with the executed pages to spoil and no cache."""
    for name in ("book", "executed"):
        shutil.copytree(elsewhere / name, tmp_path / name)
    return tmp_path


def take(here: Path) -> list[PageResult]:
    pages = find_pages(here / "book")
    return store.handed_over(
        here / "executed", pages, store.places(pages, here / "store")
    )


def lab(here: Path, name: str) -> Path:
    return here / "executed" / LAB / name


def record(**changes):
    """Change entries of the lab's record."""

    def spoil(here: Path) -> None:
        path = lab(here, "page.json")
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))

    return spoil


def book(change):
    """Change the lab's notebook, and its digest with it."""

    def spoil(here: Path) -> None:
        path = lab(here, "executed.ipynb")
        executed = nbformat.read(path, as_version=4)
        change(executed)
        nbformat.write(executed, path)
        seal_page(path.parent)

    return spoil


def file(name: str, text: str):
    """Write a file of the lab, and its digest with it."""

    def spoil(here: Path) -> None:
        lab(here, name).write_text(text)
        seal_page(lab(here, ""))

    return spoil


def first_cell(**changes):
    return book(lambda executed: executed.cells[0].update(changes))


def metadata(**changes):
    return book(lambda executed: executed.metadata.update(changes))


def test_a_page_is_one_folder_in_the_store_and_between_machines(elsewhere):
    place = elsewhere / "executed" / LAB
    (kept,) = (elsewhere / "store" / LAB).iterdir()
    assert contents(kept) == contents(place)
    record = json.loads((place / "page.json").read_text())
    assert (record["docname"], record["lesson"], record["page"]) == (LAB, "l04", "lab")
    assert record["fingerprint"] == kept.name
    assert len(record["cell_seconds"]) == 2
    assert set(record["files"]) == {
        "executed.ipynb",
        BUNDLE,
        SHAPE,
        "outputs/cpu/printed.json",
    }
    assert "measured" in (place / "executed.ipynb").read_text()


def test_pages_lie_at_any_depth_but_not_within_another_nor_hidden(here):
    file("outputs/page.json", "its own")(here)
    for left in (".left", f".{LAB}.next"):
        shutil.copytree(here / "executed" / LAB, here / "executed" / left)
    (here / "executed" / "z").mkdir()
    place = (here / "executed" / LAB).rename(here / "executed" / "z" / "any name")
    found = {result.folder: result.status for result in take(here)}
    assert found == dict.fromkeys((here / "executed/text", place), "taken over")


def remove(name: str):
    return lambda here: lab(here, name).unlink()


def two(here):
    shutil.copytree(lab(here, ""), here / "executed/again")


def link(here):
    lab(here, SHAPE).unlink()
    lab(here, SHAPE).symlink_to("/etc/hostname")


RUN = "f" * 32
ERROR = new_output("error", ename="ValueError", evalue="no", traceback=[])
CODE = "its code cells are not those of"
BUNDLE, SHAPE = "outputs/cpu/manifest.json", "outputs/shape.npz"
OTHERS = json.dumps({"predicate": {"run_id": RUN}})
SPOILT = {
    "another fingerprint": (record(fingerprint="1" * 20), "fingerprint", "is 11111"),
    "an unknown page": (record(docname="gone"), "page", "its page is 'gone'. Pages of"),
    "another lesson": (
        record(lesson="l02"),
        "page",
        "of lab (l02/lab), expected was lab (l04/la",
    ),
    "forged code": (first_cell(source="1"), "code", CODE),
    "another kernel": (
        metadata(kernelspec={"name": "other", "display_name": ""}),
        "code",
        CODE,
    ),
    "a run that is none": (record(run_id="../x"), "record", "page.json is not what"),
    "the notebook of another run": (
        metadata(robo_genesis={"run_id": RUN}),
        "run",
        "of run ffff",
    ),
    "the bundle of another run": (
        file(BUNDLE, OTHERS),
        "bundle",
        "has no evidence bundle of run",
    ),
    "a cell that failed": (
        first_cell(outputs=[ERROR]),
        "outcome",
        "ExpectedException: ",
    ),
    "no notebook": (remove("executed.ipynb"), "files", "absent are ['executed.ipynb']"),
    "what is no notebook": (
        file("executed.ipynb", "[]"),
        "notebook",
        "ipynb is not a notebook",
    ),
    "a changed file": (
        lambda h: lab(h, SHAPE).write_text("new"),
        "digest",
        f"['{SHAPE}'] changed",
    ),
    "a file of another page": (file("new", "new"), "files", "not of this page ['new']"),
    "a path for a file": (
        record(files={"../../x": "0" * 64}),
        "files",
        "absent are ['../../x'",
    ),
    "a link": (link, "files", "shape.npz is a link or device"),
    "a pipe": (
        lambda h: os.mkfifo(lab(h, "pipe")),
        "files",
        "pipe is a link or device",
    ),
    "two of one page": (two, "twice", "lab is in "),
}


@pytest.mark.parametrize(("spoil", "code", "said"), SPOILT.values(), ids=SPOILT)
def test_a_page_that_does_not_hold_is_refused(here, spoil, code, said):
    spoil(here)
    with pytest.raises(ProjectError) as refused:
        take(here)
    first, *problems = str(refused.value).splitlines()
    assert first == f"The executed pages in {here / 'executed'} are refused."
    place, found, reason = problems[0].partition(f": {code}: ")
    assert place.startswith(str(here / "executed"))
    assert found
    assert said in reason


def keep(here):
    """Spoil nothing: the bundle itself is refused."""


def folder_for_manifest(here):
    lab(here, BUNDLE).unlink()
    lab(here, f"{BUNDLE}/folder").mkdir(parents=True)


def pipe_for_record(here):
    lab(here, "page.json").unlink()
    os.mkfifo(lab(here, "page.json"))


def file_for_folder(here):
    shutil.rmtree(lab(here, ""))
    lab(here, "").touch()


def link_for_folder(here):
    lab(here, "").rename(here / "aside")
    lab(here, "").symlink_to(here / "aside")


FORGED = {
    "robo_genesis": {"function": "robo_genesis.lessons.l04.tables.of", "arguments": []}
}
FAILS = {
    **{name: spoil for name, (spoil, *_) in SPOILT.items() if spoil is not two},
    "a refused bundle": keep,
    "a refused output": first_cell(
        outputs=[new_output("display_data", metadata=FORGED)]
    ),
    "JSON that is too deep": file("executed.ipynb", "[" * 100_000),
    "a manifest that is too deep": file(BUNDLE, "[" * 100_000),
    "a folder for the manifest": folder_for_manifest,
    "no times": record(cell_seconds=[]),
    "half a record": lambda here: lab(here, "page.json").write_text("{"),
    "a pipe for the record": pipe_for_record,
    "a file for the folder": file_for_folder,
    "a link": link_for_folder,
    "a link to nothing": lambda here: (
        link_for_folder(here),
        shutil.rmtree(here / "aside"),
    ),
}


@pytest.mark.parametrize("spoil", FAILS.values(), ids=FAILS)
def test_a_stored_page_that_fails_is_run_again_by_this_build_or_the_next(
    here, monkeypatch, spoil
):
    """Whatever is wrong with it, no build fails for ever."""
    monkeypatch.setattr(of_build, "require_contract", lambda *given: None)
    spoil(here)
    _, page = find_pages(here / "book")
    place = store.places([page], here / "store")[LAB]
    place.parent.mkdir(parents=True)
    (here / "executed" / LAB).rename(place)

    def build() -> str:
        try:
            result = store.stored_result(page, place)
        except PageRefused:
            result = None
        if result is None:
            return "executed again"
        judge = refuse if spoil is keep else accept
        return (
            "".join(of_build.verify_results(judge, [result], lambda *_: None)[1])
            or "accepted"
        )

    first = build()
    assert first == "executed again" or first.endswith(
        "The next build executes the page again."
    )
    assert build() == "executed again"
    with replaced(place) as fresh:
        fresh.mkdir()
    settle_below(here / "store")
    assert place.is_dir()


@pytest.mark.parametrize("newest", [1000, 10**10], ids=["past", "future"])
def test_the_used_and_the_newest_folders_of_a_page_are_kept_and_other_pages_go(
    tmp_path, newest
):
    (page,) = find_pages(make_book(tmp_path, text=notebook(cell("1"))))
    kept = tmp_path / "store"
    for age, name in enumerate("abcde"):
        (kept / "text" / name).mkdir(parents=True)
        os.utime(kept / "text" / name, (newest - age, newest - age))
    for left in ("gone/fingerprint", "text/.a.next", "a" * 20 + "/notebooks"):
        (kept / left).mkdir(parents=True)
    store.forget(kept, [page], {"text": kept / "text" / "e"})
    assert [path.name for path in kept.iterdir()] == ["text"]
    assert {path.name for path in store.folders(kept, page)} == {"e", "a", "b"}
    assert sorted(path.name for path in (kept / "text").iterdir()) == ["a", "b", "e"]


def test_a_folder_that_is_missing_is_named(here):
    shutil.rmtree(here / "executed")
    with pytest.raises(ProjectError, match=r"EXECUTED=.*executed is not a folder"):
        take(here)


@pytest.mark.parametrize(("name", "limit"), [("SIZE_LIMIT", 3), ("FILES_LIMIT", 1)])
def test_too_much_is_refused_before_it_is_read(here, monkeypatch, name, limit):
    monkeypatch.setattr(page_folder, name, limit)
    with pytest.raises(ProjectError, match="exceeds a limit: at most"):
        take(here)
