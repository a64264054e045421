"""The address of the published site, as `https://example.org/course/`, and its solutions."""

import os
import re
from urllib.parse import urlsplit

from robo_genesis.core.project import ProjectError, solutions_shown

SITE_URL = "SITE_URL"
# An address without a user's name, query, fragment and file of a page.
FOLDER = re.compile(
    r"(?i)https?://[^\s/?#@\"<>\\]+(/[^\s?#\"<>\\]*)?(?<!\.html)(?<!\.htm)"
)


def site_address() -> str | None:
    """Return the site's address with a slash at its end, None if none is given.

    Raises:
        ProjectError: it is not the address of a folder of the web.
    """
    given = os.environ.get(SITE_URL)
    if not given:
        return None
    if not FOLDER.fullmatch(given.rstrip("/")):
        raise ProjectError(
            f"{SITE_URL}={given!r} is not valid. Give an address like https://example.org/course/: "
            "that of the folder, without a page, a user's name, spaces, ? and #."
        )
    return given.rstrip("/") + "/"


def site_root() -> str:
    """Return the path of the site's root on its server, `/` if no address is given."""
    return urlsplit(site_address() or "/").path


def described() -> list[str]:
    """Return the lines that say which site is built."""
    address = (
        site_address() or f"none. {SITE_URL}=https://example.org/course/ gives one."
    )
    shown = "shown. SOLUTIONS=0 leaves them out." if solutions_shown() else "left out."
    return [f"Solutions: {shown}", f"Address: {address}"]
