"""A build has no work only where every input and every file of the site is what it was."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from loading import ENGINE, JUPYTER, run_watched
from tiny_book import cell, make_book, notebook

from robo_genesis.build import up_to_date
from robo_genesis.build.stages import Build, run_build
from robo_genesis.core.project import ROOT

ENVIRONMENT = {"SITE_URL": "https://example.org/"}


def git(root: Path, *words: str) -> None:
    own = ["-c", "user.name=a", "-c", "user.email=a@b"]
    subprocess.run(["git", "-C", str(root), *own, *words], check=True, capture_output=True)


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
        "robo_genesis/evidence/manifest_rules.py",
        "build_scripts/book.py",
    ):
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(name)
    monkeypatch.setattr(sys, "path", [str(tmp_path / "packages")])
    (tmp_path / "packages" / "genesis-1.dist-info").mkdir(parents=True)
    git(root, "init", "--quiet")
    (root / ".git" / "info" / "exclude").write_text("_build*\n*.tmp\n")
    git(root, "add", ".")
    git(root, "commit", "--quiet", "-m", "first")
    return root


def digest(root: Path, **more: str) -> str | None:
    return up_to_date.inputs_digest(root, root / "book", ENVIRONMENT | more)


def files(root: Path) -> list[Path]:
    return [p for p in root.rglob("*") if p.is_file() and ".git" not in p.relative_to(root).parts]


def test_the_same_inputs_have_the_same_digest_whatever_their_times(root):
    before = digest(root)
    for path in files(root):
        os.utime(path, (1, 1))
    (root / "book" / "_build").mkdir()
    (root / "book" / "_build" / "page.html").write_text("a site is no input")
    (root / "book" / "_build.old").mkdir()
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


def replace_package(root: Path) -> None:
    folder = root.parent / "packages"
    (folder / "genesis-1.dist-info").rename(folder / "genesis-2.dist-info")


def install_again(root: Path) -> None:
    os.utime(root.parent / "packages" / "genesis-1.dist-info", (1, 1))


CHANGES: dict[str, Callable[[Path], None]] = {
    "a new page": lambda root: (root / "book" / "new.md").write_text(""),
    "a new file that git ignores": lambda root: (root / "book" / "new.tmp").write_text(""),
    "a new module": lambda root: (root / "robo_genesis" / "new.py").write_text(""),
    "an edit committed": lambda root: git(root, "commit", "--allow-empty", "-m", "second"),
    "an edit staged": lambda root: git(root, "rm", "--cached", "book/index.md"),
    "another version of a package": replace_package,
    "a package installed again": install_again,
    "no history": lambda root: shutil.rmtree(root / ".git"),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=list(CHANGES))
def test_each_other_change_is_work(root, change):
    before = digest(root)
    change(root)
    assert digest(root) not in (before, None)


@pytest.mark.parametrize("name", [*up_to_date.VARIABLES, "ROBO_GENESIS_RENDER", "QD_ARCH"])
def test_each_variable_that_decides_the_site_is_work(root, name):
    assert digest(root) != digest(root, **{name: "0"})


def test_another_python_is_work(root, monkeypatch):
    before = digest(root)
    monkeypatch.setattr(sys, "executable", "/another/python")
    assert digest(root) != before


def test_what_a_link_leads_to_is_not_seen_and_so_always_work(root, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (root / "book" / "evidence" / "l05").symlink_to(tmp_path / "elsewhere")
    assert digest(root) is None


@pytest.fixture
def published(tmp_path) -> Path:
    folder = tmp_path / "_build"
    for name in ("html/index.html", "html/_static/a.css", "evidence/l04/cpu/log.txt", "pages/a"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    up_to_date.keep(folder, "inputs", ["the last lines"])
    return folder


def test_a_site_stands_as_long_as_inputs_and_site_are_what_they_were(published):
    assert up_to_date.standing(published, "inputs") == ["the last lines"]
    assert up_to_date.standing(published, "others") is None
    assert up_to_date.standing(published, None) is None


def remove(path: Path) -> None:
    path.unlink()


def edit(path: Path) -> None:
    path.write_text(path.read_text().upper())


def add(path: Path) -> None:
    path.with_name("more").write_text("")


@pytest.mark.parametrize("change", [remove, edit, add])
@pytest.mark.parametrize("name", ["html/index.html", "evidence/l04/cpu/log.txt", "pages/a"])
def test_each_change_of_the_site_is_work(published, name, change):
    change(published / name)
    assert up_to_date.standing(published, "inputs") is None


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"inputs": "inputs"}'])
def test_a_record_that_cannot_be_read_is_work(published, text):
    (published / up_to_date.RECORD).write_text(text)
    assert up_to_date.standing(published, "inputs") is None


def test_inputs_that_are_not_known_leave_no_record(published):
    (published / up_to_date.RECORD).unlink()
    up_to_date.keep(published, None, [])
    assert not (published / up_to_date.RECORD).exists()


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("built")
    make_book(folder, page=notebook(cell("print('seen')")))
    run_build(Build(book=folder / "book", cache=folder / "cache", say=lambda line: None))
    return folder


def make_book_command(folder: Path, **more: str) -> str:
    script = [sys.executable, str(ROOT / "build_scripts" / "book.py")]
    script += ["--book", str(folder / "book"), "--cache", str(folder / "cache")]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "RENDER": "1", "RELEASE": "0"} | more
    done = subprocess.run(script, env=environment, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def test_a_second_build_says_that_nothing_changed_with_the_usual_last_lines(built):
    said = make_book_command(built).splitlines()
    assert said[0] == "Nothing changed: the site stands."
    assert said[1] == f"Site: {built / 'book/_build/html/index.html'}"
    assert "Pages: 0 executed, 1 reused." in said


def test_a_release_is_built_whether_anything_changed_or_not(built):
    assert "Nothing changed" not in make_book_command(built, RELEASE="1")


def test_a_page_that_is_edited_while_its_build_runs_is_built_again(tmp_path):
    book = make_book(tmp_path, page=notebook(cell("print('seen')")))

    def edit_meanwhile(line: str) -> None:
        if "render" in line:
            (book / "index.md").write_text("# Home\n\nEdited meanwhile.\n")

    run_build(Build(book=book, cache=tmp_path / "cache", say=edit_meanwhile))
    assert not (book / "_build" / up_to_date.RECORD).exists()


def test_a_build_without_work_loads_neither_engine_nor_sphinx_nor_jupyter(built):
    wishes = {"RENDER": "1", "RELEASE": "0"}
    said, loaded = run_watched("book.py", "--book", str(built / "book"), **wishes)
    assert said.startswith("Nothing changed")
    assert not loaded & {*ENGINE, *JUPYTER, "numpy"}
