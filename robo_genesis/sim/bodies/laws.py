"""Laws of free bodies: free fall, contacts of the body's shape, and steps as MuJoCo makes them.

Contacts are a function of the state before the last solver step, which follows from the
state after it. MuJoCo has the same contact model, and computes each outer step anew from
the sample before it, so that no difference can grow.

| tolerance | residual of the CPU runs | value |
|---|---|---|
| `FALLEN`, place in free fall | 4e-7 m | 5e-6 m |
| `FALLING`, velocity in free fall | 5e-6 m/s | 1e-4 m/s |
| `DEPTH`, penetration | 1e-7 m | 5e-7 m |
| `GRAZE`, the same where the engine misses the lowest corner | 1.3e-5 m | 4e-5 m |
| `NEXT`, position after one outer step | 4e-7 m | 5e-6 m |
| `NEXT`, orientation | 2e-5 | 2e-4 |
| `NEXT`, velocity | 3e-5 m/s | 3e-4 m/s |
| `NEXT`, angular velocity | 2e-3 rad/s | 2e-2 rad/s |

The engine's search for a contact ends where it gains less than 1e-5 m, in some versions
plus 1e-5 of a sum of coordinates, which is up to 3 m here; both together are `GRAZE`.
"""

from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, ContactTrace
from robo_genesis.sim.arm.kinematics import quat_multiply
from robo_genesis.sim.laws import apart, each_run
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

from .contacts import ContactCase
from .free_fall import predicted
from .rigid_bodies import Drop

MEASURES = False

FALLEN, FALLING, DEPTH, GRAZE = 5e-6, 1e-4, 5e-7, 4e-5

NEXT = {"link_pos": 5e-6, "link_quat": 2e-4, "link_vel": 3e-4, "link_ang": 2e-2}

# Largest share of a run's steps in contact that miss the lowest corner: 0.06 in a newer
# version.
MISSED = 0.2

# Largest share of the steps of a run that may end otherwise in MuJoCo, because a cube
# that lands on an edge has other contact points there: 0.15 and 0.39 in two versions.
ON_EDGE = 0.5

UNTURNED = np.array([1.0, 0, 0, 0])  # Quaternion of a body that has not turned


def free_fall(run: Any) -> Findings:
    """At each sample place, velocity and orientation are those of a body under gravity alone."""
    return each_run(run, falling)


def falling(trace: BodyTrace, case: Drop) -> Findings:
    """Yield what no run of `rigid_bodies.run_drop` has that ends in the air, upright."""
    place, motion = np.zeros((2, trace.steps + 1, 3))
    place[:, 2] = case.height - predicted(trace, case)
    motion[:, 2] = -case.gravity * trace.t
    yield from apart("link_pos [m]", trace.link_pos[:, 0], place, FALLEN)
    yield from apart("link_vel [m/s]", trace.link_vel[:, 0], motion, FALLING)
    yield from apart("link_quat", trace.link_quat[:, 0], UNTURNED, 0.0)


def reported_depth(trace: ContactTrace, case: ContactCase) -> Findings:
    """Yield a penetration that is not that of the body's shape before the last solver step."""
    reported = trace.penetration[1:, 0]  # the first may be before any step
    depth = np.maximum(depth_before_last_step(trace, case)[1:], 0)
    missed = reported < depth - DEPTH
    room = np.where(missed, GRAZE, DEPTH)
    yield from apart("penetration [m]", reported, depth, room)
    share = np.atleast_1d(missed.sum() / max((depth > DEPTH).sum(), 1))
    yield from apart("share of missed corners", share, np.zeros(1), MISSED)


def repeated_steps(trace: ContactTrace, case: ContactCase) -> Findings:
    """Yield the share of the steps that MuJoCo makes otherwise, if there are too many."""
    if case.cone == "elliptic" and case.resolution is None:
        return  # MuJoCo does not have this scheme
    same = [
        (np.abs(getattr(trace, name)[1:, 0] - state) <= NEXT[name]).all(axis=1)
        for name, state in mujoco_contacts.each_step(trace, case).items()
    ]
    share = np.atleast_1d(1 - np.all(same, axis=0).mean())
    yield from apart("share of other steps in MuJoCo", share, np.zeros(1), ON_EDGE)


def depth_before_last_step(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return how deep the lowest point is below the surface before the last solver step (n+1,) [m].

    Semi-implicit Euler moves a body by the velocities after the step, for `h` seconds.
    """
    place, quat, velocity, spin = (
        getattr(trace, name)[:, 0].astype(np.float64) for name in mujoco_contacts.MOTION
    )
    height = place[:, 2] - case.h * velocity[:, 2]
    turn = -case.h * spin
    half = np.linalg.norm(turn, axis=1, keepdims=True) / 2
    back = np.hstack([np.cos(half), turn / 2 * np.sinc(half / np.pi)])
    return -case.clearance(height, quat_multiply(back, quat))
