"""Executed pages as files: what is exported, what is imported, what is refused."""

import json
import os
import shutil
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_output
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.build import page_artifacts
from robo_genesis.build.execute import execute_pages
from robo_genesis.build.page_artifacts import ArtifactError, export_page, import_pages
from robo_genesis.build.page_cache import cached_results
from robo_genesis.evidence.bundle import BundleRefused, sha256
from robo_genesis.lessons.book_pages import find_pages

FINGERPRINT = "0" * 20
LAB = "lab"
# Beside its bundle a page may leave files for its own figures.
MORE = WRITE_BUNDLE + '\n(folder.parent / "shape.npz").write_bytes(b"shape")'


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory) -> Path:
    """A book, executed once, with both of its pages exported."""
    root = tmp_path_factory.mktemp("elsewhere")
    lab = notebook(cell(MORE), cell("print('measured')"), front=LAB_FRONT)
    book = make_book(root, text=notebook(cell("print('seen')")), **{LAB: lab})
    folder = root / "cache" / FINGERPRINT
    for result in execute_pages(find_pages(book), folder):
        assert result.status == "executed", result.failure
        export_page(result, folder, root / "executed")
    return root


@pytest.fixture
def here(elsewhere, tmp_path) -> Path:
    """The same book on another machine, with the executed pages to spoil and no cache."""
    for name in ("book", "executed"):
        shutil.copytree(elsewhere / name, tmp_path / name)
    return tmp_path


def take(here: Path, fingerprint: str = FINGERPRINT, verify=lambda folder, run_id: None):
    pages = find_pages(here / "book")
    return import_pages(here / "executed", pages, here / "cache" / fingerprint, verify)


def cached(here: Path):
    return cached_results(find_pages(here / "book"), here / "cache" / FINGERPRINT)


def lab(here: Path, name: str) -> Path:
    return here / "executed" / LAB / name


def record(**changes):
    """Change entries of the lab's record."""

    def spoil(here: Path) -> None:
        path = lab(here, "page.json")
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))

    return spoil


def seal(here: Path) -> None:
    """Make the digests of the lab's record right again."""
    place = lab(here, "")
    names = {path.relative_to(place).as_posix(): path for path in place.rglob("*")}
    files = {n: sha256(path) for n, path in names.items() if path.is_file() and n != "page.json"}
    record(files=files)(here)


def book(change):
    """Change the lab's notebook, and its digest with it."""

    def spoil(here: Path) -> None:
        path = lab(here, "executed.ipynb")
        executed = nbformat.read(path, as_version=4)
        change(executed)
        nbformat.write(executed, path)
        seal(here)

    return spoil


def file(name: str, text: str):
    """Write a file of the lab, and its digest with it."""

    def spoil(here: Path) -> None:
        lab(here, name).write_text(text)
        seal(here)

    return spoil


def first_cell(**changes):
    return book(lambda executed: executed.cells[0].update(changes))


def metadata(**changes):
    return book(lambda executed: executed.metadata.update(changes))


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


def test_an_imported_page_needs_no_run_is_the_same_run_and_replaces_an_older_one(here):
    take(here)
    outputs = here / "cache" / FINGERPRINT / "outputs/l04/lab"
    (outputs / "cpu/manifest.json").write_text("{}")
    runs = {record.docname: record.run_id for record in take(here)}
    results = cached(here)
    assert [(name, result.status) for name, result in results.items()] == [
        ("text", "reused"),
        (LAB, "reused"),
    ]
    assert {name: result.run_id for name, result in results.items()} == runs
    assert (outputs / "shape.npz").read_bytes() == b"shape"


def test_exporting_again_replaces_the_page_and_no_other_folder(here):
    folder = here / "cache" / FINGERPRINT
    take(here)
    result = cached(here)[LAB]
    left_over = here / "executed" / LAB / "left over"
    left_over.touch()
    export_page(result, folder, here / "executed")
    assert not left_over.exists()
    (here / "mine" / LAB).mkdir(parents=True)
    with pytest.raises(ArtifactError, match="is not an executed page"):
        export_page(result, folder, here / "mine")
    assert [path.name for path in (here / "mine").iterdir()] == [LAB]


def test_a_bundle_that_is_refused_leaves_what_was_executed_here(here):
    def refuse(folder: Path, run_id: str):
        raise BundleRefused("stale", f"{folder.name} answers an older question")

    before = take(here)
    with pytest.raises(ArtifactError, match=r"lab: its bundle is refused: stale: cpu answers"):
        take(here, verify=refuse)
    assert {result.run_id for result in cached(here).values()} == {r.run_id for r in before}
    shutil.rmtree(here / "cache")
    with pytest.raises(ArtifactError):
        take(here, verify=refuse)
    assert not (here / "cache").exists()


def test_pages_lie_at_any_depth_but_not_within_another_nor_hidden(here):
    file("outputs/l04/lab/page.json", "its own")(here)
    for left in (".left", f"{LAB}.next", f"{LAB}.old"):
        shutil.copytree(here / "executed" / LAB, here / "executed" / left)
    (here / "executed" / "z").mkdir()
    (here / "executed" / LAB).rename(here / "executed" / "z" / "any name")
    assert [record.docname for record in take(here)] == ["text", LAB]


def link(here):
    lab(here, SHAPE).unlink()
    lab(here, SHAPE).symlink_to("/etc/hostname")


RUN = "f" * 32
ERROR = new_output("error", ename="ValueError", evalue="no", traceback=[])
CODE = "its code cells are not those of"
BUNDLE, SHAPE = "outputs/l04/lab/cpu/manifest.json", "outputs/l04/lab/shape.npz"
OTHERS = json.dumps({"predicate": {"run_id": RUN}})
NEW = "outputs/l04/lab/new"
SPOILT = {
    "another fingerprint": (record(fingerprint="1" * 20), "its fingerprint is 11"),
    "an unknown page": (record(docname="gone"), "its page is 'gone'. Pages of"),
    "a path for a page": (record(docname="../lab"), "its page is '../lab'"),
    "changed code": (record(code="0" * 64), CODE),
    "forged code": (first_cell(source="1"), CODE),
    "another kernel": (metadata(kernelspec={"name": "other", "display_name": ""}), CODE),
    "a run that is none": (record(run_id="../x"), "page.json is not what"),
    "a word too many": (record(signed=True), "page.json is not what"),
    "no JSON": (lambda h: lab(h, "page.json").write_text("{"), "is not what `make"),
    "the notebook of another run": (metadata(robo_genesis={"run_id": RUN}), "ipynb is of run ffff"),
    "a notebook of no run": (metadata(robo_genesis="none"), "executed.ipynb is of run None"),
    "the bundle of another run": (file(BUNDLE, OTHERS), "it has no evidence bundle of run"),
    "a cell that failed": (first_cell(outputs=[ERROR]), "ExpectedException: "),
    "no notebook": (lambda h: lab(h, "executed.ipynb").unlink(), "absent are ['executed.ipynb']"),
    "what is no notebook": (file("executed.ipynb", "[]"), "executed.ipynb is not a notebook"),
    "no manifest": (lambda h: lab(h, BUNDLE).unlink(), f"absent are ['{BUNDLE}']"),
    "a changed file": (lambda h: lab(h, SHAPE).write_text("new"), "shape.npz'] changed since"),
    "an unlisted file": (lambda h: lab(h, NEW).touch(), f"not of this page ['{NEW}']"),
    "a file of another page": (file("outputs/new", "new"), "not of this page ['outputs/new']"),
    "a path for a file": (record(files={"../../x": "0" * 64}), "absent are ['../../x'"),
    "a link": (link, "shape.npz is a link or device"),
    "a pipe": (lambda h: os.mkfifo(lab(h, "pipe")), "pipe is a link or device"),
    "two of one page": (lambda h: shutil.copytree(lab(h, ""), h / "executed/again"), "lab is in "),
}


@pytest.mark.parametrize(("spoil", "said"), SPOILT.values(), ids=SPOILT)
def test_a_page_that_does_not_hold_is_refused_and_nothing_is_imported(here, spoil, said):
    spoil(here)
    with pytest.raises(ArtifactError) as refused:
        take(here)
    first, *problems = str(refused.value).splitlines()
    assert first == f"The executed pages in {here / 'executed'} are refused."
    assert said in problems[0]
    assert problems[0].startswith(str(here / "executed"))
    assert not (here / "cache").exists()


def test_every_missing_page_is_named_with_the_command_that_makes_it(here):
    shutil.rmtree(here / "executed")
    with pytest.raises(ArtifactError, match=r"EXECUTED=.*executed is not a folder"):
        take(here)
    (here / "executed").mkdir()
    with pytest.raises(ArtifactError) as refused:
        take(here)
    for name in ("text", LAB):
        assert f"\n{name} is not among them." in str(refused.value)
        assert f"make execute PAGE={name} TO=folder" in str(refused.value)


def test_prose_may_change_after_the_export_and_code_may_not(here):
    page = here / "book" / "text.md"
    page.write_text(page.read_text().replace("A page.", "Another sentence."))
    assert len(take(here)) == 2
    page.write_text(page.read_text().replace("seen", "changed"))
    with pytest.raises(ArtifactError, match=f"code cells are not those of {page}"):
        take(here)


@pytest.mark.parametrize(("name", "limit"), [("SIZE_LIMIT", 3), ("FILES_LIMIT", 1)])
def test_too_much_is_refused_before_it_is_read(here, monkeypatch, name, limit):
    monkeypatch.setattr(page_artifacts, name, limit)
    with pytest.raises(ArtifactError, match="exceeds a limit: at most"):
        take(here)
