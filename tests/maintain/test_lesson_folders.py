"""A lesson is a folder: in a copy of the checkout all but one are removed, and one is added.

The book is built as `make book` does it. Pages that the checkout has executed are
copied, so that a build executes the pages alone whose code changed."""

import shutil

import pytest
import yaml
from built_site import parsed
from checkout import copy_checkout, make

from robo_genesis.core.project import CACHE
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline import npm
from robo_genesis.pipeline.pages.book import find_pages

pytestmark = pytest.mark.engine

KEPT = "l01"


def edit(path, change):
    path.write_text(
        yaml.safe_dump(change(yaml.safe_load(path.read_text())), sort_keys=False)
    )


def keep_one(work):
    """Remove the folders of the other lessons, and their lines in the two lists of the book."""
    for place in (
        "robo_genesis/lessons",
        "book/lessons",
        "book/evidence",
        "tests/lessons",
    ):
        for folder in (work / place).glob("l[0-9]*"):
            if not folder.name.startswith(KEPT):
                shutil.rmtree(folder)

    def chapters(toc):
        others = tuple(f"lessons/{name}" for name in LESSONS if name != KEPT)
        kept = [c for c in toc["chapters"] if not c["file"].startswith(others)]
        return toc | {"chapters": kept}

    edit(work / "book" / "_toc.yml", chapters)
    edit(
        work / "book" / "course_map.yml",
        lambda rows: [row for row in rows if row["id"] == KEPT.upper()],
    )


def test_a_new_lesson_is_on_the_site_at_once(tmp_path, build_output):
    work = copy_checkout(tmp_path / "checkout")
    keep_one(work)
    make(work, "lesson", "NEW=l99")
    cache = work / ".cache"
    cache.mkdir(exist_ok=True)
    (cache / "npm").symlink_to(npm.packages().parents[1])
    (cache / "engine").symlink_to(CACHE / "engine")
    shutil.copytree(CACHE / "pages", cache / "pages", symlinks=True)
    said, site = make(work, "book"), work / "book" / "_build" / "html"
    kept = [page.lesson == KEPT for page in find_pages(work / "book")]
    assert f"Pages: {kept.count(False)} executed, {kept.count(True)} reused." in said
    card = parsed(site, "index").select_one("#lesson-l99")
    assert card.a["href"] == "lessons/l99-new-lesson/lecture.html"
    assert card.select_one("p.time").get_text().startswith("Lecture: ")
    lecture = parsed(site, "lessons/l99-new-lesson/lecture")
    assert lecture.select_one(".evidence-badge").get_text() == "cpu-verified"
    assert lecture.select_one(".replay")
    assert lecture.select_one(".measured")
    for page in ("lecture", "lab", "mistakes"):
        assert (
            "L99 CHECK: PASSED"
            in parsed(site, f"lessons/l99-new-lesson/{page}").get_text()
        )
        assert f"lessons/l99-new-lesson/{page}" in (site / "searchindex.js").read_text()
        assert f"l99/{page}" in parsed(site, "evidence/ledger").get_text()
    taken = {path.name for path in (site / "takeaways" / "l99-lab").iterdir()}
    assert {"l99-lab.ipynb", "l99-lab-executed.ipynb", "baseline.npz"} <= taken
