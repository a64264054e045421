"""A release is built from the commit alone, whatever checkout, git settings and caches hide."""

import json
import os
import py_compile
import shutil
from pathlib import Path

import pytest
from checkout import copy_checkout, run_in
from tiny_book import cell, commit, git, make_book, notebook

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline import fresh_checkout, npm
from robo_genesis.pipeline.fresh_checkout import FOLDER, check_out, release

SCRIPT = """\
import json, os, sys
from pathlib import Path
import course
here = Path.cwd()
found = {
    "code": course.VALUE,
    "page": (here / "page.md").read_text(),
    "files": sorted(p.relative_to(here).as_posix() for p in here.rglob("*")
                    if p.is_file() and ".git" not in p.relative_to(here).parts),
    "environment": dict(os.environ),
    "arguments": sys.argv[1:],
    "here": str(here),
}
Path(sys.argv[1], "found.json").write_text(json.dumps(found))
sys.exit(int(os.environ.get("JOBS") or "0"))
"""
FILES = [".gitignore", "build_scripts/book.py", "course.py", "page.md"]


@pytest.fixture
def root(tmp_path) -> Path:
    root = tmp_path / "a checkout"
    (root / "build_scripts").mkdir(parents=True)
    (root / "build_scripts" / "book.py").write_text(SCRIPT)
    (root / "course.py").write_text("VALUE = 1\n")
    (root / "page.md").write_text("committed\n")
    (root / ".gitignore").write_text("/.cache\n__pycache__/\n")
    commit(root)
    return root


def built(root: Path, status: int = 0, **handed: Path) -> dict:
    """Release a checkout and return what its build found."""
    assert release([str(root.parent)], root / ".cache", root, **handed) == status
    return json.loads((root.parent / "found.json").read_text())


def hidden_changes(root, monkeypatch):
    """Hide changes of tracked files from git, and put ignored files where a checkout writes."""
    git(root, "update-index", "--skip-worktree", "page.md", "course.py")
    (root / "page.md").write_text("changed\n")
    (root / "course.py").write_text("VALUE = 2\n")
    (root / ".git" / "info" / "exclude").write_text("new.md\n")
    left = root / ".cache" / FOLDER / "checkout"  # by a release that failed
    for path in (
        root / "new.md",
        left / "left.md",
        root / ".cache" / "pages" / "forged",
    ):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()


def stale_bytecode(root, monkeypatch):
    other = root.parent / "path" / "course.py"
    other.parent.mkdir()
    other.write_text("VALUE = 2\n")
    cached = root / "__pycache__" / f"course.{os.sys.implementation.cache_tag}.pyc"
    unchecked = py_compile.PycInvalidationMode.UNCHECKED_HASH
    py_compile.compile(str(other), str(cached), invalidation_mode=unchecked)
    monkeypatch.setenv("PYTHONPATH", str(other.parent))
    monkeypatch.setenv("PYTHONPYCACHEPREFIX", str(other.parent))


def other_repository(root, monkeypatch):
    other = root.parent / "other"
    other.mkdir()
    (other / "page.md").write_text("other\n")
    commit(other)
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    monkeypatch.setenv("GIT_WORK_TREE", str(other))
    monkeypatch.setenv("GIT_INDEX_FILE", str(other / ".git" / "index"))


def replaced_object(root, monkeypatch):
    (root / "page.md").write_text("changed\n")
    blob = git(root, "hash-object", "-w", "page.md").strip()
    git(root, "replace", git(root, "rev-parse", "HEAD:page.md").strip(), blob)
    (root / "page.md").write_text("committed\n")
    git(root, "update-index", "--assume-unchanged", "page.md")


def user_settings(root, monkeypatch):
    home = root.parent / "home"
    (home / "hooks").mkdir(parents=True)
    hook = home / "hooks" / "post-checkout"
    hook.write_text("#!/bin/sh\necho hooked > page.md\n")
    hook.chmod(0o755)
    (home / "attributes").write_text("* filter=spoil\n")
    (home / ".gitconfig").write_text(
        f"[core]\nhooksPath = {home / 'hooks'}\nattributesFile = {home / 'attributes'}\n"
        '[filter "spoil"]\nsmudge = sed s/committed/smudged/\nclean = sed s/smudged/committed/\n'
    )
    monkeypatch.setenv("HOME", str(home))


SPOILS = [
    hidden_changes,
    stale_bytecode,
    other_repository,
    replaced_object,
    user_settings,
]


@pytest.mark.parametrize("spoil", SPOILS)
def test_a_release_sees_the_files_of_its_commit_and_no_others(root, monkeypatch, spoil):
    spoil(root, monkeypatch)
    found = built(root)
    assert (found["code"], found["page"], found["files"]) == (1, "committed\n", FILES)
    assert not any(name.startswith("GIT_") for name in found["environment"])
    assert not (root / ".cache" / FOLDER).exists()


def test_a_release_reuses_compiled_kernels_and_gets_only_listed_variables(
    root, monkeypatch
):
    (root / ".cache" / "engine" / "kernels").mkdir(parents=True)
    monkeypatch.setenv("SECRET", "a")
    monkeypatch.setenv("SITE_URL", "https://example.org/")
    monkeypatch.setenv("https_proxy", "http://proxy")
    monkeypatch.chdir(root.parent)
    given = built(root, executed=Path("executed"), second=Path("again"))["environment"]
    assert given["EXECUTED"] == str(root.parent / "executed")
    assert given["SECOND"] == str(root.parent / "again")
    assert "SECRET" not in given
    assert given["SITE_URL"] == "https://example.org/"
    assert given["https_proxy"] == "http://proxy"
    assert given["PYTHONPATH"].startswith(str(root / ".cache" / FOLDER))
    assert given["PYTHONPYCACHEPREFIX"].startswith(str(root / ".cache" / FOLDER))
    assert (root / ".cache" / "engine" / "kernels").is_dir()


def test_a_release_that_fails_leaves_its_checkout_for_the_report(root, monkeypatch):
    monkeypatch.setenv("JOBS", "3")
    found = built(root, status=3)
    assert Path(found["here"]).is_dir()


@pytest.mark.parametrize("spoil", [lambda *given: None, other_repository])
def test_a_changed_tree_is_refused(root, monkeypatch, spoil):
    (root / "page.md").write_text("changed\n")
    spoil(root, monkeypatch)
    with pytest.raises(
        ProjectError, match=r"RELEASE=1 cannot be met\.\n.* 1 changed .*page\.md"
    ):
        release([], root / ".cache", root)


def test_a_release_of_executed_pages_runs_nothing_and_shows_their_output(
    tmp_path, monkeypatch
):
    """Each run of the page prints another number."""
    root = copy_checkout(tmp_path / "root")
    shutil.rmtree(root / "book")
    book = make_book(root, page=notebook(cell("import uuid\nprint(uuid.uuid4())")))
    commit(root)
    executed, cache = tmp_path / "executed", root / ".cache"
    run_in(
        root, "env", "PAGE=page", f"TO={executed}", "python", "build_scripts/execute.py"
    )
    [ran] = executed.rglob("executed.ipynb")
    [said] = json.loads(ran.read_text())["cells"][0]["outputs"][0]["text"]
    (cache / "npm").symlink_to(npm.packages().parents[1])  # which a release fetches

    def with_npm(root, folder, cache, shared):
        return check_out(root, folder, cache, [*shared, "npm"])

    monkeypatch.setattr(fresh_checkout, "check_out", with_npm)
    assert release(["--to", str(book)], cache, root, executed=executed) == 0
    assert said.strip() in (book / "_build/html/page.html").read_text()
