"""The archive of a complete site."""

import io
import zipfile

import pytest

from robo_genesis.pipeline.html.archive import (
    ARCHIVE,
    FOLDER,
    contents,
    pack,
    zipped,
)

OFFER = f'<p class="offline-offer"><a href="{ARCHIVE}">x</a>'


@pytest.fixture
def html(tmp_path):
    folder = tmp_path / "html"
    (folder / "sub").mkdir(parents=True)
    (folder / "index.html").write_text(f"<p>Home</p>{OFFER}")
    (folder / "sub/a page.html").write_text("<p>Page")
    (folder / ".hidden").write_bytes(b"\x89PNG")
    return folder


def test_all_files_are_packed_and_no_packed_page_offers_the_archive(html):
    archive = pack(html)
    assert archive == html / ARCHIVE
    with zipfile.ZipFile(archive) as packed:
        found = {name: packed.read(name) for name in packed.namelist()}
    files = {
        ".hidden": b"\x89PNG",
        "index.html": b"<p>Home</p>",
        "sub/a page.html": b"<p>Page",
    }
    assert found == {f"{FOLDER}/{name}": content for name, content in files.items()}
    assert OFFER in (html / "index.html").read_text()


def test_the_same_files_give_the_same_bytes_whenever_they_were_written(tmp_path):
    archives = []
    for content in ("a log", "a log", "another log"):
        (tmp_path / "log.txt").write_text(content)
        archives.append(zipped(contents(tmp_path)))
    assert archives[0] == archives[1] != archives[2]
    assert zipfile.ZipFile(io.BytesIO(archives[0])).namelist() == ["log.txt"]
