"""How long cells took: read from the store of executed pages, shown one row a page."""

from copy import deepcopy

import pytest
from bs4 import BeautifulSoup
from jupyter_cache.base import CacheBundleIn
from tiny_book import cell, make_book, notebook

from robo_genesis.build.page_cache import PageCache, notebooks_folder
from robo_genesis.build.render import RenderError, render
from robo_genesis.lessons.book_pages import find_pages
from robo_genesis.site import cell_times

TIMES = "# Times\n\n```{cell-times}\n```\n"


@pytest.fixture
def folder(tmp_path):
    """A book with two pages to execute and one that shows their times."""
    page, other = notebook(cell("1"), cell("2"), cell("3")), notebook(cell("4"), title="Other")
    make_book(tmp_path, page=page, other=other, times=TIMES)
    return tmp_path


def store(folder, **seconds):
    """Store each page as executed, with these seconds of its cells; return pages and store."""
    cache = PageCache(notebooks_folder(folder / "cache"))
    pages = {page.docname: page for page in find_pages(folder / "book")}
    for name, own in seconds.items():
        executed = deepcopy(pages[name].notebook)
        executed.metadata["language_info"] = {"name": "python", "pygments_lexer": "ipython3"}
        executed.metadata["robo_genesis"] = {"cell_seconds": own}
        cache.cache_notebook_bundle(CacheBundleIn(executed, name), check_validity=False)
    return pages, cache


def test_a_row_names_the_slowest_cell_and_rounds_to_tenths():
    assert cell_times.row("a/page", [0.26, 12.345, 3.0], executed=True) == {
        "page": "[](/a/page.md)",
        "code cells": 3,
        "all cells [s]": "15.6",
        "slowest cell": 2,
        "its time [s]": "12.3",
        "in this build": "executed",
    }


def test_times_come_from_the_store(folder):
    pages, cache = store(folder, page=[1.5, 0.25, 3.0])
    assert cell_times.cell_seconds(pages["page"], cache) == [1.5, 0.25, 3.0]
    with pytest.raises(LookupError, match="other is not executed"):
        cell_times.cell_seconds(pages["other"], cache)


def built(folder, executed):
    return render(
        folder / "book", folder / "staging", folder / "cache", folder / "render.log", executed
    )


def test_the_page_shows_what_this_build_executed_and_what_is_from_the_store(folder):
    store(folder, page=[1.5, 0.25, 3.0], other=[2.0])
    html = BeautifulSoup((built(folder, ["other"]) / "times.html").read_text(), "html.parser")
    rows = [[c.get_text(strip=True) for c in tr.select("td")] for tr in html.select("tbody tr")]
    assert rows == [
        ["Page", "3", "4.8", "3", "3.0", "from the store"],
        ["Other", "1", "2.0", "1", "2.0", "executed"],
    ]
    assert [a["href"] for a in html.select("tbody a")] == ["page.html", "other.html"]


def test_a_page_that_lost_a_time_stops_the_build(folder):
    store(folder, page=[1.5, 0.25], other=[2.0])
    with pytest.raises(RenderError, match="page has 3 code cells and 2 recorded times"):
        built(folder, [])
