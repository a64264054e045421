"""A small book for another address and without solutions.

The address is below a server's root: it decides links, sitemap, cards and the 404 page.
"""

import re
import shutil
from pathlib import Path

import pytest
from built_site import parsed
from small_book import render_with
from tiny_book import cell, make_book, notebook

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.checks import run_checks
from robo_genesis.pipeline.html.render import DOCTREES

ADDRESS = "https://example.org/robot/course/"
PUBLIC, SECRET = "public_line = 1", "secret_line = 2"
SOLVED = (
    cell(PUBLIC),
    cell(SECRET, ":tags: [solution]\n"),
    f"\n:::{{admonition}} Answer\n:class: tip solution\nIt is `{SECRET}`.\n:::\n",
    f"\n:::{{dropdown}} Why?\n:class-container: solution\nBecause `{SECRET}`.\n:::\n",
)


def rendered(folder: Path) -> Path:
    """Render a book whose pages are taken as executed, pack it, and return its folder."""
    pages = {"solved": notebook(*SOLVED), "deep/page": "# A page\n\nAbout joint4.\n"}
    (folder / "book" / "deep").mkdir(parents=True)
    html = render_with(make_book(folder, **pages), folder, {"solved": [1.0, 1.0]})
    shutil.rmtree(
        html.parent / DOCTREES
    )  # they name the checkout and are not published
    return html


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SITE_URL", ADDRESS.rstrip("/"))
        patch.setenv("SOLUTIONS", "0")
        return rendered(tmp_path_factory.mktemp("elsewhere"))


def test_each_page_names_its_own_address_and_the_sitemap_lists_pages_alone(html):
    names = [path.relative_to(html).as_posix() for path in html.rglob("*.html")]
    found = {
        name: link["href"]
        for name in names
        for link in parsed(html, name.removesuffix(".html")).select(
            'link[rel="canonical"]'
        )
    }
    assert {"index.html", "deep/page.html"} <= {*found}
    assert found == {name: ADDRESS + name for name in found}
    listed = re.findall(r"<loc>(.*?)</loc>", (html / "sitemap.xml").read_text())
    pages = ("index.html", "solved.html", "deep/page.html")
    assert sorted(listed) == sorted(ADDRESS + name for name in pages)


def test_links_of_the_404_page_begin_at_the_root_and_the_site_passes_its_checks(html):
    page = parsed(html, "404")
    inside = [
        tag["href"]
        for tag in page.select("a[href], link[href]")
        if tag["href"][0] != "#"
    ]
    assert len(inside) > 5
    assert [
        href for href in inside if not href.startswith(("/robot/course/", ADDRESS))
    ] == []
    assert not any(run_checks(html, "/robot/course/").values())


def leaks(html: Path, text: str) -> set[str]:
    """Return the files that contain a text, as code or highlighted."""
    marked = re.compile(r"(<[^>]*>|\s)*".join(map(re.escape, text.split())))
    files = (
        path
        for path in html.rglob("*")
        if path.suffix in {".html", ".js", ".md", ".txt"}
    )
    return {
        path.name for path in files if marked.search(path.read_text("utf8", "ignore"))
    }


@pytest.mark.parametrize(
    "fold",
    [
        ":::{dropdown} More\n:class-container: solutions",
        ":::{toggle}",
        ":::{admonition} More\n:class: tip dropdown",
    ],
)
def test_a_fold_that_does_not_say_whether_it_is_a_solution_is_refused(tmp_path, fold):
    book = make_book(tmp_path, text=f"# Text\n\n{fold}\nIn it.\n:::\n")
    with pytest.raises(ProjectError, match=r"text\.md:3: WARNING: a fold does not say"):
        render_with(book, tmp_path, {})


def test_no_file_has_a_solution_or_an_answer(html, tmp_path):
    assert leaks(html, PUBLIC) == {"solved.html"}  # nor is the source published
    assert leaks(html, SECRET) == set()
    said = [mark.get_text() for mark in parsed(html, "solved").select("article p > em")]
    assert said == [
        "The solution is left out on this site; the outputs are those of its run."
    ]
    shown = rendered(tmp_path)
    assert {"solved.html", "solved.md"} <= leaks(shown, SECRET)
