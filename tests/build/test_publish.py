from pathlib import Path

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, published_marker, write_bundle

from robo_genesis.build.page_results import PageResult
from robo_genesis.build.publish import publish, recover
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


def test_site_and_lab_bundles_are_published_together(tmp_path, book, html):
    (page,) = find_pages(book)
    bundle = write_bundle(tmp_path / "outputs", "a")
    published_marker(book)
    site = publish(book, html, [PageResult(page, "executed", 1.0, "a", bundle)])
    assert site == book / "_build" / "html"
    assert (site / "index.html").read_text() == "the new site"
    assert (book / "_build/evidence/l04/cpu/manifest.json").is_file()
    assert (bundle / "manifest.json").is_file()
    assert names(book) == {"_build"}


def test_bundles_of_other_pages_are_published_apart_from_the_lab_s(tmp_path, html):
    front = "robo_genesis: {lesson: l04, page: lecture}\n"
    book = make_book(tmp_path, lecture=notebook(cell("1"), front=front))
    (page,) = find_pages(book)
    bundle = write_bundle(tmp_path / "outputs", "a")
    publish(book, html, [PageResult(page, "executed", 1.0, "a", bundle)])
    assert not (book / "_build" / "evidence").exists()
    assert (book / "_build/pages/l04/lecture/cpu/manifest.json").is_file()


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


def test_killed_between_the_renames_the_old_site_comes_back(book):
    marker = published_marker(book)
    (book / "_build").rename(book / "_build.old")
    (book / "_build.next").mkdir()
    recover(book)
    assert marker.read_text() == "the old site"
    assert names(book) == {"_build"}


def test_killed_after_the_renames_the_new_site_stays(book):
    marker = published_marker(book)
    marker.write_text("the new site")
    (book / "_build.old" / "html").mkdir(parents=True)
    recover(book)
    assert marker.read_text() == "the new site"
    assert names(book) == {"_build"}


def test_recovery_of_a_book_that_was_never_built_does_nothing(book):
    recover(book)
    assert names(book) == set()
