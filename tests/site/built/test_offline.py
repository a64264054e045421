"""The site is used served, and out of the archive from disk."""

from pathlib import Path

import pytest
from watching import SERVED_ONLY, watch

from robo_genesis.pipeline.html.archive import ARCHIVE, SUMS
from robo_genesis.pipeline.html.checks import Site, run_checks

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"


@pytest.fixture(params=["served", "from disk"])
def base(request, address, unpacked) -> str:
    """What is opened from disk comes out of the archive, whose files are those of the site."""
    return address if request.param == "served" else unpacked.as_uri()


def test_search_finds_a_page_and_says_nothing_wrong(browser, base):
    page = browser.new_page()
    problems = watch(page)
    page.goto(f"{base}/search.html?q=overshoot")
    page.wait_for_selector("#search-results li a")
    page.wait_for_load_state("networkidle")  # leaving would stop the requests for summaries
    links = page.locator("#search-results li a").evaluate_all("links => links.map(a => a.href)")
    assert any("/lessons/l04-joint-control/lecture.html" in link for link in links)
    page.goto(next(link for link in links if "lecture.html" in link))
    assert page.locator("article h1").is_visible()
    assert problems == []
    page.close()


def test_the_theme_switches_and_stays_on_the_next_page(browser, base):
    context = browser.new_context(color_scheme="light")
    page = context.new_page()
    problems = watch(page)
    page.goto(f"{base}/index.html")
    for _ in range(3):
        if page.evaluate("document.documentElement.dataset.theme") == "dark":
            break
        page.locator("button.theme-switch-button:visible").click()
    # What a page from disk stores reaches the next page's process a little later.
    other = context.new_page()
    other.goto(f"{base}/index.html")
    other.wait_for_function("localStorage.getItem('theme') === 'dark'")
    page.goto(f"{base}/{LECTURE}")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert problems == []
    context.close()


def test_the_archive_is_a_whole_site_without_itself(unpacked, site):
    assert {c.name: c.problems for c in run_checks(Site(unpacked)) if c.problems} == {}
    kept = {p.relative_to(unpacked) for p in unpacked.rglob("*") if p.is_file()}
    assert kept == {p.relative_to(site) for p in site.rglob("*") if p.is_file()} - {
        Path(ARCHIVE),
        Path(SUMS),
    }


def test_links_inside_the_site_name_files_so_that_they_work_from_disk(site):
    wrong = []
    pages = Site(site).pages.items()
    for path, address in ((path, url) for path, page in pages for url in page.addresses):
        url = address.partition("#")[0].partition("?")[0]
        leads = not url.startswith("/") and path.parent.joinpath(url).is_file()
        if url and ":" not in url and path.name not in SERVED_ONLY and not leads:
            wrong.append(f"{path}: {url}")
    assert wrong == []
