"""Laws of motion as findings: a law yields nothing where a run keeps it.

Checks of the lessons use laws, so the page, the recorder and the verification judge
arrays alike. A wrong engine, or wrong code around it, breaks them.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding, Findings
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray

MEASURES = False


def kept(run: str, laws: Iterable[Finding]) -> Findings:
    """Yield whether a run keeps its laws, and the first thing that breaks one.

    Args:
        run: its name.
        laws: what its laws yield.
    """
    wrong = next(iter(laws), None)
    if wrong is None:
        yield Finding(f"{run} keeps its laws", True, True, "true", recorded=False)
    else:
        yield replace(wrong, label=f"{run}: {wrong.label}")


def each_run(run: Experiment, law: Callable[[Any, Any], Iterable[Finding]]) -> Findings:
    """Yield whether each run of a page keeps the laws of its trace and case."""
    for name, case in run.cases.items():
        yield from kept(name, law(run.traces[name], case))


def apart(
    what: str, found: FloatArray, expected: FloatArray, tolerance: float | FloatArray
) -> Findings:
    """Yield the entry that is farthest beyond the tolerance of its expected value, if any is.

    Args:
        what: the name of the array, with its unit.
        found: the array of the run.
        expected: of the same shape, or one that broadcasts to it.
        tolerance: of all entries, or of a shape that broadcasts to theirs.
    """
    beyond = np.abs(np.subtract(found, expected, dtype=np.float64)) - tolerance
    if beyond.size and not beyond.max() <= 0:
        at = np.unravel_index(beyond.argmax(), beyond.shape)
        value, valid, room = (
            float(np.broadcast_to(of, beyond.shape)[at])
            for of in (found, expected, tolerance)
        )
        place = f"{what} at index {[int(k) for k in at]}"
        yield Finding(place, value, False, f"{valid!r} ± {room:g}", recorded=False)
