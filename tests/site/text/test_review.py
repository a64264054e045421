"""What a browser remembers of a reader: missed questions, the last heading, finished pages."""

from types import SimpleNamespace

import pytest
from built_site import served
from docutils import nodes
from watching import errors

from robo_genesis.core.project import BOOK
from robo_genesis.site.text import questions, review

CHOICE = {"options": [("less", False, ""), ("more", True, "")]}
NUMBER = {"value": 0.05, "tolerance": 0.01, "feedback": [("right", "Yes.")]}
ASKED = {name: {"text": name, **CHOICE} for name in "abc"}
ASKED |= {name: {"text": name, **NUMBER} for name in "de"}


@pytest.mark.browser
def test_missed_questions_come_first_and_right_ones_are_left_out(page, tmp_path):
    (tmp_path / "_toc.yml").write_text("{format: jb-book, root: index}")
    env = SimpleNamespace(
        titles={"index": nodes.title("", "Title")},
        metadata={"index": {questions.QUESTIONS: ASKED}},
    )
    builder = SimpleNamespace(get_relative_uri=lambda _, name: f"{name}.html")
    app = SimpleNamespace(srcdir=tmp_path, env=env, builder=builder)
    file, problems = tmp_path / "index.html", errors(page)
    file.write_text("<!doctype html>" + review.links(app, "index"))
    with file.open("a") as html:
        for name in ("memory.js", "review.js"):
            html.write(f"<script>{(BOOK / '_static' / name).read_text()}</script>")
    page.goto(file.as_uri())
    state, items = page.locator(".review"), page.locator(".all-questions li")
    assert state.inner_text().startswith("This browser has no answer")
    assert items.count() == 5
    answers = {"a": 0, "b": 1, "d": "0.2", "e": "0.041"}
    page.evaluate("of => memory.write({pages: {'index.html': of}})", answers)
    for _ in range(5):  # the browser may store what was written after the next load
        page.reload()
        if state.inner_text() == "Missed: 2. Right: 2. Without an answer: 1.":
            break
    assert state.inner_text() == "Missed: 2. Right: 2. Without an answer: 1."
    assert items.all_inner_texts() == ["Missed: a Title", "Missed: d Title", "c Title"]
    assert items.first.locator("a").get_attribute("href") == "index.html#a"
    assert problems == []


@pytest.mark.browser
def test_a_reader_goes_on_at_the_heading_and_sees_what_is_done(page, small_site):
    page.set_viewport_size({"width": 800, "height": 200})
    with served(small_site) as site:
        for name in ("lab", "lecture"):
            page.goto(f"{site}/lessons/l06-six/{name}.html")
            page.locator(".finish-page input").set_checked(name == "lab")
            page.evaluate("scrollTo(0, 9e9)")
        page.goto(f"{site}/cards.html")
        marks = page.locator("article .progress-mark")
        assert [mark.get_attribute("aria-label") for mark in marks.all()] == [
            "finished"
        ]
        go = page.locator(".memory a")
        assert go.inner_text() == "Six, “Later”"
        assert go.get_attribute("href") == f"{site}/lessons/l06-six/lecture.html#later"
        page.get_by_role("button", name="Forget all").click()
        assert marks.count() == 0
