"""The list of lessons: each entry is complete, and its pages are the book's."""

import pytest

from robo_genesis import lessons
from robo_genesis.evidence.verify import JUDGES
from robo_genesis.lessons import LESSONS, find_lesson, find_page
from robo_genesis.pages import find_pages
from robo_genesis.project import BOOK, ROOT


def test_each_lesson_s_bundles_can_be_judged():
    assert JUDGES.keys() == LESSONS.keys()


def test_the_pages_that_measure_are_those_of_the_book():
    declared = {(page.lesson, page.page) for page in find_pages(BOOK) if page.declares_bundle}
    assert declared == {(name, page) for name, of in LESSONS.items() for page in of.pages}


@pytest.mark.parametrize("name", LESSONS)
def test_what_a_lesson_names_is_there(name):
    lesson = LESSONS[name]
    for page in lesson.pages.values():
        assert all((ROOT / "robo_genesis" / f"{module}.py").is_file() for module in page.modules)
        assert page.parameters()
    drawn = [lesson.compared, *lesson.further.values()]
    assert all(of is None or {*of.cases} <= {*lesson.spec.CASES} for of in drawn)
    assert lesson.metrics.keys() == lesson.spec.CASES.keys()
    for (first, second), metric, order, margin in lesson.spec.RELATIONS:
        assert {first, second} <= {*lesson.spec.CASES}
        assert all(metric in lesson.metrics[case] for case in (first, second))
        assert order in ("higher", "lower", "later", "no later")
        assert margin > 0


def test_unknown_names_are_answered_with_those_there_are():
    with pytest.raises(LookupError, match=r"'l99' is no lesson\. Choices: l02, l03, l04"):
        find_lesson("l99")
    with pytest.raises(LookupError, match=r"l04/exam is no page that measures\. Choices: l04/lab"):
        find_page("l04", "exam")


def test_cases_are_written_as_words():
    assert lessons.Compared(("A", "B", "C"), "joint").names == "A, B and C"
    assert lessons.Moving(("A",), link="box", thing="box").names == "A"
