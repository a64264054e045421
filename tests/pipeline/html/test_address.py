"""The site's address; test_render and test_elsewhere look at sites without and with one."""

import pytest

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.address import described, site_address, site_root


@pytest.mark.parametrize(
    ("given", "address", "root"),
    [
        ("", None, "/"),
        ("https://example.org", "https://example.org/", "/"),
        ("http://example.org/a/b/", "http://example.org/a/b/", "/a/b/"),
    ],
)
def test_an_address_ends_with_a_slash_and_has_a_root(monkeypatch, given, address, root):
    monkeypatch.setenv("SITE_URL", given)
    assert (site_address(), site_root()) == (address, root)


INVALID = [
    "example.org",
    "https://a.org/?x",
    "https://a.org/course/index.html",
    "https://a.org/b c/",
    "https://user:pw@a.org/",
]


@pytest.mark.parametrize("given", INVALID)
def test_another_text_is_refused(monkeypatch, given):
    monkeypatch.setenv("SITE_URL", given)
    with pytest.raises(ProjectError, match="Give an address like"):
        site_address()


def test_a_build_says_which_site_it_makes(monkeypatch):
    monkeypatch.setenv("SITE_URL", "https://example.org/b")
    monkeypatch.setenv("SOLUTIONS", "0")
    address = "Address: https://example.org/b/"
    assert described() == ["Solutions: left out.", address]
