"""Laws that the arrays of every run obey, whatever it shows: times, start, unit quaternions.

A law yields nothing where it holds, and a finding where it is broken. Checks of the
lessons use laws, so the page, the recorder and the verification judge arrays alike.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding
from robo_genesis.core.comparison import same_arrays
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import quoted
from robo_genesis.core.trace import TimeSeries

MEASURES = False

TIME = 1e-9  # Tolerance of a time against k · dt [s]; both are computed in float64

UNIT = (
    1e-5  # Tolerance of the norm of a quaternion; runs of the engine have at most 2e-7
)

# Expected values of what is zero, and of the quaternion of a body that has not turned.
ZERO, UNTURNED = np.zeros(()), np.array([1.0, 0, 0, 0])


def broken(code: str, what: str, found: Any, expected: object) -> Finding:
    """Return the finding of something in a run's arrays that no such run has."""
    allowed = expected if isinstance(expected, str) else quoted(expected)
    return Finding(what, found, False, allowed, recorded=False, code=code)


def kept(run: str, laws: Iterable[Finding]) -> Iterator[Finding]:
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


def apart(
    code: str,
    what: str,
    found: FloatArray,
    expected: FloatArray,
    tolerance: float | FloatArray,
) -> Iterator[Finding]:
    """Yield the entry that is farthest beyond the tolerance of its expected value, if any is.

    Args:
        code: of the refusal.
        what: the name of the array, with its unit.
        found: the array of the run.
        expected: of the same shape, or one that broadcasts to it.
        tolerance: of all entries, or of a shape that broadcasts to theirs.
    """
    beyond = np.abs(np.subtract(found, expected, dtype=np.float64)) - tolerance
    if beyond.size and not beyond.max() <= 0:
        expected, room = (
            np.broadcast_to(of, found.shape) for of in (expected, tolerance)
        )
        at = tuple(int(k) for k in np.unravel_index(int(beyond.argmax()), beyond.shape))
        where = f"{what} at index {list(at)}" if at else what
        yield broken(
            code, where, float(found[at]), f"{float(expected[at])!r} ± {room[at]:g}"
        )


def times(trace: TimeSeries, steps: int, dt: float) -> Iterator[Finding]:
    """Yield a number of steps [1] or a time step [s] that is not that of the case."""
    if trace.steps != steps:
        yield broken("stamps", "number of steps", trace.steps, steps)
    elif (np.abs(trace.t - np.arange(steps + 1) * dt) > TIME).any():
        yield broken("stamps", "dt of the stamps [s]", trace.dt, dt)


def unit_quaternions(quat: FloatArray) -> Iterator[Finding]:
    """Yield the quaternion, of an array (…, 4), whose norm is farthest from 1."""
    norm = np.sqrt(np.einsum("...i,...i", quat, quat, dtype=np.float64))
    yield from apart("pose", "norm of link_quat", norm, np.ones(()), UNIT)


def mean_speed(
    position: FloatArray, velocity: FloatArray, dt: float, room: float
) -> Iterator[Finding]:
    """Yield a mean velocity of an outer step that is not between those before and after it.

    Args:
        position: (n+1, d) [m or rad].
        velocity: of the same shape [m/s or rad/s].
        dt: of the outer step [s].
        room: tolerance of the mean velocity.
    """
    mean, middle = np.diff(position, axis=0) / dt, (velocity[1:] + velocity[:-1]) / 2
    beyond = np.maximum(
        np.abs(mean - middle) - np.abs(np.diff(velocity, axis=0)) / 2, 0
    )
    what = "mean velocity beyond those of both samples [rad/s or m/s]"
    yield from apart("motion", what, beyond, ZERO, room)


def copied(
    trace: TimeSeries, traces: Mapping[str, TimeSeries], second: Collection[str]
) -> Iterator[Finding]:
    """Yield the first run of Genesis that has the motion of a run of another engine.

    Arrays are the same to the last bit. `second` has the names of `traces` of the other
    engine.
    """
    of_motion = ("q", "qd", "link_pos", "link_quat", "link_vel", "link_ang")
    motion = [field.name for field in fields(trace) if field.name in of_motion]
    for label, other in traces.items():
        if label not in second and same_arrays(trace, other, *motion):
            what = f"run with the same motion as {label}, to the last bit,"
            yield broken("second-engine", what, "of another engine", "different")
