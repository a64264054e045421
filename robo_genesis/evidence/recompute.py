"""What a bundle says by itself: one backend, its own key, and metrics and checks of its arrays."""

from pathlib import Path

from robo_genesis.core.checks import FAILED
from robo_genesis.sim.backends import contradictions

from .bundle import (
    MANIFEST,
    METRICS,
    Manifest,
    evidence_key,
    read_metrics,
)
from .reader import from_bundle
from .refusals import BundleRefused, expect, expect_equal

RELABEL = "Name the folder after the backend that computed."
TORCH = (
    "Use a Torch build for this backend, unset GS_TORCH_FORCE_CPU_DEVICE and QD_ARCH, and run the "
    "page again."
)
REINSTALL = (
    "A file of the installed engine differs from the published package. Install it again: "
    "pip install --force-reinstall -r requirements.lock."
)


def check_backend(folder: Path, manifest: Manifest) -> None:
    """Require one backend, the requested one, on which engine, compiler and Torch agree.

    The backend names the folder. The files of the engine are those of its wheels. The
    key is that of the bundle's own fields.

    Raises:
        BundleRefused: `backend`, `torch`, `engine-files` or `key`.
    """
    backend = manifest.backend
    actual, at_end = backend.actual, backend.actual_at_end
    expect("backend", MANIFEST, "backend.actual", actual, folder.name, RELABEL)
    expect("backend", MANIFEST, "actual_at_end", at_end, actual)
    if backend.requested == "cpu":
        what = "actual where cpu was requested"
        expect("backend", MANIFEST, what, actual, "cpu")
    match = manifest.engine.files_match_wheel
    expect("engine-files", MANIFEST, "engine.files_match_wheel", match, True, REINSTALL)
    key = evidence_key(manifest.model_dump())
    expect("key", MANIFEST, "evidence_key", manifest.evidence_key, key)
    for what, found, expected in contradictions(backend):
        expect("torch", MANIFEST, what, found, expected, TORCH)


def recompute(folder: Path, manifest: Manifest) -> None:
    """Compute metrics and checks again from the arrays of a bundle, and accept what is recorded.

    The recorded verdicts are not used, so a changed tolerance leaves a bundle current.

    Raises:
        BundleRefused: as `from_bundle`; `metrics` or `checks` if metrics, or what the
            checks found, differ from the recorded values; `failed` if a check does not
            pass.
    """
    metrics = read_metrics(folder)
    experiment = from_bundle(folder, manifest, metrics)
    outcomes = experiment.outcomes()
    failed = [check for check in outcomes if not check.passed]
    recorded = {
        group: {
            name: metric.model_dump(by_alias=True) for name, metric in named.items()
        }
        for group, named in metrics.items()
    }
    expect_equal("metrics", METRICS, "{}", recorded, experiment.records())
    names = [check.name for check in outcomes]
    listed = [check.name for check in manifest.checks]
    expect("checks", MANIFEST, "list of checks", listed, names)
    for check, record in zip(outcomes, manifest.checks, strict=True):
        what = f"{{}}, found by check {check.name},"
        expect_equal("checks", MANIFEST, what, record.found, dict(check.found))
    if failed:
        details = " ".join(f"[{check.name}] {check.detail}" for check in failed)
        raise BundleRefused(
            FAILED,
            f"{MANIFEST}: failed checks {details}, expected none. Correct the lesson or "
            "report the cause to the engine's developers, then record the bundle again.",
        )
