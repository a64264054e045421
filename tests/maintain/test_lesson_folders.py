"""A lesson is a folder: one is removed from a copy of the checkout, and one is added to another.

Both books are built as `make book` does it. Pages that the checkout has executed are
copied, so that a build executes the pages alone whose code changed."""

import shutil

import pytest
import yaml
from built_site import parsed
from checkout import copy_checkout, import_contracts, make, run_in, unit_tests

from robo_genesis.core.project import CACHE
from robo_genesis.lessons import LESSONS
from robo_genesis.pipeline import npm
from robo_genesis.pipeline.pages.book import find_pages

pytestmark = pytest.mark.engine

REMOVED, KEPT = "l03", "l01"
UNIT_TESTS = (
    "core",
    "evidence",
    "lessons",
    "maintain",
    "sim",
    "site",
    "test_imports.py",
)


def edit(path, change):
    path.write_text(
        yaml.safe_dump(change(yaml.safe_load(path.read_text())), sort_keys=False)
    )


def remove(work, lesson):
    """Remove the folders of a lesson and its lines in the two lists of the book."""
    for place in (
        "robo_genesis/lessons",
        "book/lessons",
        "book/evidence",
        "tests/lessons",
    ):
        for folder in (work / place).glob(f"{lesson}*"):
            shutil.rmtree(folder)

    def chapters(toc):
        kept = [
            c for c in toc["chapters"] if not c["file"].startswith(f"lessons/{lesson}-")
        ]
        return toc | {"chapters": kept}

    def entries(rows):
        name = lesson.upper()
        for row in rows:
            if "needs" in row:
                row["needs"] = [need for need in row["needs"] if need != name]
        return [row for row in rows if row["id"] != name]

    edit(work / "book" / "_toc.yml", chapters)
    edit(work / "book" / "course_map.yml", entries)


def build(work):
    """Build the book of a copy; return its site and what the build said."""
    cache = work / ".cache"
    shutil.rmtree(cache, ignore_errors=True)  # of the copy's own tests
    cache.mkdir()
    (cache / "npm").symlink_to(npm.packages().parents[1])
    (cache / "engine").symlink_to(CACHE / "engine")
    shutil.copytree(CACHE / "pages", cache / "pages", symlinks=True)
    said = make(work, "book")
    return work / "book" / "_build" / "html", said


@pytest.mark.slow
def test_the_rest_of_the_course_does_without_a_lesson(tmp_path, build_output):
    work = copy_checkout(tmp_path / "checkout")
    remove(work, REMOVED)
    import_contracts(work)
    run_in(work, "python", "-m", "ruff", "check", "--no-cache", ".")
    git_needed = "--ignore=tests/maintain/test_new_lesson.py"
    places = (f"tests/{place}" for place in UNIT_TESTS)
    assert "passed" in unit_tests(work, *places, git_needed)
    site, _ = build(work)
    cards = [card["id"] for card in parsed(site, "index").select("ul.course-map > li")]
    assert f"lesson-{REMOVED}" not in cards
    assert {f"lesson-{name}" for name in LESSONS if name != REMOVED} <= {*cards}
    assert f"{REMOVED}/lab" not in parsed(site, "evidence/ledger").get_text()


def test_a_new_lesson_is_on_the_site_at_once(tmp_path, build_output):
    work = copy_checkout(tmp_path / "checkout")
    for lesson in LESSONS:
        if lesson != KEPT:
            remove(work, lesson)
    make(work, "lesson", "NEW=l99")
    site, said = build(work)
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
    assert {"l99-lab.ipynb", "l99-lab-executed.ipynb", "baseline.csv"} <= taken
