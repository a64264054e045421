"""A lesson made from the template is complete; a name that cannot be used changes nothing."""

import sys

import pytest
import yaml
from checkout import copy_checkout, make, run_in
from tiny_book import contents

from robo_genesis.core.project import BOOK, ProjectError
from robo_genesis.maintain.new_lesson import add_lesson, with_chapter, with_entry

TOC, COURSE_MAP = (BOOK / name for name in ("_toc.yml", "course_map.yml"))
MAP = COURSE_MAP.read_text() + "- id: L98\n  title: A lesson that is planned\n"
ROWS, PLANNED = yaml.safe_load(MAP), "l98"
LAST = [row["id"] for row in ROWS if "page" in row][-1].lower()


@pytest.fixture(scope="module")
def work(tmp_path_factory):
    """A copy of the checkout with one more lesson."""
    work = copy_checkout(tmp_path_factory.mktemp("checkout") / "with a space")
    said = make(work, "lesson", "NEW=l99")
    assert "Lesson l99 was added" in said
    return work


LINT = "from importlinter.cli import lint_imports_command; lint_imports_command()"
OWN = ("robo_genesis/lessons/l99", "tests/lessons/l99")
TESTS = [
    f"tests/{place}"
    for place in (
        "lessons/l99",
        "lessons/test_registry.py",
        "lessons/test_prose.py",
        "lessons/test_loaded_modules.py",
        "site/course/test_course_map.py::"
        "test_the_course_s_map_names_the_lessons_that_are_published",
    )
]


@pytest.mark.parametrize(
    "command",
    [
        ("-m", "ruff", "check", "--no-cache", *OWN),
        ("-m", "ruff", "format", "--no-cache", "--check", *OWN),
        ("-m", "mypy", "--cache-dir=/dev/null", "-p", "robo_genesis.lessons.l99"),
        ("-c", LINT, "--no-logo", "--no-cache"),
        ("-m", "robo_genesis", "sizes"),
        ("-m", "pytest", "-p", "no:cacheprovider", "-m", "not engine", *TESTS),
    ],
    ids=lambda words: words[1].partition(" ")[0],
)
def test_the_lesson_is_clean_and_its_tests_pass(work, command):
    run_in(work, sys.executable, *command)


@pytest.fixture
def small(tmp_path):
    """The files that adding a lesson reads and changes."""
    for place in (
        "robo_genesis/lessons/l04",
        "book/lessons/l07-old",
        "tests/lessons/l08",
    ):
        (tmp_path / place).mkdir(parents=True)
    for path in (TOC, COURSE_MAP):
        (tmp_path / "book" / path.name).write_bytes(path.read_bytes())
    return tmp_path


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("", "NEW='' is not valid: write `l` and two digits"),
        ("../l05", "is not valid"),
        ("l04", "Lesson l04 exists: robo_genesis/lessons/l04"),
        ("l07", "Lesson l07 exists: book/lessons/l07-old"),
        ("l08", "Lesson l08 exists: tests/lessons/l08"),
    ],
)
def test_a_name_that_cannot_be_used_changes_nothing(small, name, message):
    before = contents(small)
    with pytest.raises(ProjectError) as raised:
        add_lesson(small, name)
    assert message in str(raised.value)
    assert contents(small) == before


@pytest.mark.parametrize(
    ("lesson", "before"), [("l00", None), (PLANNED, LAST), ("l99", LAST)]
)
def test_the_lists_stay_in_order(lesson, before):
    toc = yaml.safe_load(with_chapter(TOC.read_text(), lesson))["chapters"]
    names = [chapter["file"] for chapter in toc]
    at = names.index(f"lessons/{lesson}-new-lesson/lecture")
    assert names[at - 1].startswith(f"lessons/{before}") if before else at == 0

    rows, before = (
        {row["id"]: row for row in yaml.safe_load(text)}
        for text in (with_entry(MAP, lesson), MAP)
    )
    name = lesson.upper()
    assert [*rows] == sorted(rows)
    assert rows == before | {name: rows[name]}
