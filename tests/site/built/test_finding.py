"""Finding a page or a name again: search and 404."""

from pathlib import Path

import pytest
from built_site import QuietHandler, served
from watching import errors

pytestmark = [pytest.mark.engine, pytest.mark.browser]


@pytest.fixture
def page(page):
    problems = errors(page)
    yield page
    assert [text for text in problems if "404 (" not in text] == []


def results(page) -> list[str]:
    page.wait_for_function(
        "/Search finished|did not match/.test(document.querySelector('#search-results').innerText)"
    )
    return page.eval_on_selector_all(
        "#search-results li > a", "links => links.map(a => a.href)"
    )


class WithNotFound(QuietHandler):
    """Answers as a host of static sites does: unknown addresses get the site's own page."""

    def send_error(self, code: int, *_) -> None:
        body = (Path(self.directory) / "404.html").read_bytes()
        self.send_response(code)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


@pytest.fixture(scope="module")
def host(site):
    with served(site, WithNotFound) as address:
        yield address


@pytest.mark.parametrize("lost", ["nowhere", "lessons/nowhere.html", "a/b/c/d"])
def test_who_is_lost_at_any_depth_can_search_and_go_on(page, host, lost):
    assert page.goto(f"{host}/{lost}").status == 404
    assert page.locator("article h1").inner_text() == "There is no such page"
    family = page.evaluate(
        "getComputedStyle(document.querySelector('article h1')).fontFamily"
    )
    assert family.startswith("system-ui")  # the style sheets were found
    for link in page.locator("article li a").all():
        assert page.request.get(host + link.get_attribute("href")).ok
    page.get_by_label("Search all pages").fill("joint4")
    page.locator("form.lost button").click()
    page.wait_for_url("**/search.html?q=joint4")
    assert results(page)


LECTURE = "lessons/l04-joint-control/lecture.html"


def test_two_sites_on_one_server_remember_and_search_each_for_itself(
    page, site, tmp_path
):
    for term in ("spring", "autumn"):
        (tmp_path / term).symlink_to(site)
    with served(tmp_path) as server:
        page.goto(f"{server}/spring/{LECTURE}")
        page.get_by_label("I have finished this page").check()
        for term, remembers in (("autumn", 0), ("spring", 1)):
            page.goto(f"{server}/{term}/index.html")
            assert page.locator("#lesson-l04 .progress-mark").count() == remembers
            assert page.locator(".memory a").count() == remembers
        page.locator(".memory a").click()
        page.wait_for_url(f"{server}/spring/{LECTURE}#*")
        for term in ("spring", "autumn"):
            page.goto(f"{server}/{term}/search.html?q=joint4")
            found = results(page)
            assert {link[: len(f"{server}/{term}/")] for link in found} == {
                f"{server}/{term}/"
            }
