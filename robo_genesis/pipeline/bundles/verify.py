"""Accept or refuse a bundle: whatever can be recomputed from its arrays is recomputed.

An accepted bundle has the evidence key of the current checkout.
"""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.comparison import differences
from robo_genesis.core.files import derived_value, files_below, files_digest
from robo_genesis.core.scene import SEED
from robo_genesis.core.text import quoted
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import MANIFEST, Manifest
from robo_genesis.evidence.recompute import check_backend, recompute
from robo_genesis.evidence.refusals import BundleRefused, expect
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.pages.book import code_digest, find_pages
from robo_genesis.pipeline.pages.sources import measuring_modules
from robo_genesis.sim import session

MOVE = "Put the bundle into the folder of its own lesson."


def question(lesson: str, page: str, root: Path, book: Path) -> dict[str, Any]:
    """Return the fields that `bundle.evidence_key` covers, with the values of a checkout.

    Args:
        lesson: as the front matter of the page declares it.
        page: likewise.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    digest, imports = page_code(lesson, page, book)
    source = {"page": digest, "modules": measuring_modules(lesson, imports, root)}
    parameters = json.loads(json.dumps(find_page(lesson, page).parameters()))
    locked = project.locked_versions((root / "requirements.lock").read_text("utf8"))
    return {
        "schema_version": bundle.SCHEMA_VERSION,
        "lesson": lesson,
        "page": page,
        "engine": {
            "version": project.engine_pin(root),
            "quadrants_version": locked["quadrants"],
            "precision": session.PRECISION,
        },
        "seed": SEED,
        "parameters": parameters,
        "source": source,
    }


def page_code(lesson: str, page: str, book: Path) -> tuple[str, list[str]]:
    """Return the digest of the code cells of a page in the book, and what they import.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    codes, name = _page_codes(book), f"{lesson}/{page}"
    if name not in codes:
        expect("lesson", MANIFEST, "lesson and page", name, " or ".join(codes), MOVE)
    return codes[name]


@lru_cache(maxsize=4)
def _page_codes(book: Path) -> dict[str, tuple[str, list[str]]]:
    return {
        f"{page.lesson}/{page.page}": (code_digest(page), page.code.imports)
        for page in find_pages(book)
        if page.declares_bundle
    }


def changed(manifest: Manifest, root: Path, book: Path) -> list[tuple[str, Any, Any]]:
    """Return (path, recorded, current) of each keyed field that differs from the checkout.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    facts = manifest.model_dump()
    current = question(manifest.lesson, manifest.page, root, book)
    recorded = {name: facts[name] for name in current}
    recorded["engine"] = {name: recorded["engine"][name] for name in current["engine"]}
    return list(differences(recorded, current))


def check_current(manifest: Manifest, book: Path) -> None:
    """Require that a bundle has the evidence key of the checkout.

    Raises:
        BundleRefused: `stale`, with everything that differs; `lesson`.
    """
    if differing := changed(manifest, project.ROOT, book):
        named = "; ".join(
            f"{path} is {quoted(here)}, expected {quoted(there)}"
            for path, here, there in differing
        )
        raise BundleRefused(
            "stale",
            f"{MANIFEST}: {named}. The bundle answers an older question, "
            "or its notebook was run by hand. "
            f"Record it again: `make evidence LESSON={manifest.lesson}`.",
            differing,
        )


def verify_bundle(
    folder: Path,
    *,
    lesson: str | None = None,
    page: str | None = None,
    book: Path = project.BOOK,
    once: bool = False,
) -> Manifest:
    """Check one bundle against its files, the checkout and the pin.

    Damaged bundles are refused before `stale`, so that a stale bundle is sound.

    Args:
        folder: the bundle, named after its actual backend.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        book: the folder of the pages.
        once: whether metrics and checks are not computed again if they were accepted
            before, with the same files of the bundle and the same code of the course.
            All other rules apply each time, and a refusal is not kept.

    Returns:
        The accepted manifest.

    Raises:
        BundleRefused: with a code, and a message that names the found and the expected
            value.
        ProjectError, PageError: the checkout itself cannot be read.
    """
    manifest = bundle.read_manifest(folder)
    for what, required in (("lesson", lesson), ("page", page)):
        found = getattr(manifest, what)
        expect("lesson", MANIFEST, what, found, required or found, MOVE)
    bundle.check_files(folder, manifest)
    check_backend(folder, manifest)
    check_current(manifest, book)
    if once:
        inputs = [bundle.sha256(folder / MANIFEST), manifest.files, _code()]
        derived_value("accepted", inputs, lambda: recompute(folder, manifest))
    else:
        recompute(folder, manifest)
    return manifest


@lru_cache(maxsize=1)
def _code() -> str:
    """Return the digest of the course's code and its data files."""
    package = project.ROOT / "robo_genesis"
    return files_digest(package, files_below(package))
