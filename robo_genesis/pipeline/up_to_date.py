"""Whether the published site is up to date with all of its inputs: then a build has nothing to do.

Inputs and site are read whole, which takes a tenth of a second. Packages count by name,
version and time of installation: an edited file inside one is not noticed.
"""

import json
import os
import platform
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.files import (
    MADE_BY_TOOLS,
    files_below,
    files_digest,
    json_digest,
)
from robo_genesis.core.git import git_or_none
from robo_genesis.core.project import PUBLISHED

# Lies beside the site's HTML and describes the site that was published with it.
RECORD = "build.json"

FOLDERS = ("robo_genesis", "build_scripts")

# Folders and files of the checkout, beside the book, that a build reads.
FILES = (
    "pyproject.toml",
    "requirements.lock",
    "package.json",
    "package-lock.json",
    ".npmrc",
    "README.md",
    "LICENSE",
)

# Environment variables that a build reads, beside those that decide the pages'
# measurements.
VARIABLES = (
    "SITE_URL",
    "SOLUTIONS",
    "SOURCE_DATE_EPOCH",
    "LANG",
    "LC_ALL",
    "LC_TIME",
    "TZ",
)

SITE = ("html", "evidence", "pages")


def inputs_digest(root: Path, book: Path) -> str:
    """Return the digest of everything that decides a build's site.

    Args:
        root: the checkout.
        book: the folder of the pages.
    """
    published = (f"{PUBLISHED}*", f".{PUBLISHED}*")
    pages = files_below(book, (*MADE_BY_TOOLS, *published))
    return json_digest(
        inputs_beside_pages(root)
        | {
            "book": [str(book), files_digest(book, pages)],
            # a recorded run names a commit in the history
            "commit": git_or_none(book, "rev-parse", "HEAD", "--is-shallow-repository"),
        }
    )


def inputs_beside_pages(root: Path) -> dict[str, Any]:
    """Return what decides every page beside the files of the book, as JSON values."""
    code = (path for name in FOLDERS for path in files_below(root / name))
    return {
        "code": files_digest(root, code),
        "files": files_digest(root, (root / name for name in FILES)),
        "contract": project.environment_contract(),
        "variables": {name: os.environ.get(name) or "" for name in VARIABLES},
        "python": [platform.python_version(), sys.executable],
        "installed": project.installed(),
    }


def site_digest(published: Path) -> str:
    """Return the digest of a published folder: the site and its bundles."""
    return files_digest(
        published, (p for name in SITE for p in files_below(published / name))
    )


def nothing_changed(root: Path, book: Path, published: Path) -> list[str]:
    """Return the last lines for the user if a build has nothing to do, none if it has work.

    Args:
        root: the checkout.
        book: the folder of the pages.
        published: the folder of the published site.
    """
    now = {"inputs": inputs_digest(root, book), "site": site_digest(published)}
    try:
        record = json.loads((published / RECORD).read_text("utf8"))
        if any(record[name] != digest for name, digest in now.items()):
            return []
        site = f"Site: {published / 'html/index.html'}"
        return ["Nothing changed: the site is up to date.", site, *record["lines"]]
    except (OSError, ValueError, KeyError):
        return []


def record(published: Path, inputs: str, lines: Sequence[str]) -> None:
    """Write beside a site from which inputs it was made, and the last lines of its build.

    Args:
        published: the folder of the complete site.
        inputs: the digest of the inputs.
        lines: the last lines of a build without work.
    """
    made = {"inputs": inputs, "site": site_digest(published), "lines": list(lines)}
    (published / RECORD).write_text(json.dumps(made, indent=1) + "\n", "utf8")
