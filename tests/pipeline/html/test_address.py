"""The site's address; test_render and test_elsewhere look at sites without and with one."""

import pytest

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.address import site_address, site_root


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


INVALID = ["example.org", "ftp://example.org", "https://", "https://a.org/?x", "https://a.org/#x"]


@pytest.mark.parametrize("given", INVALID)
def test_another_text_is_refused(given):
    with pytest.raises(ProjectError, match="Give an address like"):
        site_address({"SITE_URL": given})
