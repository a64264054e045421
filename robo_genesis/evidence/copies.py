"""A bundle of an accelerator is compared with runs on the CPU, of which it must not be a copy."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from robo_genesis.core.comparison import same_arrays
from robo_genesis.evidence.bundle import Predicate
from robo_genesis.evidence.compare import read_side
from robo_genesis.evidence.refusals import BundleRefused, expect
from robo_genesis.evidence.rows import Side

# How warnings of the model importer begin. It runs on the CPU, whatever the backend is.
IMPORTER = "(MJCF)"

MEASURE = "Run the lab on the accelerator itself, with make evidence."


def require_own_run(folder: Path, cpu_runs: Sequence[Path]) -> None:
    """Require that a verified bundle of an accelerator is not one of some CPU runs.

    Args:
        folder: the verified bundle.
        cpu_runs: bundles of the same page; those of another page, another engine or
            another backend than the CPU are ignored, and so are absent and damaged
            ones.

    Raises:
        BundleRefused: `copy` if run id or all arrays of a case are those of a CPU run,
            or if a time is equal, or two times have the same ratio to those of the CPU;
            `log` if the model importer gave a warning there that is missing here.
    """
    if not cpu_runs:
        return
    own = read_side(folder)
    here = own.manifest.predicate
    if here.backend.actual == "cpu":
        return
    for run in cpu_runs:
        try:
            other = read_side(run)
        except BundleRefused:
            continue
        there = other.manifest.predicate
        if _question(there) == _question(here) and there.backend.actual == "cpu":
            _compare(own, other)


def _question(predicate: Predicate) -> tuple[str, str, str]:
    return predicate.lesson, predicate.page, predicate.engine.version


def _compare(own: Side, other: Side) -> None:
    here, there = own.manifest.predicate, other.manifest.predicate
    what = f"manifest.json: backend.actual is {here.backend.actual!r}, but a run on the CPU has"
    if here.run_id == there.run_id:
        its = f"its run_id {here.run_id[:8]}, expected another"
        raise BundleRefused("copy", f"{what} {its}. {MEASURE}")
    equal = [
        case
        for case, trace in own.traces.items()
        if case in other.traces and same_arrays(trace, other.traces[case])
    ]
    if equal:
        its = f"all its arrays of {', '.join(equal)}, expected others: an accelerator rounds"
        raise BundleRefused("copy", f"{what} {its} differently. {MEASURE}")
    if same_times(_times(own), _times(other)):
        raise BundleRefused(
            "copy", f"{what} the same times, or a multiple of some. {MEASURE}"
        )
    imported = [
        text for text in dict.fromkeys(there.warnings) if text.startswith(IMPORTER)
    ]
    missing = [text for text in imported if text not in here.warnings]
    expect(
        "log",
        "log.txt",
        "list of missing warnings of the model importer",
        missing,
        [],
        MEASURE,
    )


def _times(side: Side) -> dict[str, float]:
    """Return the elapsed times that are not zero, by name [s]."""
    found = side.numbers.items()
    return {
        n: m.value
        for n, m in found
        if m.kind == "performance" and m.unit == "s" and m.value
    }


def same_times(times: Mapping[str, float], others: Mapping[str, float]) -> bool:
    """Return whether a time is equal in both, or two times have the same ratio."""
    ratios = [
        1.0,
        *(times[name] / others[name] for name in times.keys() & others.keys()),
    ]
    return len({f"{ratio:.9g}" for ratio in ratios}) < len(ratios)
