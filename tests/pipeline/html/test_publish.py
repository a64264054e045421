import os
from pathlib import Path
from unittest.mock import Mock

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, old_site

from robo_genesis.pipeline.html.draft import Draft
from robo_genesis.pipeline.html.publish import add_bundles, publish
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.results import PageResult


@pytest.fixture
def draft(tmp_path):
    rendered = tmp_path / "rendered"
    rendered.mkdir()
    (rendered / "index.html").write_text("the new site")
    return Draft(rendered, tmp_path / "staging").complete()


def names(book: Path) -> set[str]:
    return {path.name for path in book.iterdir() if "_build" in path.name}


def test_site_and_bundles_are_published_together_and_labs_apart_from_other_pages(
    tmp_path, draft
):
    lecture = notebook(cell("2"), front=LAB_FRONT.replace("page: lab", "page: lecture"))
    book = make_book(
        tmp_path, lab=notebook(cell("1"), front=LAB_FRONT), lecture=lecture
    )
    bundle = tmp_path / "outputs" / "cpu"
    bundle.mkdir(parents=True)
    (bundle / "manifest.json").touch()
    old_site(book)
    results = [
        PageResult(page, "executed", 1.0, "a", bundle) for page in find_pages(book)
    ]
    add_bundles(draft, results)
    site = publish(book, draft.folder)
    assert site == book / "_build" / "html"
    assert (site / "index.html").read_text() == "the new site"
    kept = (book / "_build").glob("*/**/manifest.json")
    assert sorted(
        path.parent.relative_to(book / "_build").as_posix() for path in kept
    ) == [
        "evidence/l04/cpu",
        "pages/l04/lecture/cpu",
    ]
    assert (bundle / "manifest.json").is_file()
    assert names(book) == {"_build"}


def test_a_web_server_can_read_the_site_whatever_the_umask(tmp_path, draft):
    book = make_book(tmp_path)
    before = os.umask(0o077)
    try:
        publish(book, draft.folder, lambda folder: (folder / "build.json").touch())
    finally:
        os.umask(before)
    modes = {p.is_dir(): p.stat().st_mode & 0o777 for p in (book / "_build").rglob("*")}
    assert modes == {True: 0o755, False: 0o644}
    assert (book / "_build").stat().st_mode & 0o777 == 0o755


def test_a_failure_leaves_the_old_site_alone(tmp_path, draft):
    book = make_book(tmp_path)
    marker = old_site(book)
    with pytest.raises(KeyboardInterrupt):
        publish(book, draft.folder, Mock(side_effect=KeyboardInterrupt))
    assert marker.read_text() == "the old site"
    assert names(book) == {"_build"}
