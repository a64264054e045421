"""What is recomputed from the arrays of a bundle: laws, metrics and checks."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from robo_genesis.core.checks import FAILED, Check
from robo_genesis.core.experiment import Experiment
from robo_genesis.evidence.bundle import Manifest, Metric, read_metrics
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect, expect_equal


def recompute(folder: Path, manifest: Manifest) -> bytes:
    """Compute metrics and checks again from the arrays of a bundle, and accept what is recorded.

    Arrays that break a law are refused first: only those of a possible run have
        metrics.

    Raises:
        BundleRefused: with the code of a broken law; as the functions below and
            `from_bundle`.
    """
    metrics = read_metrics(folder)
    experiment = from_bundle(folder, manifest, metrics)
    outcomes = experiment.outcomes()
    for check in outcomes:
        if check.code != FAILED:
            raise BundleRefused(
                check.code, f"arrays: [{check.name}] {check.detail}. {AGAIN}"
            )
    check_metrics(metrics, experiment)
    check_outcomes(manifest, outcomes)
    return b"accepted"


def check_metrics(
    recorded: Mapping[str, Mapping[str, Metric]], experiment: Experiment
) -> None:
    """Require that metrics.json has the values, units, classes and sources of the runs.

    Raises:
        BundleRefused: `bad-trace` if the arrays of a run give no metrics; `metrics`.
    """
    found = {
        group: {
            name: metric.model_dump(by_alias=True) for name, metric in metrics.items()
        }
        for group, metrics in recorded.items()
    }
    try:
        expected = experiment.records()
    except (LookupError, ValueError, ArithmeticError) as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    expect_equal("metrics", "metrics.json", "{}", found, expected)


def check_outcomes(manifest: Manifest, outcomes: Sequence[Check]) -> None:
    """Require that the checks found what is recorded, and that all pass by today's judgement.

    The recorded verdicts are not used, so a changed tolerance leaves a bundle current.

    Raises:
        BundleRefused: `checks` if names or found values differ; `failed` if a check
            fails.
    """
    recorded, file = manifest.predicate.checks, "manifest.json"
    names = [check.name for check in outcomes]
    expect("checks", file, "list of checks", [check.name for check in recorded], names)
    for check, computed in zip(recorded, outcomes, strict=True):
        what = f"{{}}, found by check {check.name},"
        expect_equal("checks", file, what, dict(check.found), dict(computed.found))
    failed = [
        f"[{check.name}] {check.detail}" for check in outcomes if not check.passed
    ]
    if failed:
        raise BundleRefused(
            FAILED,
            f"{file}: failed checks {' '.join(failed)}, expected none. Correct the lesson or "
            "report the cause to the engine's developers, then record the bundle again.",
        )


def as_judged_today(manifest: Manifest) -> Manifest:
    """Return an accepted manifest with the verdicts of `check_outcomes`: every check passed."""
    predicate = manifest.predicate
    passed = [check.model_copy(update={"passed": True}) for check in predicate.checks]
    return manifest.model_copy(
        update={"predicate": predicate.model_copy(update={"checks": passed})}
    )
