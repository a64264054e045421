"""Accept or refuse a bundle: its own words are not believed where they can be recomputed."""

from pathlib import Path

from robo_genesis import l02, l03, l04, project
from robo_genesis.evidence import (
    bundle,
    contact_runs,
    current,
    drop_runs,
    files,
    recompute,
    rules,
    step_runs,
)
from robo_genesis.evidence.bundle import BundleRefused, Manifest

JUDGES = {
    l02.LESSON: drop_runs.judge,
    l03.LESSON: contact_runs.judge,
    l04.LESSON: step_runs.judge,
}
"""By lesson, what computes a bundle's metrics and checks again."""

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
    present = files.scan(folder)
    manifest = bundle.read_manifest(folder)
    rules.check_identity(manifest, run_id, lesson, page)
    files.check_files(folder, present, manifest)
    rules.check_backend(folder, manifest)
    rules.check_environment(manifest)
    rules.check_render(manifest)
    rules.check_log(folder, manifest)
    rules.check_engine_files(manifest)
    current.check_current(manifest, root, book)
    judged = JUDGES[manifest.predicate.lesson](folder, manifest)
    recompute.check_metrics(folder, judged.metrics)
    recompute.check_outcomes(manifest, judged.outcomes)
    return manifest
