"""One book of broken pages: each mistake stops the build and is shown with its page."""

import re

import pytest
import yaml
from small_book import executed, rendered
from tiny_book import cell, make_book, notebook, paragraphs

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.site.course import course_map

# What stands alone on the page, and what is said of its line.
TEXT = {
    r"$\foo{x}$": r"shows \\, which the site's font for formulas does not have",
    "{py:func}`module`": "reference target not found: module",
    "{term}`gain`": "term not in glossary: 'gain'",
    "{lesson}`Two <l02/lectur>`": "l02 has no page 'lectur'; choices: lecture",
    "Two. {guard}`l2/lab sag`": "guard: Lesson 'l2' does not exist. Choices: l01, ",
    "Three. {guard}`sag`": "guard: text measures nothing",
    "```{lesson-status} l2\n```": "lesson-status l2: Lesson 'l2' does not exist",
    "```{course-map}\n```": "the book has no page gone",
    "```{replay} l02/lecture\n:blind:\n```": "`:blind:` needs a question above it",
}

IMPORTS = """\
from IPython.display import Markdown
table = Markdown("| read |\\n| --- |\\n| 7 |")"""
INPUTS = ":tags: [inputs]\n"


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """What the build says of the book."""
    folder = tmp_path_factory.mktemp("broken")
    (folder / "book/lessons/l02-two").mkdir(parents=True)
    imports = cell(IMPORTS)
    pages = {
        "text": "# Text\n\n" + paragraphs(*TEXT),
        "lessons/l02-two/lecture": "# Two\n\nText.\n",
        "free": notebook(imports, cell("table", INPUTS), cell("table")),
    }
    book = make_book(folder, **pages)
    published = {"id": "L01", "title": "One", "page": "gone", "outcomes": ["go"]}
    (book / course_map.FILE).write_text(yaml.safe_dump([published]))
    results = executed(find_pages(book), folder)
    with pytest.raises(ProjectError) as caught:
        rendered(folder, results)
    assert str(folder / "render.log") in str(caught.value)
    return str(caught.value)


def test_each_mistake_in_a_text_is_shown_with_page_and_line(report):
    line = 3
    for text, said in TEXT.items():
        assert re.search(rf"text\.md:{line}\b.*{said}", report), said
        line += 2 + text.count("\n")


def test_an_output_of_no_run_is_shown_once_with_its_page(report):
    (line,) = [line for line in report.splitlines() if "a cell shows an output" in line]
    assert "free" in line
