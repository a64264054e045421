from pathlib import Path

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, published_marker, write_bundle

from robo_genesis.build.page_results import PageResult
from robo_genesis.build.site.publish import publish
from robo_genesis.core import files as core_files
from robo_genesis.lessons.book_pages import find_pages


@pytest.fixture
def book(tmp_path):
    return make_book(tmp_path, lab=notebook(cell("1"), front=LAB_FRONT))


@pytest.fixture
def html(tmp_path):
    folder = tmp_path / "staging"
    folder.mkdir()
    (folder / "index.html").write_text("the new site")
    return folder


def names(book: Path) -> set[str]:
    return {path.name for path in book.iterdir() if path.name.startswith("_build")}


def test_site_and_bundles_are_published_together_and_labs_apart_from_other_pages(tmp_path, html):
    lecture = notebook(cell("2"), front=LAB_FRONT.replace("page: lab", "page: lecture"))
    book = make_book(tmp_path, lab=notebook(cell("1"), front=LAB_FRONT), lecture=lecture)
    bundle = write_bundle(tmp_path / "outputs", "a")
    published_marker(book)
    results = [PageResult(page, "executed", 1.0, "a", bundle) for page in find_pages(book)]
    site = publish(book, html, results)
    assert site == book / "_build" / "html"
    assert (site / "index.html").read_text() == "the new site"
    kept = (book / "_build").glob("*/**/manifest.json")
    assert sorted(path.parent.relative_to(book / "_build").as_posix() for path in kept) == [
        "evidence/l04/cpu",
        "pages/l04/lecture/cpu",
    ]
    assert (bundle / "manifest.json").is_file()
    assert names(book) == {"_build"}


def test_a_failure_while_copying_leaves_the_old_site(tmp_path, book, html):
    (page,) = find_pages(book)
    marker = published_marker(book)
    gone = PageResult(page, "executed", 1.0, "a", tmp_path / "no bundle")
    with pytest.raises(OSError, match="no bundle"):
        publish(book, html, [gone])
    assert marker.read_text() == "the old site"
    assert names(book) == {"_build"}


def test_a_failing_second_rename_brings_the_old_site_back(book, html, monkeypatch):
    marker = published_marker(book)
    rename = core_files.os.rename

    def second_fails(source, target):
        if Path(source).name == "_build.next":
            raise KeyboardInterrupt
        rename(source, target)

    monkeypatch.setattr(core_files.os, "rename", second_fails)
    with pytest.raises(KeyboardInterrupt):
        publish(book, html, [])
    assert marker.read_text() == "the old site"
    assert names(book) == {"_build"}
