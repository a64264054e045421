"""Accept or refuse a bundle: whatever can be recomputed from its arrays is recomputed."""

from collections.abc import Sequence
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.checks import Check
from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence import bundle, bundle_files, evidence_key, manifest_rules
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.strict_json import differences
from robo_genesis.lessons.experiment import Experiment


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

    Damaged and false bundles are refused before `stale`, so that a stale bundle is sound.

    Args:
        folder: the bundle, named after its actual backend.
        run_id: the required run, None for any.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.

    Returns:
        The accepted manifest.

    Raises:
        BundleRefused: with a code, and a message that names the found and the expected value.
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
    experiment = from_bundle(folder, manifest)
    check_metrics(folder, experiment)
    check_outcomes(manifest, experiment.outcomes())
    return manifest


def check_metrics(folder: Path, experiment: Experiment) -> None:
    """Require that metrics.json has the values, units, classes and sources of the runs.

    Raises:
        BundleRefused: `bad-trace` if the arrays of a run give no metrics; `metrics`.
    """
    found = {
        group: {name: metric.model_dump(by_alias=True) for name, metric in metrics.items()}
        for group, metrics in bundle.read_metrics(folder).items()
    }
    try:
        expected = experiment.records()
    except (LookupError, ValueError, ArithmeticError) as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    for name, recorded, computed in differences(found, expected):
        expect("metrics", "metrics.json", name, recorded, computed)


def check_outcomes(manifest: Manifest, outcomes: Sequence[Check]) -> None:
    """Require that the recorded outcomes are those of the runs, and that all checks passed.

    Raises:
        BundleRefused: `checks` if they differ; `failed` if they agree and a check failed.
    """
    recorded, file = manifest.predicate.checks, "manifest.json"
    names = [check.name for check in outcomes]
    expect("checks", file, "list of checks", [check.name for check in recorded], names)
    for check, computed in zip(recorded, outcomes, strict=True):
        what = f"outcome of check {check.name}, recomputed as '{computed.detail}',"
        expect("checks", file, what, check.passed, computed.passed)
        detail = computed.record()["detail"]
        expect("checks", file, f"detail of check {check.name}", check.detail, detail)
    failed = [f"[{check.name}] {check.detail}" for check in recorded if not check.passed]
    if failed:
        raise BundleRefused(
            "failed",
            f"{file}: failed checks {' '.join(failed)}, expected none. Correct the lesson or "
            "report the cause to the engine's developers, then record the bundle again.",
        )
