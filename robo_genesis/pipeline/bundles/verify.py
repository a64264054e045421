"""Accept or refuse a bundle: whatever can be recomputed from its arrays is recomputed."""

import json
from functools import lru_cache, partial
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.files import derived
from robo_genesis.evidence import bundle, bundle_files, manifest_rules
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.recompute import as_judged_today, recompute
from robo_genesis.pipeline.bundles import keys as evidence_key


def verify_bundle(
    folder: Path,
    run_id: str | None = None,
    *,
    lesson: str | None = None,
    page: str | None = None,
    root: Path = project.ROOT,
    book: Path = project.BOOK,
    once: bool = False,
) -> Manifest:
    """Check one bundle against its files, the checkout and the pin.

    Damaged and false bundles are refused before `stale`, so that a stale bundle is sound.

    Args:
        folder: the bundle, named after its actual backend.
        run_id: the required run, None for any.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.
        once: whether metrics and checks are not computed again if they were accepted before, with
            the same files of the bundle and the same code of the course. All other rules apply each
            time, and a refusal is not kept.

    Returns:
        The accepted manifest; its checks have today's verdicts.

    Raises:
        BundleRefused: with a code, and a message that names the found and the expected value.
        ProjectError, PageError: the checkout itself cannot be read.
    """
    present = bundle_files.scan(folder)
    manifest = bundle.read_manifest(folder)
    manifest_rules.check_identity(manifest, run_id, lesson, page)
    bundle_files.check_files(folder, present, manifest)
    manifest_rules.check_circumstances(folder, manifest.predicate)
    manifest_rules.check_log(folder, manifest, root)
    evidence_key.check_current(manifest, root, book)
    if once:
        contents = [(folder / name).read_bytes() for name in sorted(present)]
        inputs = [json.dumps(sorted(present)).encode(), *contents, _code()]
        derived("accepted", inputs, partial(recompute, folder, manifest))
    else:
        recompute(folder, manifest)
    return as_judged_today(manifest)


@lru_cache(maxsize=1)
def _code() -> bytes:
    """Return the whole code of the course and its data files."""
    files = sorted(path for path in (project.ROOT / "robo_genesis").rglob("*") if path.is_file())
    return b"\0".join(path.read_bytes() for path in files if "__pycache__" not in path.parts)
