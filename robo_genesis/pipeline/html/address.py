"""The address of the published site, as `https://example.org/course/`, and its solutions."""

import os
import re
from collections.abc import Mapping
from pathlib import Path
from urllib.parse import urlsplit

import yaml

from robo_genesis.core.project import ProjectError, solutions_shown

SITE_URL = "SITE_URL"
# An address without a user's name, query, fragment and file of a page.
FOLDER = re.compile(
    r"(?i)https?://[^\s/?#@\"<>\\]+(/[^\s?#\"<>\\]*)?(?<!\.html)(?<!\.htm)"
)


def site_address(environment: Mapping[str, str] = os.environ) -> str | None:
    """Return the site's address with a slash at its end, None if none is given.

    Raises:
        ProjectError: it is not the address of a folder of the web.
    """
    given = environment.get(SITE_URL)
    if not given:
        return None
    if not FOLDER.fullmatch(given.rstrip("/")):
        raise ProjectError(
            f"{SITE_URL}={given!r} is not valid. Give an address like https://example.org/course/: "
            "that of the folder, without a page, a user's name, spaces, ? and #."
        )
    return given.rstrip("/") + "/"


def site_root(environment: Mapping[str, str] = os.environ) -> str:
    """Return the path of the site's root on its server, `/` if no address is given."""
    return urlsplit(site_address(environment) or "/").path


def described(book: Path) -> list[str]:
    """Return the lines that say which site of a book is built.

    Args:
        book: the folder of the pages and their configuration.
    """
    address = (
        site_address() or f"none. {SITE_URL}=https://example.org/course/ gives one."
    )
    if solutions_shown():
        return ["Solutions: shown. SOLUTIONS=0 leaves them out.", f"Address: {address}"]
    config = yaml.safe_load((book / "_config.yml").read_text("utf8"))["sphinx"][
        "config"
    ]
    lines = ["Solutions: left out.", f"Address: {address}"]
    if repository := config.get("course_repository"):
        lines.append(
            f"Pages link to {repository}: whoever may read it finds the solutions there."
        )
    return lines
