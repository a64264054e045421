"""SHA256SUMS covers each file of a site, as `sha256sum -c` reads it."""

import shutil
import subprocess

import pytest

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.archive import ARCHIVE, pack
from robo_genesis.pipeline.html.sums import SUMS, write_sums


@pytest.fixture
def html(tmp_path):
    folder = tmp_path / "html"
    (folder / "sub").mkdir(parents=True)
    (folder / "index.html").write_text("<p>Home")
    (folder / "sub/a page.html").write_text("<p>Page")
    (folder / ".hidden").write_text("hidden")
    pack(folder)
    write_sums(folder)
    return folder


def test_every_file_but_the_list_is_listed_in_order(html):
    write_sums(html)  # again, which changes nothing
    names = [line.split("  ", 1)[1] for line in (html / SUMS).read_text().splitlines()]
    assert names == sorted([".hidden", "index.html", ARCHIVE, "sub/a page.html"])
    command = [shutil.which("sha256sum"), "--check", "--strict", SUMS]
    done = subprocess.run(command, cwd=html, capture_output=True, text=True, check=True)
    assert done.stdout.count(": OK") == 4


@pytest.mark.parametrize("name", ["a\nb", "a\\b", "link"])
def test_a_name_that_the_form_cannot_hold_is_refused(html, name):
    if name == "link":
        (html / name).symlink_to(html / "index.html")
    else:
        (html / name).touch()
    with pytest.raises(ProjectError, match="Rename or copy it"):
        write_sums(html)
