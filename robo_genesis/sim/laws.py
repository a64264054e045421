"""Rules that the arrays of every run obey, whatever it shows: times, start, unit quaternions.

A breach means that the arrays are not those of such a run; it does not judge the physics.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np

from robo_genesis.core.refusals import AGAIN, BundleRefused, shown
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import TimeSeries

MEASURES = False

TIME = 1e-9
"""Tolerance of a time against k · dt [s]; both are computed in float64."""

UNIT = 1e-5
"""Tolerance of the norm of a quaternion; runs of the engine have at most 2e-7."""

REPEATED = 1e-4
"""Tolerance of a run that is computed again on another CPU: in SI units, and as a share of the
largest value of an array. Two runs on one CPU are equal; other CPUs round float64 differently."""


@dataclass(frozen=True, slots=True)
class Breach:
    """One thing in a run's arrays that no such run has; `code` is that of the refusal."""

    code: str
    what: str
    found: object
    expected: object


def refuse(file: str, breaches: Iterable[Breach]) -> None:
    """Refuse a run for the first breach.

    Args:
        file: of the run's arrays.
        breaches: what its rules found.

    Raises:
        BundleRefused: with the code of the breach.
    """
    for found in breaches:
        raise BundleRefused(
            found.code,
            f"{file}: {found.what} is {shown(found.found)}, expected {shown(found.expected)}. "
            f"{AGAIN}",
        )


def apart(
    code: str, what: str, found: FloatArray, expected: FloatArray, tolerance: float | FloatArray
) -> Iterator[Breach]:
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
        expected, room = (np.broadcast_to(of, found.shape) for of in (expected, tolerance))
        at = tuple(int(k) for k in np.unravel_index(int(beyond.argmax()), beyond.shape))
        where = f"{what} at index {list(at)}" if at else what
        yield Breach(code, where, float(found[at]), f"{float(expected[at])!r} ± {room[at]:g}")


def times(trace: TimeSeries, steps: int, dt: float) -> Iterator[Breach]:
    """Yield a number of steps [1] or a time step [s] that is not that of the case."""
    if trace.steps != steps:
        yield Breach("stamps", "number of steps", trace.steps, steps)
    elif (np.abs(trace.t - np.arange(steps + 1) * dt) > TIME).any():
        yield Breach("stamps", "dt of the stamps [s]", trace.dt, dt)


def unit_quaternions(quat: FloatArray) -> Iterator[Breach]:
    """Yield the quaternion, of an array (…, 4), whose norm is farthest from 1."""
    norm = np.sqrt(np.einsum("...i,...i", quat, quat, dtype=np.float64))
    yield from apart("pose", "norm of link_quat", norm, np.ones(()), UNIT)


def computed_again(
    trace: TimeSeries, again: TimeSeries, shares: Mapping[str, float] | None = None
) -> Iterator[Breach]:
    """Yield an array that differs from that of the same run, computed by the verification.

    Args:
        trace: the run.
        again: the same run.
        shares: by array, the tolerance instead of `REPEATED`.
    """
    for field in fields(trace):
        found, expected = getattr(trace, field.name), getattr(again, field.name)
        if found.shape != expected.shape:
            yield Breach("second-engine", f"shape of {field.name}", found.shape, expected.shape)
            continue
        share = (shares or {}).get(field.name, REPEATED)
        room = share * max(1.0, float(np.abs(expected).max(initial=0.0)))
        room = 0.0 if np.issubdtype(expected.dtype, np.integer) else room
        yield from apart("second-engine", field.name, found, expected, room)


def copied(trace: TimeSeries, others: Mapping[str, TimeSeries]) -> Iterator[Breach]:
    """Yield the first run of another engine whose arrays of motion are the same to the last bit."""
    of_motion = ("q", "qd", "link_pos", "link_quat", "link_vel", "link_ang")
    motion = [field.name for field in fields(trace) if field.name in of_motion]
    for label, other in others.items():
        if all(np.array_equal(getattr(trace, name), getattr(other, name)) for name in motion):
            what = f"run with the same motion as {label}, to the last bit,"
            yield Breach("second-engine", what, "of another engine", "different")
