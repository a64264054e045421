"""Executed pages that travel as files: what is handed over, what is taken over, what is refused."""

import json
import os
import shutil
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_output
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.build import page_export
from robo_genesis.build.execute import execute_pages
from robo_genesis.build.page_cache import (
    PageCache,
    cached_results,
    notebooks_folder,
    outputs_folder,
)
from robo_genesis.build.page_export import HandoverError, hand_over
from robo_genesis.build.page_import import take_over
from robo_genesis.evidence.bundle import BundleRefused, sha256
from robo_genesis.lessons.book_pages import find_pages

FINGERPRINT = "0" * 20
LAB = "lab"
# Beside its bundle a page may leave files for its own figures.
MORE = WRITE_BUNDLE + '\n(folder.parent / "shape.npz").write_bytes(b"shape")'


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory) -> Path:
    """A book, executed once, with both of its pages handed over."""
    root = tmp_path_factory.mktemp("elsewhere")
    lab = notebook(cell(MORE), cell("print('measured')"), front=LAB_FRONT)
    book = make_book(root, text=notebook(cell("print('seen')")), **{LAB: lab})
    folder = root / "cache" / FINGERPRINT
    for result in execute_pages(find_pages(book), folder):
        assert result.status == "executed", result.failure
        hand_over(result, folder, root / "executed")
    return root


@pytest.fixture
def here(elsewhere, tmp_path) -> Path:
    """The same book on another machine, with the executed pages to spoil and no cache."""
    for name in ("book", "executed"):
        shutil.copytree(elsewhere / name, tmp_path / name)
    return tmp_path


def take(here: Path, fingerprint: str = FINGERPRINT, verify=lambda folder, run_id: None):
    pages = find_pages(here / "book")
    return take_over(here / "executed", pages, here / "cache" / fingerprint, verify)


def cached(here: Path):
    folder = here / "cache" / FINGERPRINT
    cache = PageCache(notebooks_folder(folder))
    return cached_results(find_pages(here / "book"), cache, outputs_folder(folder))


def edit(here: Path, **changes) -> None:
    """Change entries of the lab's record."""
    path = here / "executed" / LAB / "page.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def seal(here: Path) -> None:
    """Make the digests of the lab's record right again."""
    place = here / "executed" / LAB
    names = {path.relative_to(place).as_posix(): path for path in place.rglob("*")}
    files = {n: sha256(path) for n, path in names.items() if path.is_file() and n != "page.json"}
    edit(here, files=files)


def rewrite(here: Path, change) -> None:
    """Change the lab's notebook, and its digest with it."""
    path = here / "executed" / LAB / "executed.ipynb"
    executed = nbformat.read(path, as_version=4)
    change(executed)
    nbformat.write(executed, path)
    seal(here)


def test_a_page_is_its_notebook_its_record_and_what_it_left(elsewhere):
    place = elsewhere / "executed" / LAB
    record = json.loads((place / "page.json").read_text())
    assert (record["docname"], record["fingerprint"]) == (LAB, FINGERPRINT)
    assert set(record["files"]) == {
        "executed.ipynb",
        "outputs/l04/lab/cpu/manifest.json",
        "outputs/l04/lab/shape.npz",
    }
    assert "measured" in (place / "executed.ipynb").read_text()


def test_what_is_taken_over_needs_no_run_and_is_the_same_run(here):
    runs = {record.docname: record.run_id for record in take(here)}
    results = cached(here)
    assert {name: result.status for name, result in results.items()} == dict.fromkeys(
        ["text", LAB], "reused"
    )
    assert {name: result.run_id for name, result in results.items()} == runs
    shape = here / "cache" / FINGERPRINT / "outputs/l04/lab/shape.npz"
    assert shape.read_bytes() == b"shape"


def test_folders_may_lie_at_any_depth(here):
    deep = here / "executed" / "executed-0"
    deep.mkdir()
    (here / "executed" / LAB).rename(deep / "any name")
    assert len(take(here)) == 2


def test_what_an_earlier_take_over_left_is_replaced(here, elsewhere):
    take(here)
    stale = here / "cache" / FINGERPRINT / "outputs/l04/lab/cpu/manifest.json"
    stale.write_text("{}")
    take(here)
    assert cached(here)[LAB].bundle is not None


def test_handing_over_again_replaces_the_page_and_no_other_folder(here):
    folder = here / "cache" / FINGERPRINT
    take(here)
    (result, *_) = [r for r in cached(here).values() if r.page.docname == LAB]
    left_over = here / "executed" / LAB / "left over"
    left_over.touch()
    hand_over(result, folder, here / "executed")
    assert not left_over.exists()
    (here / "mine" / LAB).mkdir(parents=True)
    with pytest.raises(HandoverError, match="is no executed page"):
        hand_over(result, folder, here / "mine")
    assert [path.name for path in (here / "mine").iterdir()] == [LAB]


def test_a_bundle_that_is_refused_leaves_what_was_executed_here(here):
    def refuse(folder: Path, run_id: str):
        raise BundleRefused("stale", f"{folder.name} answers an older question")

    before = take(here)
    with pytest.raises(HandoverError, match=r"lab: its bundle is refused: stale: cpu answers"):
        take(here, verify=refuse)
    assert {result.run_id for result in cached(here).values()} == {r.run_id for r in before}
    shutil.rmtree(here / "cache")
    with pytest.raises(HandoverError):
        take(here, verify=refuse)
    assert not (here / "cache").exists()


def test_what_lies_within_a_page_or_is_hidden_is_no_page(here):
    (here / "executed" / LAB / "outputs/l04/lab/page.json").write_text("its own")
    seal(here)
    for left in (".left", f"{LAB}.next", f"{LAB}.old"):
        shutil.copytree(here / "executed" / LAB, here / "executed" / left)
    assert [record.docname for record in take(here)] == ["text", LAB]


def test_a_folder_that_is_not_there_is_named(here):
    shutil.rmtree(here / "executed")
    with pytest.raises(HandoverError, match=r"EXECUTED=.*executed is no folder"):
        take(here)


def drop(name):
    return lambda here: (here / "executed" / LAB / name).unlink()


def add(name):
    return lambda here: (here / "executed" / LAB / name).write_text("new")


def add_and_seal(name):
    def spoil(here):
        add(name)(here)
        seal(here)

    return spoil


def link(here):
    path = here / "executed" / LAB / "outputs/l04/lab/shape.npz"
    path.unlink()
    path.symlink_to("/etc/hostname")


def pipe(here):
    os.mkfifo(here / "executed" / LAB / "pipe")


def other_code(here):
    rewrite(here, lambda executed: executed.cells[0].update(source="print('forged')"))


def other_kernel(here):
    rewrite(here, lambda executed: executed.metadata.kernelspec.update(name="other"))


def other_run(here):
    rewrite(here, lambda executed: executed.metadata.robo_genesis.update(run_id="f" * 32))


def no_run(here):
    rewrite(here, lambda executed: executed.metadata.update(robo_genesis="none"))


def other_bundle(here):
    manifest = here / "executed" / LAB / "outputs/l04/lab/cpu/manifest.json"
    manifest.write_text(json.dumps({"predicate": {"run_id": "f" * 32}}))
    seal(here)


def failed_cell(here):
    error = new_output("error", ename="ValueError", evalue="no", traceback=[])
    rewrite(here, lambda executed: executed.cells[0].update(outputs=[error]))


def no_notebook(here):
    (here / "executed" / LAB / "executed.ipynb").write_text("[]")
    seal(here)


def twice(here):
    shutil.copytree(here / "executed" / LAB, here / "executed" / "again")


SPOILT = {
    "another fingerprint": (lambda here: edit(here, fingerprint="1" * 20), "its fingerprint is 11"),
    "an unknown page": (lambda here: edit(here, docname="gone"), "its page is 'gone'. Pages of"),
    "a path for a page": (lambda here: edit(here, docname="../lab"), "its page is '../lab'"),
    "changed code": (lambda here: edit(here, code="0" * 64), "its code cells are not those of"),
    "forged code": (other_code, "its code cells are not those of"),
    "another kernel": (other_kernel, "its code cells are not those of"),
    "a run that is none": (lambda here: edit(here, run_id="../x"), "page.json is not what"),
    "a word too many": (lambda here: edit(here, signed=True), "page.json is not what"),
    "no JSON": (
        lambda here: (here / "executed/lab/page.json").write_text("{"),
        "is not what `make",
    ),
    "the notebook of another run": (other_run, "executed.ipynb is of run ffff"),
    "a notebook of no run": (no_run, "executed.ipynb is of run None"),
    "the bundle of another run": (other_bundle, "it has no evidence bundle of run"),
    "a cell that failed": (failed_cell, "ExpectedException: "),
    "no notebook": (drop("executed.ipynb"), "absent are ['executed.ipynb']"),
    "what is no notebook": (no_notebook, "executed.ipynb is no notebook"),
    "no manifest": (drop("outputs/l04/lab/cpu/manifest.json"), "absent are ['outputs/l04/lab/cpu"),
    "a changed file": (add("outputs/l04/lab/shape.npz"), "shape.npz'] changed since"),
    "an unlisted file": (add("outputs/l04/lab/new"), "not of this page ['outputs/l04/lab/new']"),
    "a file of another page": (add_and_seal("outputs/new"), "not of this page ['outputs/new']"),
    "a path for a file": (
        lambda here: edit(here, files={"../../x": "0" * 64}),
        "absent are ['../../x']",
    ),
    "a link": (link, "shape.npz is a link or device"),
    "a pipe": (pipe, "pipe is a link or device"),
    "two of one page": (twice, "lab is in "),
}


@pytest.mark.parametrize(("spoil", "said"), SPOILT.values(), ids=SPOILT)
def test_a_page_that_does_not_hold_is_refused_and_nothing_is_taken_over(here, spoil, said):
    spoil(here)
    with pytest.raises(HandoverError) as refused:
        take(here)
    first, *problems = str(refused.value).splitlines()
    assert first == f"The executed pages in {here / 'executed'} are refused."
    assert said in problems[0]
    assert problems[0].startswith(str(here / "executed"))
    assert not (here / "cache").exists()


def test_every_missing_page_is_named_with_the_command_that_makes_it(here):
    shutil.rmtree(here / "executed")
    (here / "executed").mkdir()
    with pytest.raises(HandoverError) as refused:
        take(here)
    for name in ("text", LAB):
        assert f"\n{name} is not among them." in str(refused.value)
        assert f"make execute PAGE={name} TO=folder" in str(refused.value)


def test_a_page_that_changed_since_is_refused(here):
    page = here / "book" / "text.md"
    page.write_text(page.read_text().replace("seen", "changed"))
    with pytest.raises(HandoverError, match=f"code cells are not those of {page}"):
        take(here)


def test_prose_may_change_on_the_way(here):
    page = here / "book" / "text.md"
    page.write_text(page.read_text().replace("A page.", "Another sentence."))
    assert len(take(here)) == 2


@pytest.mark.parametrize(("name", "limit"), [("SIZE_LIMIT", 3), ("FILES_LIMIT", 1)])
def test_too_much_is_refused_before_it_is_read(here, monkeypatch, name, limit):
    monkeypatch.setattr(page_export, name, limit)
    with pytest.raises(HandoverError, match="is too much: at most"):
        take(here)
