"""Accept or refuse a bundle: its own words are not believed where they can be recomputed."""

from pathlib import Path

from robo_genesis.core import project
from robo_genesis.evidence import bundle, bundle_files, evidence_key, manifest_rules, recompute
from robo_genesis.evidence.bundle import BundleRefused, Manifest
from robo_genesis.lessons.registry import find_lesson

__all__ = ["BundleRefused", "verify_bundle"]


def verify_bundle(
    folder: Path,
    run_id: str | None = None,
    *,
    lesson: str | None = None,
    page: str | None = None,
    root: Path = project.ROOT,
    book: Path = project.BOOK,
) -> Manifest:
    """Check one bundle against its files, the checkout and the pin.

    What lies and what is damaged is refused before what is old: a stale bundle is an honest one.

    Args:
        folder: the bundle, named by its actual backend.
        run_id: the run that it must belong to, where that is known.
        lesson: whose it must be, where that is known.
        page: the page that it must come from, where that is known.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.

    Returns:
        The accepted manifest.

    Raises:
        BundleRefused: with a code, and a message that names what was expected and found.
        ProjectError, PageError: the checkout itself cannot be read.
    """
    present = bundle_files.scan(folder)
    manifest = bundle.read_manifest(folder)
    manifest_rules.check_identity(manifest, run_id, lesson, page)
    bundle_files.check_files(folder, present, manifest)
    manifest_rules.check_backend(folder, manifest)
    manifest_rules.check_environment(manifest)
    manifest_rules.check_render(manifest)
    manifest_rules.check_log(folder, manifest)
    manifest_rules.check_engine_files(manifest)
    evidence_key.check_current(manifest, root, book)
    again = find_lesson(manifest.predicate.lesson).recompute(recompute.Reader(folder, manifest))
    recompute.check_metrics(folder, again.metrics)
    recompute.check_outcomes(manifest, again.outcomes)
    return manifest
