"""The time of each cell: read from the store of executed pages, shown in one row per page."""

from copy import deepcopy

from built_site import parsed
from tiny_book import cell, make_book, notebook

from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.html.sphinx_process import SphinxProcess
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.pipeline.pages.folder import write_page
from robo_genesis.pipeline.pages.results import PageResult

SECONDS = {"page": [0.26, 12.345, 3.0], "other": [2.0]}


def test_a_row_shows_rounded_times_and_the_slowest_cell(tmp_path):
    pages = {
        "page": notebook(cell("1"), cell("2"), cell(""), cell("3")),
        "other": notebook(cell("4"), title="Other"),
        "times": "# Times\n\n```{cell-times}\n```\n",
    }
    results, run = [], {"run_id": "0" * 32, "command": None, "seconds": 1.0}
    book = make_book(tmp_path, **pages)
    for found in find_pages(book):
        ran, place = deepcopy(found.notebook), tmp_path / "store" / found.docname
        ran.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}
        write_page(place, found, ran, tmp_path, cell_seconds=SECONDS[found.docname], **run)
        results.append(PageResult(found, "reused", 0.0, "0" * 32, folder=place))
    built = BuiltPages.of(results)
    sphinx = SphinxProcess(book, tmp_path / "render.log")
    html = render(sphinx, tmp_path / "staging", built).html
    table = parsed(html, "times").select_one("tbody")
    assert [[c.get_text(strip=True) for c in row.select("td")] for row in table.select("tr")] == [
        ["Page", "3", "15.6", "2", "12.3"],
        ["Other", "1", "2.0", "1", "2.0"],
    ]
    assert [a["href"] for a in table.select("a")] == ["page.html", "other.html"]
