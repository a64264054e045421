"""The question that a bundle must answer to be current, read from the checkout as it is now."""

import json
import re
from collections.abc import Iterator
from functools import lru_cache, partial
from glob import glob
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.content_cache import derived
from robo_genesis.core.project import PUBLISHED
from robo_genesis.core.refusals import BundleRefused, shown
from robo_genesis.core.scene import SEED
from robo_genesis.evidence import bundle
from robo_genesis.lessons.registry import find_page
from robo_genesis.sim import session


def question(lesson: str, page: str, root: Path, book: Path) -> dict[str, Any]:
    """Return what `evidence_key` covers, with the values of a checkout.

    Args:
        lesson: as the page's front matter declares it.
        page: likewise.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    try:
        measuring = find_page(lesson, page)
    except LookupError as error:
        raise BundleRefused("lesson", f"manifest.json: {error}") from error
    return {
        "schema_version": bundle.SCHEMA_VERSION,
        "lesson": lesson,
        "page": page,
        "engine": {
            "version": project.engine_pin(root),
            "quadrants_version": locked_version("quadrants", root),
            "precision": session.PRECISION,
        },
        "seed": SEED,
        "parameters": json.loads(json.dumps(measuring.parameters())),
        "source": {
            "page": page_digest(lesson, page, book),
            "modules": {
                name: bundle.sha256(root / "robo_genesis" / f"{name.replace('.', '/')}.py")
                for name in measuring.modules
            },
        },
    }


def locked_version(package: str, root: Path) -> str:
    """Return the version of a package in requirements.lock.

    Raises:
        ProjectError: the lock names it not exactly once.
    """
    lock = root / "requirements.lock"
    found = re.findall(rf"^{re.escape(package)}==(\S+)", lock.read_text("utf8"), re.MULTILINE)
    if len(found) != 1:
        raise project.ProjectError(
            f"{lock} pins {package} to {found or 'nothing'}, expected one version. "
            "`make lock` writes it anew."
        )
    return str(found[0])


def page_digest(lesson: str, page: str, book: Path) -> str:
    """Return the digest of a page's code cells as the book has them.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    files = _page_files(book)
    stamps = tuple((str(path), path.stat().st_mtime_ns, path.stat().st_size) for path in files)
    digests = _page_digests(book, stamps)
    if (lesson, page) not in digests:
        raise BundleRefused(
            "lesson",
            f"manifest.json: the page is {lesson}/{page}, expected one of "
            f"{sorted('/'.join(name) for name in digests)}. File it under its own lesson.",
        )
    return digests[lesson, page]


def _page_files(book: Path) -> list[Path]:
    """Return the table of contents and every file that may be a page, in linked folders, too."""
    names = glob("**/*.md", root_dir=book, recursive=True)  # unlike rglob, it follows links
    pages = sorted(name for name in names if Path(name).parts[0] != PUBLISHED)
    return [*book.glob("_toc.yml"), *(book / name for name in pages)]


@lru_cache(maxsize=8)
def _page_digests(book: Path, stamps: tuple[Any, ...]) -> dict[tuple[str, str], str]:
    """Read the pages once for all bundles; `stamps` change with them."""
    files = _page_files(book)
    names = (path.relative_to(book).as_posix().encode() for path in files)
    contents = (
        path.read_bytes()
        for path in [*files, Path(__file__).parents[1] / "lessons" / "book_pages.py"]
    )
    listed = derived("page-code", [*names, *contents], partial(_read_digests, book))
    return {(lesson, page): digest for lesson, page, digest in json.loads(listed)}


def _read_digests(book: Path) -> bytes:
    """Return lesson, page and digest of each page that declares a bundle, as JSON.

    The reader of pages brings MyST-NB and Jupyter's packages along, which take longer to load than
    all of a verification, so it is loaded here alone.
    """
    from robo_genesis.lessons import book_pages as pages

    found = [page for page in pages.find_pages(book) if page.declares_bundle]
    return json.dumps([(p.lesson, p.page, pages.code_digest(p)) for p in found]).encode()


def check_current(manifest: bundle.Manifest, root: Path, book: Path) -> None:
    """Require that a bundle answers today's question.

    Raises:
        BundleRefused: `stale`, naming everything that differs; `lesson`.
    """
    predicate = manifest.predicate.model_dump()
    expected = question(predicate["lesson"], predicate["page"], root, book)
    if predicate["evidence_key"] == bundle.evidence_key(expected):
        return
    found = {name: predicate[name] for name in expected}
    found["engine"] = {name: found["engine"][name] for name in expected["engine"]}
    changed = [
        f"{path} is {shown(here)}, expected {shown(there)}"
        for path, here, there in differences(found, expected)
    ]
    raise BundleRefused(
        "stale",
        f"manifest.json: {'; '.join(changed) or 'evidence_key is another'}. It answers an older "
        f"question: record the lesson again, `make evidence LESSON={predicate['lesson']}`.",
    )


def differences(found: Any, expected: Any, path: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Yield (path, found, expected) where two JSON values differ; an absent entry is None."""
    if isinstance(found, dict) and isinstance(expected, dict):
        for name in sorted(found.keys() | expected.keys()):
            inner = f"{path}.{name}" if path else name
            yield from differences(found.get(name), expected.get(name), inner)
    elif found != expected:
        yield path, found, expected
