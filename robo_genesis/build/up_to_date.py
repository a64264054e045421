"""Whether the published site still stands for all that it was made from: then a build has no work.

Inputs and site are read whole, which takes a tenth of a second. A link in the book that leads to a
folder counts as changed. Packages count by name, version and time of installation: a file that is
edited inside one is not seen.
"""

import hashlib
import json
import os
import platform
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from robo_genesis.core.git import git_or_none
from robo_genesis.core.project import (
    ProjectError,
    environment_contract,
    installed,
    require_pinned_engine,
)

RECORD = "standing.json"
"""Beside the site's HTML; it speaks of what was published with it."""

FOLDERS = ("robo_genesis", "build_scripts")
FILES = (
    "pyproject.toml", "requirements.lock", "package.json", "package-lock.json", ".npmrc",
    "README.md", "LICENSE",
)  # fmt: skip
"""What a build reads of the checkout apart from the book."""

VARIABLES = ("SITE_URL", "SOURCE_DATE_EPOCH", "LANG", "LC_ALL", "LC_TIME", "TZ")
"""What a build reads of the environment apart from what decides the pages' measurements."""

LEFT_OUT = ("__pycache__", ".ipynb_checkpoints")
PUBLISHED = ("html", "evidence", "pages")


class UnseenError(Exception):
    """Something among the inputs leads to where no digest looks."""


def inputs_digest(
    root: Path, book: Path, environment: Mapping[str, str] | None = None
) -> str | None:
    """Return the digest of everything that decides a build's site, None if something is unseen.

    Args:
        root: the checkout.
        book: the folder of the pages.
        environment: variables, by default those of this process.
    """
    given = os.environ if environment is None else environment
    try:
        book_files = files_digest(book, _inside(book, skip="_build"))
        code = files_digest(root, (p for name in FOLDERS for p in _inside(root / name)))
    except UnseenError:
        return None
    parts = {
        "book": [str(book), book_files],
        "code": code,
        "files": files_digest(root, (root / name for name in FILES)),
        "contract": environment_contract(given),
        "variables": {name: given.get(name) or "" for name in VARIABLES},
        "python": [platform.python_version(), sys.executable],
        "installed": installed(sys.path),
        "history": history(book),
    }
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def files_digest(base: Path, files: Iterable[Path]) -> str:
    """Return the digest of names and contents of files; an absent one counts as such."""
    found = hashlib.sha256()
    for path in sorted(files):
        content = hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "absent"
        found.update(os.fsencode(path.relative_to(base)) + f"\0{content}\n".encode())
    return found.hexdigest()


def _inside(folder: Path, skip: str = "\0") -> Iterator[Path]:
    """Yield all files below a folder, but for what Python leaves and for names that begin so.

    Raises:
        UnseenError: a link leads to a folder, or to nothing.
    """
    for here, folders, files in os.walk(folder):
        folders[:] = [
            name
            for name in folders
            if name not in LEFT_OUT and not (Path(here) == folder and name.startswith(skip))
        ]
        for path in (Path(here, name) for name in [*folders, *files]):
            if path.is_symlink() and not path.is_file():
                raise UnseenError(str(path))
        yield from (Path(here, name) for name in files)


def history(book: Path) -> list[str | None]:
    """Return what the pages' histories follow from: the commit, and what is not in it."""
    return [
        git_or_none(book, "rev-parse", "HEAD", "--is-shallow-repository"),
        git_or_none(book, "status", "--porcelain", "-z", "--", "."),
    ]


def site_digest(published: Path) -> str:
    """Return the digest of a published folder: the site and its bundles."""
    return files_digest(published, (p for n in PUBLISHED for p in _inside(published / n)))


def nothing_changed(root: Path, book: Path, published: Path) -> list[str]:
    """Return the last lines for the user where a build has no work, none where it has.

    Args:
        root: the checkout.
        book: the folder of the pages.
        published: the folder of the published site.
    """
    try:
        require_pinned_engine(root)
        lines = standing(published, inputs_digest(root, book))
    except (ProjectError, OSError):
        return []  # the build says it
    if lines is None:
        return []
    return ["Nothing changed: the site stands.", f"Site: {published / 'html/index.html'}", *lines]


def keep(published: Path, inputs: str | None, lines: Sequence[str]) -> None:
    """Write beside a site what it was made from and what its build said at its end.

    Args:
        published: the folder of the complete site.
        inputs: the digest of what it was made from, None where that is not known.
        lines: the last lines of the build.
    """
    with suppress(UnseenError):  # of such a site nothing is kept: the next build builds it
        if inputs is None:
            return
        record = {"inputs": inputs, "site": site_digest(published), "lines": list(lines)}
        (published / RECORD).write_text(json.dumps(record, indent=1) + "\n", "utf8")


def standing(published: Path, inputs: str | None) -> list[str] | None:
    """Return the last lines of the build that made the site, None where there is work to do.

    Args:
        published: the folder of the published site.
        inputs: the digest of what a build would be made from now.
    """
    try:
        record = json.loads((published / RECORD).read_text("utf8"))
        if inputs is None or record["inputs"] != inputs:
            return None
        unchanged = record["site"] == site_digest(published)
    except (OSError, ValueError, KeyError, TypeError, UnseenError):
        return None
    return list(record["lines"]) if unchanged else None
