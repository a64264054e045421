"""What is added to a complete site: its archive, and SHA256SUMS as `sha256sum -c` reads it."""

import io
import shutil
import subprocess
import zipfile

import pytest

from robo_genesis.pipeline.html.archive import (
    ARCHIVE,
    FOLDER,
    SUMS,
    contents,
    pack,
    write_sums,
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


def test_every_file_but_the_list_is_listed(html):
    pack(html)
    write_sums(html)
    command = [shutil.which("sha256sum"), "--check", "--strict", SUMS]
    done = subprocess.run(command, cwd=html, capture_output=True, text=True, check=True)
    assert done.stdout.count(": OK") == 4


def test_the_same_files_give_the_same_bytes_whenever_they_were_written(tmp_path):
    archives = []
    for content in ("a log", "a log", "another log"):
        (tmp_path / "log.txt").write_text(content)
        archives.append(zipped(contents(tmp_path)))
    assert archives[0] == archives[1] != archives[2]
    assert zipfile.ZipFile(io.BytesIO(archives[0])).namelist() == ["log.txt"]
