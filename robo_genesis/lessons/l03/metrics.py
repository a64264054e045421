"""Metrics of bodies that land, slide or bounce, computed from their traces.

Zero is the energy of a body at rest on the surface.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, ContactTrace, first_time, settled_from
from robo_genesis.sim.bodies.contacts import ContactCase

# Clearance from which a body without contact points counts as separated [m]
CLEAR = 1e-4

# Half width of the band around the resting height in which a body has settled [m].
RESTING_BAND = 5e-4

# A body has stopped at the first sample from which it is slower [m/s] for this time
# [s].
STOP_SPEED, STOP_HOLD = 0.01, 0.10

BOUNCES_COUNTED = 4  # Number of bounces after which the remaining energy is measured

SHORTEST = 3  # Smallest number of consecutive states in the air that count as a flight

# Arrays of a bundle that several metrics are computed from.
POSE = ("link_pos_m", "link_quat_wxyz")
FLIGHT = ("contacts", *POSE, "t_s")
ENERGY = ("link_pos_m", "link_vel_m_s", "link_ang_rad_s")


@dataclass(frozen=True, slots=True)
class LandingMetrics(CaseMetrics):
    """How a dropped body lands and rests; `resting_offset` is negative where it sinks in."""

    touchdown: float | None = metric("s", "first sample at the surface", *POSE, "t_s")
    penetration: float = metric("m", "depth", *POSE)
    rebound: float = metric("m", "rebound", *POSE)
    separated: float = metric("s", "time separated", *FLIGHT)
    upward_speed: float = metric("m/s", "largest upward speed", *POSE, "link_vel_m_s")
    resting_time: float | None = metric("s", "settled at", "link_pos_m", "t_s")
    resting_offset: float = metric(
        "m", "height at the end against the ideal one", "link_pos_m"
    )


@dataclass(frozen=True, slots=True)
class SlideMetrics(CaseMetrics):
    """How a pushed body slides and stops."""

    stop_time: float | None = metric("s", "stop time", "link_vel_m_s", "t_s")
    stop_distance: float | None = metric(
        "m", "stopping distance", "link_pos_m", "link_vel_m_s", "t_s"
    )
    final_distance: float = metric("m", "distance at the end", "link_pos_m")
    first_speed: float = metric("m/s", "speed after one outer step", "link_vel_m_s")
    hop: float = metric("m", "hop", *POSE)
    airborne: float = metric("s", "time in the air", *FLIGHT)
    spin: float = metric("rad/s", "largest angular speed", "link_ang_rad_s")


@dataclass(frozen=True, slots=True)
class BounceMetrics(CaseMetrics):
    """How much energy a bouncing body keeps."""

    start_energy: float = metric("J", "energy at the start", *ENERGY)
    first_kept: float | None = metric("%", "energy kept at the first bounce", *ENERGY)
    later_kept: float | None = metric(
        "%", f"energy left after {BOUNCES_COUNTED} bounces", *ENERGY
    )
    flight_drift: float | None = metric(
        "J", "largest change of the conserved energy in a flight", *ENERGY
    )
    flight_change: float | None = metric(
        "J", "largest change of the total energy in a flight", *ENERGY
    )


def of_body(array: FloatArray) -> FloatArray:
    """Return an array (n+1, 1, …) of the only body as float64, (n+1, …)."""
    return array[:, 0].astype(np.float64)


def total_energy(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return m v² / 2 + I ω² / 2 + m g (z − z_rest) at each state, (n+1,) [J]."""
    z = of_body(trace.link_pos)[:, 2]
    v, w = of_body(trace.link_vel), of_body(trace.link_ang)
    motion = case.mass * (v**2).sum(axis=1) + case.inertia * (w**2).sum(axis=1)
    return motion / 2 + case.mass * case.gravity * (z - case.rest_height)


def conserved_energy(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return E − m g h v_z / 2 at each state, (n+1,) [J], which semi-implicit Euler conserves.

    In one free solver step v_z changes by −g h and z by h times the new v_z, so both
    the total energy E and m g h v_z / 2 change by −m g² h² / 2. At the top of a flight
    v_z is zero and both energies are equal.
    """
    v_z = of_body(trace.link_vel)[:, 2]
    return total_energy(trace, case) - case.mass * case.gravity * case.h * v_z / 2


def clearance(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return the height of the body's lowest point above the surface, (n+1,) [m]."""
    return case.clearance(of_body(trace.link_pos)[:, 2], of_body(trace.link_quat))


def aligned(
    fine: BodyTrace, coarse: BodyTrace, name: str
) -> tuple[FloatArray, FloatArray]:
    """Return an array of two runs of one body, (k, …), at the states that both recorded."""
    every = round(coarse.dt / fine.dt)
    one, other = getattr(fine, name)[::every, 0], getattr(coarse, name)[:, 0]
    shared = min(len(one), len(other))
    return one[:shared], other[:shared]


def flights(trace: BodyTrace, case: ContactCase) -> list[slice]:
    """Return the intervals of states in which the body is clear of the surface, in order."""
    in_air, _ = ndimage.label(clearance(trace, case) > 0)
    stretches = (states for (states,) in ndimage.find_objects(in_air))
    return [of for of in stretches if of.stop - of.start >= SHORTEST]


def case_metrics(trace: ContactTrace, case: ContactCase) -> CaseMetrics:
    """Measure a run by the motion that its case studies: bounce, slide or landing."""
    if case.spring:
        return bounce_metrics(trace, case)
    return slide_metrics(trace, case) if case.speed else landing_metrics(trace, case)


def landing_metrics(trace: ContactTrace, case: ContactCase) -> LandingMetrics:
    """Measure how a dropped body lands.

    touchdown    first sample at or below the surface
    penetration  max(0, −min clearance): the depth, of samples alone
    separated    samples after touchdown without contact points and with clearance, times dt
    """
    clear = clearance(trace, case)
    landed = np.maximum.accumulate(clear <= 0)
    after = landed & (np.arange(len(clear)) > 0)
    separated = after & (clear > CLEAR) & (trace.contacts[:, 0] == 0)
    offset = of_body(trace.link_pos)[:, 2] - case.rest_height
    upward = np.where(after, trace.link_vel[:, 0, 2], 0.0)
    return LandingMetrics(
        touchdown=first_time(trace.t, clear <= 0),
        penetration=max(0.0, -clear.min()),
        rebound=np.where(after, clear, 0.0).max(initial=0.0),
        separated=separated.sum() * trace.dt,
        upward_speed=upward.max(initial=0.0),
        resting_time=settled_from(trace.t, np.abs(offset) <= RESTING_BAND),
        resting_offset=offset[-1],
    )


def stopped_at(speed: FloatArray, dt: float) -> int | None:
    """Return the first sample from which |speed| < STOP_SPEED for STOP_HOLD, None without one.

    Args:
        speed: at each state, (n+1,) [m/s].
        dt: outer step [s]; a hold of k steps has k + 1 samples.
    """
    hold = round(STOP_HOLD / dt)
    slow = np.abs(speed) < STOP_SPEED
    return next(
        (k for k in range(len(slow) - hold) if slow[k : k + hold + 1].all()), None
    )


def slide_metrics(trace: ContactTrace, case: ContactCase) -> SlideMetrics:
    """Measure how a pushed body slides; distance and speed are those of its centre along x."""
    x, speed = of_body(trace.link_pos)[:, 0], of_body(trace.link_vel)[:, 0]
    clear, stop = clearance(trace, case), stopped_at(speed, trace.dt)
    airborne = (clear > CLEAR) & (trace.contacts[:, 0] == 0)
    spin = np.linalg.norm(of_body(trace.link_ang), axis=1)
    return SlideMetrics(
        stop_time=None if stop is None else trace.t[stop],
        stop_distance=None if stop is None else x[stop] - x[0],
        final_distance=x[-1] - x[0],
        first_speed=speed[1],
        hop=max(0.0, clear.max()),
        airborne=airborne.sum() * trace.dt,
        spin=spin.max(),
    )


def bounce_metrics(trace: ContactTrace, case: ContactCase) -> BounceMetrics:
    """Measure the energy of each flight, by the energy that semi-implicit Euler conserves.

    flight_change  largest change of the total energy within a flight; it is zero again when v_z is
    """
    kept, total = conserved_energy(trace, case), total_energy(trace, case)
    in_air = flights(trace, case)
    levels = [float(np.median(kept[flight])) for flight in in_air]

    def share(bounces: int) -> float | None:
        return 100 * levels[bounces] / levels[0] if len(levels) > bounces else None

    def largest_change(energy: FloatArray) -> float | None:
        return max((float(np.ptp(energy[flight])) for flight in in_air), default=None)

    return BounceMetrics(
        start_energy=total[0],
        first_kept=share(1),
        later_kept=share(BOUNCES_COUNTED),
        flight_drift=largest_change(kept),
        flight_change=largest_change(total),
    )
