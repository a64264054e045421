"""The site's address is set in one place, and without it nothing claims one."""

import pytest
from bs4 import BeautifulSoup
from tiny_book import make_book

from robo_genesis.build.render import RenderError, render
from robo_genesis.build.site_address import AddressError, site_address, site_root


@pytest.mark.parametrize(
    ("given", "address", "root"),
    [
        ({}, None, "/"),
        ({"SITE_URL": ""}, None, "/"),
        ({"SITE_URL": "https://example.org"}, "https://example.org/", "/"),
        ({"SITE_URL": "http://example.org/a/b/"}, "http://example.org/a/b/", "/a/b/"),
    ],
)
def test_an_address_ends_with_a_slash_and_has_a_root(given, address, root):
    assert site_address(given) == address
    assert site_root(given) == root


@pytest.mark.parametrize(
    "given",
    ["example.org", "ftp://example.org", "https://", "https://a.org/?x", "https://a.org/#x"],
)
def test_what_is_no_address_is_refused(given):
    with pytest.raises(AddressError, match="valid is an address like"):
        site_address({"SITE_URL": given})


def build(folder):
    book = make_book(folder, page="# Page\n\nText.\n")
    return render(book, folder / "staging", folder / "cache", folder / "render.log")


def test_an_address_that_is_none_fails_the_build(tmp_path, monkeypatch):
    monkeypatch.setenv("SITE_URL", "example.org")
    with pytest.raises(RenderError, match=r"SITE_URL is 'example\.org'"):
        build(tmp_path)


def test_without_an_address_nothing_claims_one(tmp_path, monkeypatch):
    monkeypatch.delenv("SITE_URL", raising=False)
    html = build(tmp_path)
    assert not (html / "sitemap.xml").exists()
    page = BeautifulSoup((html / "page.html").read_text(), "html.parser")
    assert page.select('link[rel="canonical"], meta[property^="og:"]') == []
    lost = BeautifulSoup((html / "404.html").read_text(), "html.parser")
    assert lost.select_one("form.lost")["action"] == "/search.html"
    tags = lost.select("link[rel=stylesheet], script[src]")
    addresses = [tag.get("href") or tag.get("src") for tag in tags]
    assert len(addresses) > 5
    assert {address for address in addresses if not address.startswith("/_static/")} <= {
        "/searchindex.js"
    }


def test_with_an_address_a_page_names_it_and_has_a_card(tmp_path, monkeypatch):
    monkeypatch.setenv("SITE_URL", "https://example.org/robot")
    html = build(tmp_path)
    assert "<loc>https://example.org/robot/page.html</loc>" in (html / "sitemap.xml").read_text()
    page = BeautifulSoup((html / "page.html").read_text(), "html.parser")
    assert page.select_one('link[rel="canonical"]')["href"] == "https://example.org/robot/page.html"
    tags = {tag["property"]: tag["content"] for tag in page.select('meta[property^="og:"]')}
    assert tags["og:title"] == "Page"
    assert (html / tags["og:image"].removeprefix("https://example.org/robot/")).is_file()
