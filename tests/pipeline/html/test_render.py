"""Sphinx shows executed pages; what it keeps makes no page differ from a render from nothing."""

import re
import shutil
from pathlib import Path

import nbformat
import pytest
import yaml
from built_site import parsed
from small_book import as_executed, executed, rendered
from tiny_book import WRITE_BUNDLE, cell, contents, make_book, notebook, paragraphs

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.results import PageResult

CLAIMS = "status: amdgpu-verified\nbadge: cpu-verified\n"
LAB = "robo_genesis: {lesson: l04, page: lab}\n"
BADGES = "\n```{lesson-status} l04\n```\n"
TEXT = f"---\n{CLAIMS}---\n# Text\n{BADGES}"


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    """A rendered book, with a page that got a tag after it was executed.

    The lab's bundle is a manifest that says it was verified, and nothing more.
    """
    folder = tmp_path_factory.mktemp("render")
    said = WRITE_BUNDLE.replace('{"run_id"', '{"state": "verified", "run_id"')
    page, lab = (
        cell("print('measured ' + '7')"),
        notebook(cell(said), front=CLAIMS + LAB),
    )
    book = make_book(folder, text=TEXT, page=notebook(page), lab=lab + BADGES)
    results = executed(find_pages(book), folder)
    text = (book / "page.md").read_text()
    (book / "page.md").write_text(text.replace("cell}", "cell}\n:tags: [hide-input]"))
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SITE_URL", raising=False)
        return rendered(folder, results)


def test_metadata_come_from_the_page_and_outputs_from_the_store(html):
    shown = (html / "page.html").read_text()
    assert "tag_hide-input" in shown
    assert "measured 7" in shown


@pytest.mark.parametrize("name", ["text", "lab"])
def test_no_front_matter_or_bundle_s_word_can_set_a_badge(html, name):
    badges = [
        badge.get_text() for badge in parsed(html, name).select(".evidence-badge")
    ]
    assert badges == ["cpu-stale"]


def test_without_an_address_nothing_claims_one(html):
    assert not (html / "sitemap.xml").exists()
    claims = 'link[rel="canonical"], meta[property^="og:"]'
    assert parsed(html, "page").select(claims) == []


def test_sphinx_executes_nothing_and_names_the_page(tmp_path):
    """A page that the execution stage has not seen would leave a file behind if it were run."""
    trace, front = tmp_path / "was executed", "mystnb: {execution_mode: force}\n"
    make_book(tmp_path, page=notebook(cell(f"open({str(trace)!r}, 'w')"), front=front))
    said = r"page\.md is not executed, and Sphinx executes"
    with pytest.raises(ProjectError, match=said):
        rendered(tmp_path, [])
    assert not trace.exists()


DRAWING = '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>'
FIGURE = "```{figure} a.svg\n:name: %s\nA drawing\n```"
MAP = {"id": "L01", "title": "One", "page": "law", "outcomes": ["go"]}
PAGES = {
    "glossary": "# Glossary\n\n```{glossary}\ngain\n  A factor. More words.\n```\n",
    "law": "# Law\n\n(spring)=\n## The spring\n\nA gain of two.\n",
    "text": "# Text\n\nSee [](law.md) and {ref}`spring`.\n",
    "drawn": paragraphs("# Drawn", FIGURE % "drawn", "$$\nF = k x\n$$ (force)"),
    "citing": "# Citing\n\nSee {numref}`drawn` and {eq}`force`.\n",
    "map": "# Map\n\n```{course-map}\n```\n",
    "times": "# Times\n\n```{cell-times}\n```\n",
    "run": notebook(cell("print(7)")),
    "extra": "# Extra\n\nMore.\n",
}


def run_of(folder: Path, printed: str, seconds: float) -> list[PageResult]:
    """Return the book's executed page with an output, without a run."""
    (page,) = find_pages(folder / "book")
    (code,) = (c for c in page.notebook.cells if c.cell_type == "code")
    code.outputs = [nbformat.v4.new_output("stream", name="stdout", text=printed)]
    return [as_executed(page, folder / f"run {printed}", [seconds])]


def replace(page: Path, *pairs: tuple[str, str]) -> None:
    for old, new in pairs:
        assert old in page.read_text()
        page.write_text(page.read_text().replace(old, new))


def edit_pages(book: Path) -> None:
    """Edit prose, a title, a term, numbers and the map, which other pages show."""
    replace(book / "law.md", ("of two", "of three"), ("# Law", "# Hooke's law"))
    replace(book / "glossary.md", ("A factor", "A ratio"))
    replace(book / "drawn.md", ("# Drawn", f"# Drawn\n\n{FIGURE % 'first'}"))
    replace(book / "course_map.yml", ("title: One", "title: First"))


def edit_contents(book: Path) -> None:
    """Remove a page, add one, and change a script."""
    (book / "extra.md").rename(book / "added.md")
    replace(book / "_toc.yml", ("extra", "added"))
    (book / "_static/choice.js").write_text("1")


def test_each_edit_gives_the_pages_of_a_render_from_nothing(tmp_path):
    book = make_book(tmp_path, **PAGES)
    (book / "a.svg").write_text(DRAWING)
    (book / "course_map.yml").write_text(yaml.safe_dump([MAP]))
    results = run_of(tmp_path, "seven", 1.0)
    rendered(tmp_path, results)
    read = []
    for edit in (edit_pages, edit_contents, None):
        if edit:
            edit(book)
        else:
            results = run_of(tmp_path, "eight", 2.0)
        found = contents(rendered(tmp_path, results))
        log = (tmp_path / "render.log").read_text()
        read.append(re.search(r"(\d+) added, (\d+) changed", log).groups())
        shutil.rmtree(tmp_path / "cold", ignore_errors=True)
        cold = contents(rendered(tmp_path, results, "cold"))
        pages = [name for name in cold if name.endswith(".html")]
        assert [name for name in pages if found.get(name) != cold[name]] == []
    assert read == [("0", "4"), ("1", "10"), ("10", "0")]


def test_the_figures_of_each_page_are_numbered_from_one(tmp_path):
    pages = {
        name: paragraphs(f"# {name}", FIGURE % f"{name}-a", FIGURE % f"{name}-b")
        for name in ("one", "two")
    }
    (make_book(tmp_path, **pages) / "a.svg").write_text(DRAWING)
    html = rendered(tmp_path, [])
    for name in pages:
        shown = (html / f"{name}.html").read_text()
        assert re.findall(r"Fig. (\d)", shown) == ["1", "2"]


def test_a_warning_is_repeated_until_its_cause_is_corrected(tmp_path):
    book = make_book(tmp_path, text="# Text\n\nWords.\n", other="# Other\n")
    rendered(tmp_path, [])
    replace(book / "text.md", ("Words.", "{doc}`nowhere`"))
    for _ in range(2):
        with pytest.raises(ProjectError, match=r"text\.md:3.*nowhere"):
            rendered(tmp_path, [])
    replace(book / "text.md", ("{doc}`nowhere`", "Good words."))
    assert "Good words." in (rendered(tmp_path, []) / "text.html").read_text()
    assert "0 added, 1 changed" in (tmp_path / "render.log").read_text()
