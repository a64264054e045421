"""The address of the published site: the environment variable `SITE_URL`, as `https://example.org/course/`."""

import os
from collections.abc import Mapping
from urllib.parse import urlsplit

from robo_genesis.core.project import ProjectError

SITE_URL = "SITE_URL"


def site_address(environment: Mapping[str, str] = os.environ) -> str | None:
    """Return the site's address with a slash at its end, None if none is given.

    Raises:
        ProjectError: it is not an address of the web, or it has a query or a fragment.
    """
    given = environment.get(SITE_URL)
    if not given:
        return None
    parts = urlsplit(given)
    if parts.scheme not in ("http", "https") or not parts.netloc or parts.query or parts.fragment:
        raise ProjectError(
            f"{SITE_URL}={given!r} is not valid. Give an address like https://example.org/course/."
        )
    return given.rstrip("/") + "/"


def site_root(environment: Mapping[str, str] = os.environ) -> str:
    """Return the path of the site's root on its server, `/` if no address is given."""
    return urlsplit(site_address(environment) or "/").path
