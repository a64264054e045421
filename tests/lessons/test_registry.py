"""The list of lessons: each entry is complete, and its pages are the book's."""

import ast

import pytest

from robo_genesis.core.checks import claim_of
from robo_genesis.core.comparison import HELD_BY
from robo_genesis.core.palette import CASE_CLASSES
from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.lessons import (
    LESSONS,
    course_marks,
    find_lesson,
    find_replay,
)
from robo_genesis.pipeline.pages.book import find_pages


def test_the_pages_that_measure_are_those_of_the_book():
    declared = {
        (page.lesson, page.page) for page in find_pages(BOOK) if page.declares_bundle
    }
    assert declared == {
        (name, page) for name in LESSONS for page in find_lesson(name).pages
    }


@pytest.mark.parametrize("name", LESSONS)
def test_cases_and_metrics_of_a_lesson_exist(name):
    lesson = find_lesson(name)
    for page in lesson.pages.values():
        assert page.parameters()
    units = lesson.about_metrics("unit")
    for replay in lesson.replays.values():
        assert any({*replay.cases} <= {*page.runs} for page in lesson.pages.values())
        replay.quality.format_map(units)  # a name that is no metric raises KeyError
    assert lesson.replays
    assert lesson.metrics.keys() >= lesson.spec.CASES.keys()
    marks = getattr(lesson.spec, "CASE_MARKS", {})
    assert marks.keys() <= {
        name for page in lesson.pages.values() for name in page.runs
    }
    assert {*marks.values()} <= CASE_CLASSES.keys()
    for (first, second), metric, order, margin in lesson.spec.RELATIONS:
        assert {first, second} <= {*lesson.spec.CASES}
        units = {lesson.metrics[case].about("unit")[metric] for case in (first, second)}
        assert order in HELD_BY
        assert margin > lesson.spec.RESOLUTION[units.pop()]
        assert not units
    assert {*lesson.about_metrics("unit").values()} <= lesson.spec.RESOLUTION.keys()
    sources = {name for of in lesson.about_metrics("sources").values() for name in of}
    kinds = {
        run.kind or page.kind
        for page in lesson.pages.values()
        for run in page.runs.values()
    }
    assert sources <= {of.name for kind in kinds for of in kind.arrays().values()}


@pytest.mark.parametrize("name", LESSONS)
def test_a_specification_is_data(name):
    """Apart from its parameters, a lesson's spec has at most functions that build its constants."""
    tree = ast.parse(
        (ROOT / "robo_genesis" / "lessons" / name / "spec.py").read_text("utf8")
    )
    calls = (n.func for n in ast.walk(tree) if isinstance(n, ast.Call))
    called = {func.id for func in calls if isinstance(func, ast.Name)}
    for function in (n.name for n in tree.body if isinstance(n, ast.FunctionDef)):
        assert function.endswith("parameters") or function in called
    assert not any(isinstance(node, ast.ClassDef) for node in tree.body)


def test_lessons_give_a_case_one_mark():
    for name in LESSONS:
        marks = getattr(find_lesson(name).spec, "CASE_MARKS", {})
        assert marks.items() <= course_marks().items(), name


def test_each_check_has_a_claim():
    for name in LESSONS:
        for page in find_lesson(name).pages.values():
            assert all(map(claim_of, page.checks))


def test_a_replay_that_does_not_exist_lists_the_choices():
    with pytest.raises(LookupError, match="drops, slides"):
        find_replay("l03", "falls")
