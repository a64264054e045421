"""Mistakes made on purpose with landings and slides: wrong comparisons, readings and settings.

Every function makes one mistake and measures its symptom. None of them is an example to follow.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import metrics
from robo_genesis.lessons.l03.metrics import STOP_SPEED, slide_metrics, stopped_at
from robo_genesis.sim.bodies.contacts import TOP, ContactCase, build_world, run_world, time_constant

MEASURES = False


def equal_steps(fine: ContactTrace, coarse: ContactTrace) -> Mistake:
    """Compare two runs of one motion by the number of the step, not by time.

    Args:
        fine: a run.
        coarse: the same motion with fewer states.
    """
    by_time = np.subtract(*metrics.aligned(fine, coarse, "link_pos"), dtype=np.float64)[..., 2]
    n = len(by_time)
    heights = [trace.link_pos[:n, 0, 2].astype(np.float64) for trace in (fine, coarse)]
    apart, at_equal_times = np.abs(heights[0] - heights[1]).max(), np.abs(by_time).max()
    text = (
        f"In {n - 1} steps one run covers {fine.t[n - 1]:g} s and the other {coarse.t[n - 1]:g} s. "
        f"At equal step numbers they are up to {1000 * apart:.0f} mm apart, at equal times "
        f"{1e6 * at_equal_times:.2g} µm."
    )
    curves = {
        f"dt = {1000 * trace.dt:g} ms, by step number": (np.arange(n, dtype=float), z)
        for trace, z in zip((fine, coarse), heights, strict=True)
    }
    shown = bool(apart > 0.01 and at_equal_times < 1e-5)
    return Mistake("equal_steps", shown, text, curves, axis="number of the step")


def single_sample_stop(trace: ContactTrace, case: ContactCase) -> Mistake:
    """Take the first slow sample of a cube for its stop."""
    speed = trace.link_vel[:, 0, 0].astype(np.float64)
    slow, stop = np.flatnonzero(np.abs(speed) < STOP_SPEED), stopped_at(speed, trace.dt)
    first = int(slow[0]) if len(slow) else 0
    later = float(np.abs(speed[first:]).max())
    when = "never" if stop is None else f"at {trace.t[stop]:.2f} s"
    above = float(trace.link_pos[first, 0, 2]) - case.rest_height
    text = (
        f"The first slow sample is at {trace.t[first]:.2f} s. Then the cube's centre is "
        f"{1000 * above:.1f} mm above that of a cube at rest on the surface, and later the "
        f"cube moves at up to {later:.2f} m/s. By the rule with a hold it stops {when}."
    )
    shown = bool(len(slow) and first != stop and later > 10 * STOP_SPEED)
    curves = {"speed along x": (trace.t, speed)}
    return Mistake("single_sample_stop", shown, text, curves, "velocity [m/s]")


def unused_stiffness(gs: Any, case: ContactCase, seconds: float, default: ContactTrace) -> Mistake:
    """Set a time constant of a contact that is shorter than the solver allows.

    Args:
        gs: the engine.
        case: a case with the engine's default contact.
        seconds: the time constant [s].
        default: the run of that case.
    """
    world = build_world(gs, {"stiff": replace(case, spring=(seconds, 1.0))})
    found = time_constant(world)
    difference = np.abs(run_world(world)["stiff"].link_pos - default.link_pos).max()
    text = (
        f"{1000 * seconds:g} ms was set at a solver step of {1000 * case.h:g} ms, and the "
        f"geom returns {1000 * found:g} ms. The motion differs by {1e6 * difference:.2g} µm "
        f"from that with the engine's default of {2000 * case.h:g} ms."
    )
    shown = bool(difference < 1e-6 and abs(found - seconds) < 1e-9)
    return Mistake("unused_stiffness", shown, text)


def smaller_friction(gs: Any, case: ContactCase, friction: float, before: ContactTrace) -> Mistake:
    """Change the smaller of two coefficients of friction and expect another slide.

    Args:
        gs: the engine.
        case: a slide whose own friction is smaller than the surface's.
        friction: the new own friction, also smaller than the surface's.
        before: the run of the case.
    """
    world = build_world(gs, {"changed": replace(case, friction=friction)})
    trace = run_world(world)["changed"]
    was, now = (slide_metrics(of, case).final_distance for of in (before, trace))
    text = (
        f"The cube's own friction was {case.friction:g} and is now {friction:g}; the surface has "
        f"{case.surface_friction:g}. The cube travelled {was:.4f} m and now travels {now:.4f} m."
    )
    return Mistake("smaller_friction", bool(abs(now - was) < 1e-3), text)


def tunnel(gs: Any, case: ContactCase) -> Mistake:
    """Let a body fall so fast that it passes the surface within one solver step."""
    trace = run_world(build_world(gs, {"fast": case}))["fast"]
    z = trace.link_pos[:, 0, 2].astype(np.float64)
    above = np.flatnonzero(z > TOP + case.size / 2)
    speed = float(np.abs(trace.link_vel[above[-1], 0, 2]))
    text = (
        f"The cube's centre ends at {z[-1]:.2f} m, the surface is at {TOP:g} m; "
        f"{int((trace.contacts > 0).sum())} samples report a contact. Just before the surface, "
        f"at {speed:.1f} m/s, the cube moves {100 * speed * case.h:.0f} cm in one solver step "
        f"of {1000 * case.h:g} ms."
    )
    shown = bool(z[-1] < TOP - case.size and trace.contacts.max() == 0)
    return Mistake("tunnel", shown, text, {"height of the centre": (trace.t, z)})
