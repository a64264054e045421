"""The course rendered for an address below a server's root: links, sitemap, cards, 404."""

import re

import pytest
from built_site import executed_pages, parsed
from PIL import Image

from robo_genesis.build.site.archive import pack
from robo_genesis.build.site.checks import check_site
from robo_genesis.build.site.render import render
from robo_genesis.core import project

pytestmark = pytest.mark.engine
ADDRESS = "https://example.org/robot/course/"


@pytest.fixture(scope="module")
def html(site, tmp_path_factory):
    """The pages that the site was just built from, rendered once more with an address."""
    folder = tmp_path_factory.mktemp("address")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SITE_URL", ADDRESS.rstrip("/"))
        html = render(project.BOOK, folder / "staging", executed_pages(), folder / "render.log")
    pack(html)
    return html


def test_every_page_names_its_own_address(html):
    names = [path.relative_to(html).as_posix() for path in html.rglob("*.html")]
    found = {
        name: link["href"]
        for name in names
        for link in parsed(html, name.removesuffix(".html")).select('link[rel="canonical"]')
    }
    assert "lessons/l04-joint-control/lecture.html" in found
    assert found == {name: ADDRESS + name for name in found}


def test_the_sitemap_lists_the_pages_and_no_tool(html):
    listed = re.findall(r"<loc>(.*?)</loc>", (html / "sitemap.xml").read_text())
    names = [path.relative_to(html).as_posix() for path in html.rglob("*.html")]
    tools = {"404.html", "search.html", "genindex.html"}
    expected = {name for name in names if name not in tools and not name.startswith("_static/")}
    assert sorted(listed) == sorted(ADDRESS + name for name in expected)


def test_a_link_to_a_lesson_shows_a_card(html):
    page = parsed(html, "lessons/l04-joint-control/lecture")
    tags = {tag["property"]: tag["content"] for tag in page.select('meta[property^="og:"]')}
    assert tags["og:title"].startswith("L04: Robot models")
    assert tags["og:url"] == f"{ADDRESS}lessons/l04-joint-control/lecture.html"
    assert "joint4" in tags["og:description"]
    card = Image.open(html / tags["og:image"].removeprefix(ADDRESS))
    assert (card.format, card.size) == ("PNG", (1146, 600))


def test_the_site_passes_its_checks_there(html):
    assert [line for check in check_site(html, "/robot/course/") for line in check.problems] == []


def test_links_of_the_404_page_begin_at_the_site_s_root(html):
    page = parsed(html, "404")
    inside = [tag["href"] for tag in page.select("a[href], link[href]") if tag["href"][0] != "#"]
    assert len(inside) > 10
    assert [href for href in inside if not href.startswith(("/robot/course/", ADDRESS))] == []
