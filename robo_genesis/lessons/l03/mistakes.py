"""Failures of landings and slides, made on purpose: what was compared, read or set in a wrong way.

Every function makes one mistake and measures what follows. None is a way to do anything.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.mistakes import Failure
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03.energy import clearance
from robo_genesis.lessons.l03.metrics import STOP_SPEED, slide_metrics, stopped_at
from robo_genesis.sim.contacts import TOP, ContactCase, build_world, run_world, time_constant

INSIDE = 1e-3
"""How deep a body must be in the surface to count as inside [m]."""


def equal_steps(fine: ContactTrace, coarse: ContactTrace) -> Failure:
    """Hold two runs of one motion against each other by the number of the step, not by time.

    Args:
        fine: a run.
        coarse: the same motion, looked at less often.
    """
    every = round(coarse.dt / fine.dt)
    n = min(len(coarse.t), (len(fine.t) - 1) // every + 1)
    by_number = np.abs(fine.link_pos[:n, 0, 2] - coarse.link_pos[:n, 0, 2])
    by_time = np.abs(fine.link_pos[: every * n : every, 0, 2][:n] - coarse.link_pos[:n, 0, 2])
    return Failure(
        "equal_steps",
        shown=bool(by_number.max() > 0.01 and by_time.max() < 1e-5),
        evidence=(
            f"Over {n - 1} steps each, one run covers {fine.t[n - 1]:g} s and the other "
            f"{coarse.t[n - 1]:g} s. Step by step they are up to {1000 * by_number.max():.0f} mm "
            f"apart; at equal times {1e6 * by_time.max():.2g} µm."
        ),
        curves={
            f"dt = {1000 * trace.dt:g} ms, by step number": (
                np.arange(n, dtype=float),
                trace.link_pos[:n, 0, 2].astype(np.float64),
            )
            for trace in (fine, coarse)
        },
    )


def no_contact_inside(trace: ContactTrace, case: ContactCase) -> Failure:
    """Take a contact count of zero for a body that touches nothing."""
    clear = clearance(trace, case)
    empty = np.flatnonzero((trace.contacts[:, 0] == 0) & (clear < -INSIDE))
    k = int(empty[np.argmin(clear[empty])]) if len(empty) else 0
    return Failure(
        "no_contact_inside",
        shown=bool(len(empty)),
        evidence=(
            f"At {trace.t[k]:.2f} s the engine reports {trace.contacts[k, 0]} contact points, and "
            f"the cube's underside is {-1000 * clear[k]:.1f} mm below the surface."
        ),
    )


def single_sample_stop(trace: ContactTrace, case: ContactCase) -> Failure:
    """Call a cube stopped at the first sample that is slow."""
    speed = trace.link_vel[:, 0, 0].astype(np.float64)
    slow, held = np.flatnonzero(np.abs(speed) < STOP_SPEED), stopped_at(speed, trace.dt)
    first = int(slow[0]) if len(slow) else 0
    later = float(np.abs(speed[first:]).max())
    told = "never" if held is None else f"at {trace.t[held]:.2f} s"
    above = float(trace.link_pos[first, 0, 2]) - case.rest_height
    return Failure(
        "single_sample_stop",
        shown=bool(len(slow) and first != held and later > 10 * STOP_SPEED),
        evidence=(
            f"The first slow sample is at {trace.t[first]:.2f} s. There the cube's centre is "
            f"{1000 * above:.1f} mm higher than that of a cube that lies on the surface; later on "
            f"it moves at up to {later:.2f} m/s. By the rule with a hold it stops {told}."
        ),
        curves={"speed along x": (trace.t, speed)},
    )


def unused_stiffness(gs: Any, case: ContactCase, seconds: float, asked: ContactTrace) -> Failure:
    """Give a contact a time constant that is shorter than the solver can take.

    Args:
        gs: the engine.
        case: with the engine's own contact.
        seconds: the time constant.
        asked: the run of the case with the engine's own contact.
    """
    stiff = replace(case, spring=(seconds, 1.0))
    world = build_world(gs, {"stiff": stiff})
    kept = time_constant(world)
    apart = np.abs(run_world(world)["stiff"].link_pos - asked.link_pos).max()
    return Failure(
        "unused_stiffness",
        shown=bool(apart < 1e-6 and abs(kept - seconds) < 1e-9),
        evidence=(
            f"Asked for {1000 * seconds:g} ms at a solver step of {1000 * case.h:g} ms; the geom "
            f"says {1000 * kept:g} ms when it is read back. The cube's motion and that with the "
            f"engine's own {2000 * case.h:g} ms differ by {1e6 * apart:.2g} µm."
        ),
    )


def smaller_friction(gs: Any, case: ContactCase, friction: float, before: ContactTrace) -> Failure:
    """Change the smaller one of two coefficients of friction, and expect another slide.

    Args:
        gs: the engine.
        case: a slide whose own friction is the smaller one.
        friction: the new one, still smaller than the surface's.
        before: the run of the case.
    """
    world = build_world(gs, {"changed": replace(case, friction=friction)})
    trace = run_world(world)["changed"]
    was, now = (slide_metrics(of, case).final_distance for of in (before, trace))
    return Failure(
        "smaller_friction",
        shown=bool(abs(now - was) < 1e-3),
        evidence=(
            f"The cube's own friction was {case.friction:g} and is {friction:g}; the surface has "
            f"{case.surface_friction:g}. The cube travelled {was:.4f} m, and now {now:.4f} m."
        ),
    )


def tunnel(gs: Any, case: ContactCase) -> Failure:
    """Let a body fall so fast that one solver step takes it past the surface."""
    trace = run_world(build_world(gs, {"fast": case}))["fast"]
    z = trace.link_pos[:, 0, 2].astype(np.float64)
    above = np.flatnonzero(z > TOP + case.size / 2)
    speed = float(np.abs(trace.link_vel[above[-1], 0, 2]))
    return Failure(
        "tunnel",
        shown=bool(z[-1] < TOP - case.size and trace.contacts.max() == 0),
        evidence=(
            f"The cube's centre ends at {z[-1]:.2f} m, the surface is at {TOP:g} m; "
            f"{int((trace.contacts > 0).sum())} samples report a contact. At {speed:.1f} m/s, just "
            f"before the surface, a solver step of {1000 * case.h:g} ms moves it by "
            f"{100 * speed * case.h:.0f} cm."
        ),
        curves={"height of the centre": (trace.t, z)},
    )
