"""A draft is in the end what Sphinx leaves, whatever it had copied before."""

import hashlib
import shutil
from pathlib import Path

import pytest

from robo_genesis.pipeline.html.archive import ARCHIVE
from robo_genesis.pipeline.html.draft import BUILD_INFO, Draft

FILES = {
    "index.html": "home",
    "lessons/one.html": "one",
    "replay/model.glb": "a robot",
    "takeaways/lab/lab.ipynb": "a lab",
    "_static/site.css": "p {}",
    "notes": "a file",
    "figures/a": "a folder",
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


def content(folder: Path) -> dict[str, str | None]:
    """Return the text of each file except the archive, and None for each folder but its own."""
    return {
        p.relative_to(folder).as_posix(): p.read_text() if p.is_file() else None
        for p in folder.rglob("*")
        if not (folder / ARCHIVE).is_relative_to(p)
    }


def rewrite(rendered: Path) -> None:
    """Change, add and remove pages, write style sheets again, and exchange files and folders."""
    shutil.rmtree(rendered / "_static")
    shutil.rmtree(rendered / "takeaways")
    shutil.rmtree(rendered / "figures")
    for name in ("index.html", "notes"):
        (rendered / name).unlink()
    write(
        rendered,
        {
            "_static/site.css": "p {}",
            "lessons/one.html": "two",
            "lessons/more.html": "",
        },
    )
    write(rendered, {"notes/a": "a folder", "figures": "a file"})


@pytest.mark.parametrize("early", [True, False], ids=["copied before", "from nothing"])
def test_a_draft_is_what_sphinx_leaves_whether_it_was_copied_before_or_not(
    tmp_path, rendered, early
):
    (rendered / BUILD_INFO).write_text("a note")
    draft = Draft(rendered, tmp_path / "draft")
    if early:
        draft.complete()
        assert (draft.html / "index.html").read_text() == "home"
    rewrite(rendered)
    draft.complete()
    found = {
        name: text for name, text in content(rendered).items() if name != BUILD_INFO
    }
    assert content(draft.html) == found
    assert not (draft.html / "replay/model.glb").samefile(rendered / "replay/model.glb")
    assert found["lessons/one.html"] == "two"
    files = {name: text for name, text in found.items() if text is not None}
    assert draft.digests == {
        n: hashlib.sha256(t.encode()).hexdigest() for n, t in files.items()
    }


def test_what_cannot_be_read_in_the_end_fails(tmp_path, rendered):
    draft = Draft(rendered, tmp_path / "draft")
    (rendered / "lessons/two.html").symlink_to("nothing")
    with pytest.raises(FileNotFoundError, match="two"):
        draft.complete()
    shutil.rmtree(rendered)
    with pytest.raises(FileNotFoundError, match="rendered"):
        draft.complete()
