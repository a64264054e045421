"""The time of each cell: read from the store of executed pages, shown in one row per page."""

from copy import deepcopy

import pytest
from built_site import parsed
from tiny_book import cell, make_book, notebook

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.page_folder import write_page
from robo_genesis.build.page_results import PageResult
from robo_genesis.build.site.render import RenderError, render
from robo_genesis.lessons.book_pages import find_pages


def built(folder, *executed, **seconds):
    """Render a book whose pages were executed with these seconds of their cells; return a table."""
    page, other = (
        notebook(cell("1"), cell("2"), cell(""), cell("3")),
        notebook(cell("4"), title="Other"),
    )
    book = make_book(folder, page=page, other=other, times="# Times\n\n```{cell-times}\n```\n")
    results, run = [], {"run_id": "0" * 32, "command": None, "seconds": 1.0}
    for found in find_pages(book):
        ran, place = deepcopy(found.notebook), folder / "store" / found.docname
        ran.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}
        write_page(place, found, ran, folder, cell_seconds=seconds[found.docname], **run)
        status = "executed" if found.docname in executed else "reused"
        results.append(PageResult(found, status, 0.0, "0" * 32, folder=place))
    html = render(book, folder / "staging", BuiltPages.of(results), folder / "render.log")
    return parsed(html, "times").select_one("tbody")


def test_a_row_shows_rounded_times_the_slowest_cell_and_whether_this_build_ran_the_page(tmp_path):
    table = built(tmp_path, "other", page=[0.26, 12.345, 3.0], other=[2.0])
    assert [[c.get_text(strip=True) for c in row.select("td")] for row in table.select("tr")] == [
        ["Page", "3", "15.6", "2", "12.3", "from the store"],
        ["Other", "1", "2.0", "1", "2.0", "executed"],
    ]
    assert [a["href"] for a in table.select("a")] == ["page.html", "other.html"]


def test_a_page_without_a_time_of_a_cell_stops_the_build(tmp_path):
    with pytest.raises(RenderError, match="page has 3 code cells and 2 recorded times"):
        built(tmp_path, page=[1.5, 0.25], other=[2.0])
