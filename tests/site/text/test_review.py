"""What a browser remembers: missed questions, the last heading, and finished pages."""

import json
from types import SimpleNamespace

import pytest
import yaml
from built_site import served
from watching import errors

from robo_genesis.core.project import BOOK
from robo_genesis.site.text import questions, review

CHOICE = {"options": [("less", False, ""), ("more", True, "")]}
NUMBER = {"value": 0.05, "tolerance": 0.01, "feedback": [("right", "Yes.")]}
ASKED = {
    "lessons/one": {"a": {"text": "A?", **CHOICE}, "b": {"text": "B?", **NUMBER}},
    "lessons/two": {"c": {"text": "C?", **CHOICE}, "d": {"text": "D?", **NUMBER}},
}
SECTIONS = "".join(
    f'<section id="{name}" style="height: 1500px"><h2>{name.title()}'
    f'<a class="headerlink" href="#{name}">#</a></h2></section>'
    for name in ("first", "second")
)
HEAD = '<meta charset="utf-8"><link rel="icon" href="data:,">'
MENU = "".join(f'<li><a href="{{}}{name}.html">{name}</a></li>' for name in ASKED)


@pytest.fixture
def site(page, tmp_path):
    """Serve a small site, and return its address; its pages may have no errors.

    From disk, Chromium may give a page what another one left a moment ago too late.
    """
    toc = {
        "format": "jb-book",
        "root": "index",
        "chapters": [{"file": n} for n in ASKED],
    }
    (tmp_path / "_toc.yml").write_text(yaml.safe_dump(toc))
    env = SimpleNamespace(
        titles={
            name: SimpleNamespace(astext=lambda: "Title") for name in ("index", *ASKED)
        },
        metadata={"index": {}}
        | {name: {questions.QUESTIONS: of} for name, of in ASKED.items()},
    )
    builder = SimpleNamespace(get_relative_uri=lambda _, name: f"{name}.html")
    app = SimpleNamespace(srcdir=tmp_path, env=env, builder=builder)
    bodies = dict.fromkeys(ASKED, f"<article><h1>Title</h1>{SECTIONS}</article>")
    bodies["index"] = '<p class="memory"></p>'
    bodies["review"] = review.links(app, "review")
    scripts = "".join(
        f"<script>{(BOOK / '_static' / name).read_text()}</script>"
        for name in ("memory.js", "review.js")
    )
    for name, body in bodies.items():
        up = "../" * name.count("/")
        own = (
            scripts if name == "review" else scripts.split("</script>")[0] + "</script>"
        )
        nav = f'<nav class="bd-links"><ul>{MENU.format(up, up)}</ul></nav>'
        file = tmp_path / f"{name}.html"
        file.parent.mkdir(exist_ok=True)
        file.write_text(
            f'<!doctype html><html data-content_root="./{up}">{HEAD}{nav}{body}{own}'
        )
    problems = errors(page)
    with served(tmp_path) as address:
        yield address
    assert problems == []


@pytest.mark.browser
def test_missed_questions_come_first_and_right_ones_are_left_out(page, site):
    address = f"{site}/review.html"
    page.goto(address)
    items, state = page.locator(".all-questions li"), page.locator(".review")
    assert state.inner_text().startswith("This browser has no answer")
    assert items.count() == 4
    answers = {
        "lessons/one.html": {"a": 1, "b": "0.2"},
        "lessons/two.html": {"c": 0, "finished": True},
    }
    page.evaluate(f"globalThis.memory.write({{pages: {json.dumps(answers)}}})")
    page.goto(address)
    assert state.inner_text() == "Missed: 2. Right: 1. Without an answer: 1."
    assert items.all_inner_texts() == [
        "Missed: B? Title",
        "Missed: C? Title",
        "D? Title",
    ]
    links = [link.get_attribute("href") for link in items.locator("a").all()]
    assert links == [
        f"lessons/{name}" for name in ("one.html#b", "two.html#c", "two.html#d")
    ]


@pytest.mark.browser
def test_a_reader_goes_on_at_the_heading_and_sees_what_is_done(page, site):
    page.goto(f"{site}/lessons/one.html")
    page.evaluate("document.querySelector('#second').scrollIntoView()")
    page.goto(f"{site}/lessons/two.html")
    marks = page.locator(".bd-links .progress-mark")

    def sights():
        return [mark.get_attribute("aria-label") for mark in marks.all()]

    assert sights() == ["begun"]
    page.get_by_label("I have finished this page").check()
    assert sights() == ["begun", "finished"]
    page.goto(f"{site}/lessons/one.html")
    page.evaluate("document.querySelector('#second').scrollIntoView()")
    page.goto(f"{site}/index.html")
    go = page.locator(".memory a")
    assert go.inner_text() == "Title, “Second”"
    assert go.get_attribute("href").endswith("/lessons/one.html#second")
    page.get_by_role("button", name="Forget all").click()
    assert sights() == []
