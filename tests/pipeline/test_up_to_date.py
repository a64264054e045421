"""A build has no work only where every input and every file of the site is what it was."""

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import pytest
from tiny_book import commit, git

from robo_genesis.pipeline import up_to_date

ENVIRONMENT = {"SITE_URL": "https://example.org/"}


@pytest.fixture
def root(tmp_path, monkeypatch) -> Path:
    """A checkout with one file of each kind that a build reads, in one commit."""
    root = tmp_path / "checkout"
    for name in (
        *up_to_date.FILES,
        "book/index.md",
        "book/_config.yml",
        "book/_static/course.css",
        "book/evidence/l04/amdgpu/manifest.json",
        "book/course_map.yml",
        "robo_genesis/lessons/l04/spec.py",
        "robo_genesis/evidence/recompute.py",
        "build_scripts/book.py",
    ):
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(name)
    monkeypatch.setattr(sys, "path", [str(tmp_path / "packages")])
    (tmp_path / "packages" / "genesis-1.dist-info").mkdir(parents=True)
    commit(root)
    (root / ".git" / "info" / "exclude").write_text("_build*\n*.tmp\n")
    return root


def digest(root: Path, **more: str) -> str:
    with patch.dict(os.environ, ENVIRONMENT | more):
        return up_to_date.inputs_digest(root, root / "book")


def files(root: Path) -> list[Path]:
    return [
        p
        for p in root.rglob("*")
        if p.is_file() and ".git" not in p.relative_to(root).parts
    ]


def test_the_same_inputs_have_the_same_digest_whatever_their_times(root):
    before = digest(root)
    for path in files(root):
        os.utime(path, (1, 1))
    (root / "book" / "_build").mkdir()
    (root / "book" / "_build" / "page.html").write_text("a site is no input")
    (root / "book" / "._build.old").mkdir()
    (root / "robo_genesis" / "__pycache__").mkdir()
    (root / "robo_genesis" / "__pycache__" / "l04.pyc").write_text("no more is this")
    assert digest(root) == before


def test_each_file_that_is_edited_or_removed_is_work(root):
    found = {digest(root)}
    for number, path in enumerate(paths := files(root)):
        text = path.read_text()
        path.write_text("another text")
        found.add(digest(root))
        path.unlink()
        found.add(digest(root))
        path.write_text(text)
        assert len(found) == 2 * number + 3, path
    assert len(paths) == len(up_to_date.FILES) + 8


INSTALLED, UPGRADED = (f"../packages/genesis-{n}.dist-info" for n in (1, 2))
CHANGES: dict[str, Callable[[Path], None]] = {
    "a new page": lambda root: (root / "book" / "new.md").write_text(""),
    "a new file that git ignores": lambda root: (root / "book" / "new.tmp").write_text(
        ""
    ),
    "a new module": lambda root: (root / "robo_genesis" / "new.py").write_text(""),
    "an edit committed": lambda root: git(
        root, "commit", "--allow-empty", "-m", "second"
    ),
    "another version of a package": lambda root: (root / INSTALLED).rename(
        root / UPGRADED
    ),
    "a package installed again": lambda root: os.utime(root / INSTALLED, (1, 1)),
    "no history": lambda root: shutil.rmtree(root / ".git"),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=list(CHANGES))
def test_each_other_change_is_work(root, change):
    before = digest(root)
    change(root)
    assert digest(root) != before


def test_each_variable_that_decides_the_site_and_another_python_is_work(
    root, monkeypatch
):
    names = [*up_to_date.VARIABLES, "ROBO_GENESIS_RENDER", "QD_ARCH"]
    found = {digest(root), *(digest(root, **{name: "0"}) for name in names)}
    monkeypatch.setattr(sys, "executable", "/another/python")
    assert len({*found, digest(root)}) == len(names) + 2


@pytest.fixture
def published(tmp_path, monkeypatch) -> Path:
    monkeypatch.setattr(up_to_date, "inputs_digest", lambda root, book: root)
    folder = tmp_path / "_build"
    for name in (
        "html/index.html",
        "html/_static/a.css",
        "evidence/l04/cpu/log.txt",
        "pages/a",
    ):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    up_to_date.record(folder, "inputs", ["the last lines"])
    return folder


def last_lines(published: Path, inputs: str = "inputs") -> list[str]:
    return up_to_date.nothing_changed(inputs, published, published)[2:]


def test_a_site_stands_as_long_as_inputs_and_site_are_what_they_were(published):
    assert last_lines(published) == ["the last lines"]
    assert last_lines(published, "others") == []


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("html/index.html", Path.unlink),
        ("evidence/l04/cpu/log.txt", lambda path: path.write_text("new")),
        ("pages/a", lambda path: path.with_name("new").touch()),
        (up_to_date.RECORD, lambda path: path.write_text("{}")),
    ],
)
def test_each_change_of_the_site_and_a_record_that_cannot_be_read_is_work(
    published, name, change
):
    change(published / name)
    assert last_lines(published) == []
