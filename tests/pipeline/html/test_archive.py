"""What is added to a complete site: its archive, and SHA256SUMS as `sha256sum -c` reads it."""

import shutil
import subprocess
import zipfile

import pytest

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.archive import ARCHIVE, FOLDER, SUMS, pack, write_sums

OFFER = f'<p class="offline-offer"><a href="{ARCHIVE}">x</a>'


@pytest.fixture
def html(tmp_path):
    folder = tmp_path / "html"
    (folder / "sub").mkdir(parents=True)
    (folder / "index.html").write_text(f"<p>Home</p>{OFFER}")
    (folder / "sub/a page.html").write_text("<p>Page")
    (folder / ".hidden").write_bytes(b"\x89PNG")
    return folder


def test_all_files_but_the_archive_itself_are_packed_to_the_same_bytes_each_time(html):
    first = pack(html).read_bytes()
    (html / ".hidden").touch()
    archive = pack(html)
    assert (archive, archive.read_bytes()) == (html / ARCHIVE, first)
    with zipfile.ZipFile(archive) as packed:
        found = {name: packed.read(name) for name in packed.namelist()}
    # A packed page does not offer what it is part of.
    files = {
        ".hidden": b"\x89PNG",
        "index.html": b"<p>Home</p>",
        "sub/a page.html": b"<p>Page",
    }
    assert found == {f"{FOLDER}/{name}": content for name, content in files.items()}
    assert OFFER in (html / "index.html").read_text()


def test_every_file_but_the_list_is_listed_in_order(html):
    pack(html)
    for _ in range(2):
        write_sums(html, {})
    names = [line.split("  ", 1)[1] for line in (html / SUMS).read_text().splitlines()]
    assert names == sorted([".hidden", "index.html", ARCHIVE, "sub/a page.html"])
    command = [shutil.which("sha256sum"), "--check", "--strict", SUMS]
    done = subprocess.run(command, cwd=html, capture_output=True, text=True, check=True)
    assert done.stdout.count(": OK") == 4


@pytest.mark.parametrize("name", ["a\nb", "a\\b", "link"])
def test_a_name_that_the_form_cannot_hold_is_refused(html, name):
    if name == "link":
        (html / name).symlink_to("index.html")
    else:
        (html / name).touch()
    with pytest.raises(ProjectError, match="Rename or copy it"):
        write_sums(html, {})
