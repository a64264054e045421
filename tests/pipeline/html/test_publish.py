import os
from pathlib import Path
from unittest.mock import Mock

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, old_site

from robo_genesis.pipeline.html.publish import publish
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.results import PageResult


@pytest.fixture
def rendered(tmp_path):
    folder = tmp_path / "rendered"
    folder.mkdir()
    (folder / "index.html").write_text("the new site")
    (folder / ".buildinfo").touch()
    return folder


def names(book: Path) -> set[str]:
    return {path.name for path in book.iterdir() if "_build" in path.name}


def test_site_and_bundles_are_published_together_for_everybody_to_read(
    tmp_path, rendered
):
    lecture = notebook(cell("2"), front=LAB_FRONT.replace("page: lab", "page: lecture"))
    lab = notebook(cell("1"), front=LAB_FRONT)
    book = make_book(tmp_path, lab=lab, lecture=lecture)
    bundle = tmp_path / "stored" / "outputs" / "cpu"
    bundle.mkdir(parents=True)
    (bundle / "manifest.json").touch()
    old_site(book)
    stored = tmp_path / "stored"
    results = [PageResult(page, "executed", stored) for page in find_pages(book)]
    before = os.umask(0o077)
    try:
        html = publish(book, rendered, results, lambda site: (site / "a").touch())
    finally:
        os.umask(before)
    assert (html / "index.html").read_text() == "the new site"
    published = book / "_build"
    files = {p for p in published.rglob("*") if p.is_file()}
    assert {path.relative_to(published).as_posix() for path in files} == {
        "a",
        "evidence/l04/cpu/manifest.json",
        "pages/l04/lecture/cpu/manifest.json",
        "html/.nojekyll",
        "html/index.html",
        "html/offline/robo-genesis-site.zip",
    }
    assert names(book) == {"_build"}
    modes = {p.is_dir(): p.stat().st_mode & 0o777 for p in published.rglob("*")}
    assert modes == {True: 0o755, False: 0o644}
    assert published.stat().st_mode & 0o777 == 0o755


def test_a_failure_leaves_the_old_site_alone(tmp_path, rendered):
    book = make_book(tmp_path)
    marker = old_site(book)
    with pytest.raises(KeyboardInterrupt):
        publish(book, rendered, [], Mock(side_effect=KeyboardInterrupt))
    assert marker.read_text() == "the old site"
    assert names(book) == {"_build"}
