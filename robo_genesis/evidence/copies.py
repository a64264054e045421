"""A bundle of an accelerator is compared with runs on the CPU, of which it must not be a copy."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from robo_genesis.core.refusals import BundleRefused
from robo_genesis.core.trace import TimeSeries
from robo_genesis.evidence.compare import read_side
from robo_genesis.evidence.rows import Side
from robo_genesis.evidence.trace_files import fields_of

IMPORTER = "(MJCF)"
"""How warnings of the model importer begin. It runs on the CPU, whatever the backend is."""

MEASURE = "Run the lab on the accelerator itself, with make evidence."


def require_own_run(folder: Path, cpu_runs: Sequence[Path]) -> None:
    """Require that a verified bundle of an accelerator is not one of some CPU runs.

    Args:
        folder: the verified bundle.
        cpu_runs: bundles of the same page; those of another page, another engine or another
            backend than the CPU are ignored, and so are absent and damaged ones.

    Raises:
        BundleRefused: `copy` if run id or all arrays of a case are those of a CPU run; `log` if the
            model importer gave a warning there that is missing here.
    """
    if not cpu_runs:
        return
    own = read_side(folder)
    if own.manifest.predicate.backend.actual == "cpu":
        return
    for run in cpu_runs:
        try:
            other = read_side(run)
        except BundleRefused:
            continue
        if _same_page_and_engine(own, other):
            _compare(own, other)


def _same_page_and_engine(own: Side, other: Side) -> bool:
    here, there = own.manifest.predicate, other.manifest.predicate
    same = (here.lesson, here.page, here.engine.version) == (
        there.lesson,
        there.page,
        there.engine.version,
    )
    return same and there.backend.actual == "cpu"


def _compare(own: Side, other: Side) -> None:
    here, there = own.manifest.predicate, other.manifest.predicate
    what = f"manifest.json: backend.actual is {here.backend.actual!r}, but"
    if here.run_id == there.run_id:
        raise BundleRefused(
            "copy",
            f"{what} a run on the CPU has its run_id {here.run_id[:8]}, expected another. "
            f"{MEASURE}",
        )
    shared = [case for case in own.traces if case in other.traces]
    equal = [case for case in shared if _equal(own.traces[case], other.traces[case])]
    if equal:
        raise BundleRefused(
            "copy",
            f"{what} all arrays of {', '.join(equal)} equal those of the CPU's run "
            f"{there.run_id[:8]} to the last bit, expected others: an accelerator rounds "
            f"differently. {MEASURE}",
        )
    missing = [w for w in dict.fromkeys(there.warnings) if w.startswith(IMPORTER)]
    missing = [warning for warning in missing if warning not in here.warnings]
    if missing:
        raise BundleRefused(
            "log",
            f"log.txt: warnings of the model importer are missing: {missing}, expected each that "
            f"the CPU's run {there.run_id[:8]} has. {MEASURE}",
        )


def _equal(one: TimeSeries, other: TimeSeries) -> bool:
    """Whether two runs have the same arrays, to the last bit."""
    if type(one) is not type(other):
        return False
    pairs = [(getattr(one, field), getattr(other, field)) for field in fields_of(one)]
    return all(np.array_equal(a, b) for a, b in pairs)
