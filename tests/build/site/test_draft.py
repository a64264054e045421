"""A draft gets what Sphinx changes while it is copied, and never changes what is published."""

import hashlib
import shutil
from pathlib import Path

import pytest

from robo_genesis.build.site.archive import ARCHIVE
from robo_genesis.build.site.draft import BUILD_INFO, Draft

FILES = {
    "index.html": "home",
    "lessons/one.html": "one",
    "replay/model.glb": "a robot",
    "_static/site.css": "p {}",
}


@pytest.fixture
def rendered(tmp_path):
    folder = tmp_path / "rendered"
    write(folder, FILES)
    return folder


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def content(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file())
    return {p.relative_to(folder).as_posix(): p.read_text() for p in files}


def rewrite(rendered: Path) -> None:
    """Do what Sphinx does: change, add and remove pages, and write style sheets again."""
    shutil.rmtree(rendered / "_static")
    (rendered / "lessons/one.html").unlink()
    write(rendered, FILES | {"lessons/one.html": "two", "lessons/added.html": "new"})
    (rendered / "index.html").unlink()


@pytest.mark.parametrize("early", [True, False], ids=["prepared", "from nothing"])
def test_a_draft_is_what_sphinx_leaves_whether_it_was_prepared_or_not(tmp_path, rendered, early):
    (rendered / BUILD_INFO).write_text("a note")
    draft = Draft(rendered, tmp_path / "draft", tmp_path / "none")
    if early:
        draft.prepare()
        assert (draft.html / "index.html").read_text() == "home"
    rewrite(rendered)
    draft.complete()
    found = {name: text for name, text in content(rendered).items() if name != BUILD_INFO}
    (draft.html / ARCHIVE).unlink(missing_ok=True)
    assert content(draft.html) == found
    assert found["lessons/one.html"] == "two"
    assert draft.digests == {n: hashlib.sha256(t.encode()).hexdigest() for n, t in found.items()}


@pytest.mark.parametrize("model", ["a robot", "another robot"])
def test_the_archive_is_the_same_however_early_it_was_begun(tmp_path, rendered, model):
    drafts = [Draft(rendered, tmp_path / name, tmp_path / "none") for name in ("early", "late")]
    drafts[0].prepare()
    rewrite(rendered)
    write(rendered, {"replay/model.glb": model})
    early, late = (draft.complete().pack().read_bytes() for draft in drafts)
    assert early == late


def test_equal_files_are_links_to_the_published_ones_which_nothing_changes(tmp_path, rendered):
    published = tmp_path / "published"
    shutil.copytree(rendered, published / "html")
    write(published / "html", {"lessons/one.html": "an older page"})
    before = content(published)
    draft = Draft(rendered, tmp_path / "draft", published)
    draft.prepare()
    links = {n: (draft.html / n).samefile(published / "html" / n) for n in FILES}
    assert links == dict.fromkeys(FILES, True) | {"lessons/one.html": False}
    write(rendered, {"index.html": "another home"})
    draft.complete().pack()
    assert (draft.html / "index.html").read_text() == "another home"
    assert content(published) == before


def test_a_draft_shares_no_file_with_what_sphinx_writes(tmp_path, rendered):
    draft = Draft(rendered, tmp_path / "draft", tmp_path / "none").complete()
    assert not any((draft.html / name).samefile(rendered / name) for name in FILES)
