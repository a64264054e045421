import zipfile

import pytest

from robo_genesis.pipeline.html.archive import ARCHIVE, FOLDER, pack


@pytest.fixture
def html(tmp_path):
    folder = tmp_path / "html"
    (folder / "sub").mkdir(parents=True)
    (folder / "index.html").write_text(
        f'<p>Home</p><p class="offline-offer"><a href="{ARCHIVE}">x</a>'
    )
    (folder / "sub/page.html").write_text("<p>Page")
    (folder / "picture.png").write_bytes(b"\x89PNG")
    return folder


def test_all_files_are_packed_but_the_archive_itself(html):
    pack(html)
    archive = pack(html)
    assert archive == html / ARCHIVE
    with zipfile.ZipFile(archive) as packed:
        names = packed.namelist()
        assert packed.read(f"{FOLDER}/picture.png") == b"\x89PNG"
        assert packed.read(f"{FOLDER}/sub/page.html") == b"<p>Page"
        # A packed page does not offer what it is part of.
        assert packed.read(f"{FOLDER}/index.html") == b"<p>Home</p>"
    assert "offline-offer" in (html / "index.html").read_text()
    assert names == [f"{FOLDER}/{name}" for name in ("index.html", "picture.png", "sub/page.html")]


def test_the_same_site_makes_the_same_bytes(html):
    first = pack(html).read_bytes()
    (html / "picture.png").touch()
    assert pack(html).read_bytes() == first
