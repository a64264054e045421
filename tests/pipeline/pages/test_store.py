"""The store of executed pages: what is kept, and what is executed again."""

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
    make_book,
    notebook,
    refuse,
    seal,
)

from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles import page_bundles
from robo_genesis.pipeline.pages import store
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.page_folder import PageRefused

# Beside its bundle a page may leave files for its own figures.
MORE = WRITE_BUNDLE + '\n(folder.parent / "shape.npz").write_bytes(b"shape")'
SHAPE = "outputs/shape.npz"


@pytest.fixture(scope="module")
def sound(tmp_path_factory) -> Path:
    """A book that was executed once."""
    root = tmp_path_factory.mktemp("sound")
    lab = notebook(cell(MORE), cell("print('measured')"), front=LAB_FRONT)
    executed(find_pages(make_book(root, lab=lab)), root)
    return root


@pytest.fixture
def place(sound, tmp_path) -> Path:
    """The folder of its page in a copy of the store, to spoil."""
    shutil.copytree(sound / "store", tmp_path / "store")
    [place] = (tmp_path / "store/lab").iterdir()
    return place


def test_the_table_of_seconds_has_what_the_last_execution_took(sound, place, tmp_path):
    pages = find_pages(sound / "book")
    written = store.write_seconds(tmp_path, tmp_path / "store", pages)
    seconds = json.loads((place / "page.json").read_text())["seconds"]
    assert json.loads(written.read_text()) == {"lab": round(seconds)}


def fail_a_cell(place: Path) -> None:
    """Let the first cell have raised, and make the digest of the notebook right again."""
    ran = nbformat.read(place / "executed.ipynb", as_version=4)
    error = new_output("error", ename="ValueError", evalue="no", traceback=[])
    ran.cells[0].outputs = [error]
    nbformat.write(ran, place / "executed.ipynb")
    seal(place)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda place: (place / SHAPE).write_text("new"), f"{SHAPE} changed"),
        (lambda place: (place / "new").touch(), "new changed since"),
        (lambda place: (place / "page.json").write_text("{"), "missing or damaged"),
        (fail_a_cell, "the cell raised ValueError: no, but"),
    ],
)
def test_a_damaged_page_is_refused_by_the_name_of_its_file(sound, place, spoil, said):
    [page] = find_pages(sound / "book")
    assert store.stored_result(page, place).status == "reused"
    spoil(place)
    with pytest.raises(PageRefused, match=said):
        store.stored_result(page, place)


def test_a_stored_page_whose_bundle_is_refused_is_executed_by_the_next_build(
    sound, place, monkeypatch
):
    monkeypatch.setattr(page_bundles, "require_contract", lambda *given: None)
    [page] = find_pages(sound / "book")
    result = store.stored_result(page, place)
    bundle = result.bundle
    page_bundles.verify_result(accept, result, bundle, lambda *_: None)
    with pytest.raises(BundleRefused):
        page_bundles.verify_result(refuse, result, bundle, lambda *_: None)
    with pytest.raises(PageRefused):
        store.stored_result(page, place)


def test_the_used_and_the_newest_folders_of_a_page_are_kept_and_other_pages_go(
    tmp_path,
):
    (page,) = find_pages(make_book(tmp_path, text=notebook(cell("1"))))
    kept = tmp_path / "store"
    for age, name in enumerate("abcde"):
        (kept / "text" / name).mkdir(parents=True)
        os.utime(kept / "text" / name, (1000 - age, 1000 - age))
    for left in ("gone/fingerprint", "text/.a.next", "a" * 20 + "/notebooks"):
        (kept / left).mkdir(parents=True)
    store.forget(kept, [page], {"text": kept / "text" / "e"})
    assert [path.name for path in kept.iterdir()] == ["text"]
    assert {path.name for path in store.folders(kept / "text")} == {"e", "a", "b"}
    assert sorted(path.name for path in (kept / "text").iterdir()) == ["a", "b", "e"]
