"""Outputs of a build, for what reads measured values, and pages in a browser that draws in 3D."""

from pathlib import Path

import pytest
from browsers import SOFTWARE, launched
from bundles import RENDERER
from small_book import render_small_book
from watching import errors
from without_sphinx import page_of

from robo_genesis.pipeline.pages.page_index import PageIndex


@pytest.fixture
def built(tmp_path, monkeypatch):
    """Return what lets folders be the outputs of this build, by `lesson/page`."""

    def tell(outputs):
        (tmp_path / "told").mkdir()
        for name, value in (
            PageIndex(outputs=outputs).write(tmp_path / "told/pages").items()
        ):
            monkeypatch.setenv(name, value)

    return tell


@pytest.fixture
def outputs(recorder, experiment, built):
    """Let the synthetic run of L04's lab be the outputs of this build."""
    recorder.write(experiment, RENDERER)
    built({"l04/lab": recorder.contract.outputs / "l04" / "lab"})


@pytest.fixture(scope="session")
def small_site(tmp_path_factory) -> Path:
    """The site of `small_book.py`."""
    return render_small_book(tmp_path_factory.mktemp("small"))


@pytest.fixture
def page(browser):
    """A new page in a browser."""
    page = browser.new_page()
    yield page
    page.close()


@pytest.fixture(scope="module")
def browser_3d():
    """A browser that draws in 3D without a graphics card."""
    with launched(*SOFTWARE) as browser:
        yield browser


@pytest.fixture
def open_block(browser_3d, tmp_path):
    """Return a function that opens the block of a directive alone, from disk, in some window.

    The errors of the page's scripts are its `problems`, and there may be none at the
    end; what it asks for is its `asked`."""
    opened = []

    def open_it(block, of=browser_3d, **window):
        page = of.new_page(**{"viewport": {"width": 480, "height": 700}} | window)
        page.problems, page.asked = errors(page), []
        page.on(
            "request", lambda request: page.asked.append(request.url.rpartition("/")[2])
        )
        page.goto(page_of(block, tmp_path).as_uri())
        page.locator(".panel").first.wait_for()
        opened.append(page)
        return page

    yield open_it
    for page in opened:
        assert page.problems == []
        page.close()
