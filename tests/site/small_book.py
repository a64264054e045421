"""A small book that the tests of the site share: a course map, a glossary, and executed pages."""

from copy import deepcopy
from pathlib import Path

import yaml
from tiny_book import cell, make_book, notebook, paragraphs, run_pages

from robo_genesis.pipeline.html.archive import pack
from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.page_folder import write_page
from robo_genesis.pipeline.pages.page_index import PageIndex
from robo_genesis.pipeline.pages.results import PageResult
from robo_genesis.site.course.course_map import FILE

PUBLISHED = {"page": "page", "outcomes": ["read a `qpos`", "stop"]}
MAP = [
    {"id": "L01", "title": "One"},
    {"id": "L02", "title": "Two", "needs": []},
    {"id": "L04", "title": "Four", "needs": ["L01", "L02"], **PUBLISHED},
    {
        "id": "L06",
        "title": "Six",
        "page": "lessons/l06-six/lecture",
        "outcomes": ["walk"],
    },
]
CARDS = "```{course-map}\n```\n\n```{course-map}\n:brief:\n```\n"
FEATURED = paragraphs(
    "{lesson}`The second <l02/lecture>` and {lesson}`the\nthird <l03/lab>`.",
    ":::{featured} L04\nFour was measured.\n:::",
    ":::{featured} L05\nFive was measured.\n:::",
    "```{course-status}\n```",
    "```{course-measured}\n```",
)
WORDS = "word " * 600  # Four minutes to read
GLOSSARY = paragraphs(
    "# Glossary",
    "```{glossary}\nDOF\ndegree of freedom\n  One axis of motion. It may turn or slide.",
    "overshoot\n  How far it passes, counted along its {term}`DOF`.",
    "PD control\n  A law with two gains.",
    "step\ntime step\n  What one call of the solver covers.\n```",
)
CALLS = paragraphs(
    "{.in-reference}\n| call |\n| --- |\n| {term}`DOF` |",
    "| other |\n| --- |\n| none |",
)
TERMS = paragraphs(
    "# Terms",
    "{term}`Overshoots<overshoot>` of a\n{term}`degree\nof freedom`; a DOF more.",
)

DESCRIBED = "# Described\n\n- no paragraph\n\nA joint's *step* & more. " + "word " * 100
SECONDS = {"timed": [0.26, 12.345, 3.0], "other": [2.0]}
"""Seconds of the cells of the executed pages."""


def as_executed(page: Page, place: Path, seconds: list[float]) -> PageResult:
    """Return the result of a page whose cells took these times and left no outputs of their own."""
    ran = deepcopy(page.notebook)
    ran.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}
    write_page(place, page, ran, place.parent, 1.0, seconds)
    return PageResult(page, "reused", place)


def executed(pages: list[Page], folder: Path) -> list[PageResult]:
    """Execute pages, and return their results."""
    results = run_pages(pages, folder)
    assert {result.status for result in results} == {"executed"}
    return results


def rendered(folder: Path, results: list[PageResult], place: str = "render") -> Path:
    """Render the book of a folder below it, and return the folder of the pages."""
    built = PageIndex.of(results)
    return render(folder / "book", folder / place, built, folder / "render.log")


def render_with(book: Path, folder: Path, seconds: dict[str, list[float]]) -> Path:
    """Render a book whose executed pages took these times, pack the site and return its folder."""
    store, pages = folder / "store", find_pages(book)
    results = [
        as_executed(page, store / page.docname, seconds[page.docname]) for page in pages
    ]
    html = rendered(folder, results)
    pack(html)
    return html


def render_small_book(folder: Path) -> Path:
    """Render the book and return the folder of its site."""
    for name in ("l02-two", "l06-six"):
        (folder / "book" / "lessons" / name).mkdir(parents=True)
    (folder / "book" / "lessons" / "l06-six" / "worksheet.md").write_text("# Sheet\n")
    pages = {
        "page": "Page",
        "lessons/l02-two/lecture": "Two",
        "cards": f'Map\n\n<p class="memory"></p>\n\n{CARDS}',
    }
    pages |= {
        "featured": f"Map\n\n{FEATURED}",
        "lessons/l06-six/lecture": f"Six\n\n{CALLS}\n\n{WORDS}\n\n## Later\n\n",
        "calls": "Calls\n\n```{reference}\n```",
    }
    pages |= {
        f"lessons/l06-six/{name}": f"Six\n\n{WORDS}"
        for name in ("lab", "deeper", "more")
    }
    pages |= {"times": "Times\n\n```{cell-times}\n```\n"}
    texts = {name: f"# {text}\n\nText.\n" for name, text in pages.items()}
    texts["times"] = f"(minutes)=\n{texts['times']}"
    texts |= {"glossary": GLOSSARY, "terms": TERMS, "described": DESCRIBED}
    texts["timed"] = notebook(cell("1"), cell("2"), cell(""), cell("3"))
    texts["other"] = notebook(cell("4"), title="Other")
    book = make_book(folder, **texts)
    (book / FILE).write_text(yaml.safe_dump(MAP))
    return render_with(book, folder, SECONDS)
