"""Metrics of bodies that land, slide or bounce, from their traces alone, and their definitions."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from robo_genesis import records
from robo_genesis.contacts import BOUNCE, LANDING, SLIDE, ContactCase
from robo_genesis.energy import clearance, flights, kept_energy, total_energy
from robo_genesis.metrics import first_time, settled_from
from robo_genesis.scene_config import FloatArray
from robo_genesis.trace import ContactTrace

CLEAR = 1e-4
"""Clearance from which a body without contact points counts as separated [m]."""

RESTING_BAND = 5e-4
"""Half width of the band around the resting height in which a body has settled [m]."""

STOP_SPEED, STOP_HOLD = 0.01, 0.10
"""A body has stopped at the first sample from which it is slower [m/s] for this long [s]."""

BOUNCES_COUNTED = 4
"""After so many bounces the energy that is left is asked for."""

UNITS = {
    "touchdown": "s",
    "penetration": "m",
    "rebound": "m",
    "separated": "s",
    "upward_speed": "m/s",
    "resting_time": "s",
    "resting_offset": "m",
    "stop_time": "s",
    "stop_distance": "m",
    "final_distance": "m",
    "first_speed": "m/s",
    "hop": "m",
    "airborne": "s",
    "spin": "rad/s",
    "start_energy": "J",
    "first_kept": "%",
    "later_kept": "%",
    "flight_drift": "J",
    "lent": "J",
}

SOURCES = {
    "touchdown": ("link_pos_m", "link_quat_wxyz", "t_s"),
    "penetration": ("link_pos_m", "link_quat_wxyz"),
    "rebound": ("link_pos_m", "link_quat_wxyz"),
    "separated": ("contacts", "link_pos_m", "link_quat_wxyz", "t_s"),
    "upward_speed": ("link_pos_m", "link_quat_wxyz", "link_vel_m_s"),
    "resting_time": ("link_pos_m", "t_s"),
    "resting_offset": ("link_pos_m",),
    "stop_time": ("link_vel_m_s", "t_s"),
    "stop_distance": ("link_pos_m", "link_vel_m_s", "t_s"),
    "final_distance": ("link_pos_m",),
    "first_speed": ("link_vel_m_s",),
    "hop": ("link_pos_m", "link_quat_wxyz"),
    "airborne": ("contacts", "link_pos_m", "link_quat_wxyz", "t_s"),
    "spin": ("link_ang_rad_s",),
    "start_energy": ("link_pos_m", "link_vel_m_s", "link_ang_rad_s"),
    "first_kept": ("link_pos_m", "link_vel_m_s", "link_ang_rad_s"),
    "later_kept": ("link_pos_m", "link_vel_m_s", "link_ang_rad_s"),
    "flight_drift": ("link_pos_m", "link_vel_m_s", "link_ang_rad_s"),
    "lent": ("link_pos_m", "link_vel_m_s", "link_ang_rad_s"),
}
"""The arrays that each metric is computed from, by their names in a bundle."""

LABELS = {
    "touchdown": "first sample at the surface",
    "penetration": "penetration proxy",
    "rebound": "rebound",
    "separated": "time separated after touchdown",
    "upward_speed": "largest upward speed after touchdown",
    "resting_time": "settled at",
    "resting_offset": "height at the end against the ideal one",
    "stop_time": "stop time",
    "stop_distance": "stopping distance",
    "final_distance": "distance at the end",
    "first_speed": "speed after one outer step",
    "hop": "hop",
    "airborne": "time in the air",
    "spin": "largest angular speed",
    "start_energy": "energy at the start",
    "first_kept": "energy kept at the first bounce",
    "later_kept": f"energy left after {BOUNCES_COUNTED} bounces",
    "flight_drift": "largest change of the kept energy in a flight",
    "lent": "largest change of the total energy in a flight",
}


class CaseMetrics:
    """What one body did; units in `UNITS`, None where the window did not show it."""

    __slots__ = ()

    def items(self) -> list[tuple[str, float | None, str]]:
        """Return (name, value, unit) in the order of the table."""
        names = [field.name for field in fields(self)]  # type: ignore[arg-type]
        return [(name, getattr(self, name), UNITS[name]) for name in names]


@dataclass(frozen=True, slots=True)
class LandingMetrics(CaseMetrics):
    """How a dropped body came to lie; `resting_offset` is negative where it has sunk in."""

    touchdown: float | None
    penetration: float
    rebound: float
    separated: float
    upward_speed: float
    resting_time: float | None
    resting_offset: float


@dataclass(frozen=True, slots=True)
class SlideMetrics(CaseMetrics):
    """How far a pushed body came, and how."""

    stop_time: float | None
    stop_distance: float | None
    final_distance: float
    first_speed: float
    hop: float
    airborne: float
    spin: float


@dataclass(frozen=True, slots=True)
class BounceMetrics(CaseMetrics):
    """What a bouncing body kept of its energy."""

    start_energy: float
    first_kept: float | None
    later_kept: float | None
    flight_drift: float | None
    lent: float | None


def names_of(case: ContactCase) -> tuple[str, ...]:
    """Return the names of the metrics that a case has, by what is asked of it."""
    kinds = {LANDING: LandingMetrics, SLIDE: SlideMetrics, BOUNCE: BounceMetrics}
    return tuple(field.name for field in fields(kinds[case.kind]))


def case_metrics(trace: ContactTrace, case: ContactCase) -> CaseMetrics:
    """Measure one run by what is asked of it; the case gives its body, gravity and solver step."""
    by_kind = {LANDING: landing_metrics, SLIDE: slide_metrics, BOUNCE: bounce_metrics}
    return by_kind[case.kind](trace, case)


def measure(
    traces: Mapping[str, ContactTrace], cases: Mapping[str, ContactCase]
) -> dict[str, CaseMetrics]:
    """Return the metrics of each case.

    Raises:
        KeyError: a case has no trace.
    """
    return {name: case_metrics(traces[name], case) for name, case in cases.items()}


def landing_metrics(trace: ContactTrace, case: ContactCase) -> LandingMetrics:
    """Measure how a dropped body lands.

    touchdown    first sample at or below the surface
    penetration  max(0, −min clearance): a proxy, since it sees samples only
    separated    samples after touchdown without contact points and with clearance, times dt
    """
    clear = clearance(trace, case)
    landed = np.maximum.accumulate(clear <= 0)
    after = landed & (np.arange(len(clear)) > 0)
    apart = after & (clear > CLEAR) & (trace.contacts[:, 0] == 0)
    offset = trace.link_pos[:, 0, 2].astype(np.float64) - case.rest_height
    upward = np.where(after, trace.link_vel[:, 0, 2], 0.0)
    return LandingMetrics(
        touchdown=first_time(trace.t, clear <= 0),
        penetration=float(max(0.0, -clear.min())),
        rebound=float(np.where(after, clear, 0.0).max(initial=0.0)),
        separated=float(apart.sum() * trace.dt),
        upward_speed=float(upward.max(initial=0.0)),
        resting_time=settled_from(trace.t, np.abs(offset) <= RESTING_BAND),
        resting_offset=float(offset[-1]),
    )


def stopped_at(speed: FloatArray, dt: float) -> int | None:
    """Return the first sample from which |speed| < STOP_SPEED for STOP_HOLD, None if there is none.

    Args:
        speed: at each state, (n+1,) [m/s].
        dt: outer step [s]; a hold of k steps takes k + 1 samples.
    """
    hold = round(STOP_HOLD / dt)
    slow = np.abs(speed) < STOP_SPEED
    return next((k for k in range(len(slow) - hold) if slow[k : k + hold + 1].all()), None)


def slide_metrics(trace: ContactTrace, case: ContactCase) -> SlideMetrics:
    """Measure how a pushed body slides; distance and speed are those along x, of its centre."""
    x = trace.link_pos[:, 0, 0].astype(np.float64)
    speed = trace.link_vel[:, 0, 0].astype(np.float64)
    clear, stop = clearance(trace, case), stopped_at(speed, trace.dt)
    apart = (clear > CLEAR) & (trace.contacts[:, 0] == 0)
    turning = np.linalg.norm(trace.link_ang[:, 0].astype(np.float64), axis=1)
    return SlideMetrics(
        stop_time=None if stop is None else float(trace.t[stop]),
        stop_distance=None if stop is None else float(x[stop] - x[0]),
        final_distance=float(x[-1] - x[0]),
        first_speed=float(speed[1]),
        hop=float(max(0.0, clear.max())),
        airborne=float(apart.sum() * trace.dt),
        spin=float(turning.max()),
    )


def bounce_metrics(trace: ContactTrace, case: ContactCase) -> BounceMetrics:
    """Measure what a bouncing body keeps: energies of its flights, by the energy that steps keep.

    lent  largest change of the total energy within one flight, which comes back with the velocity
    """
    kept, total = kept_energy(trace, case), total_energy(trace, case)
    found = list(flights(trace, case))
    levels = [float(np.median(kept[flight])) for flight in found]

    def share(bounces: int) -> float | None:
        return 100 * levels[bounces] / levels[0] if len(levels) > bounces else None

    return BounceMetrics(
        start_energy=float(total[0]),
        first_kept=share(1),
        later_kept=share(BOUNCES_COUNTED),
        flight_drift=max((float(np.ptp(kept[flight])) for flight in found), default=None),
        lent=max((float(np.ptp(total[flight])) for flight in found), default=None),
    )


def metric_records(
    metrics: Mapping[str, CaseMetrics],
    model: Mapping[str, int],
    masses: Mapping[str, float],
    settings: Mapping[str, Mapping[str, float]],
) -> dict[str, dict[str, records.Record]]:
    """Return `metrics.json`: what the engine says of the model, and each case's metrics."""
    of_engine = {"model": records.counts(model), "mass": records.readings(masses, "kg")}
    of_engine |= {name: records.readings(found, "1") for name, found in settings.items()}
    return of_engine | records.cases(metrics, SOURCES)
