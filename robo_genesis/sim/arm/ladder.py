"""What happened to the object in episodes: pressed, risen, in the bowl, at rest."""

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Episodes
from robo_genesis.sim.bodies import bowl

from .kinematics import rotate
from .picking import PickCase

PRESSES = 0.1  # Normal force from which a finger holds [N]

RAISED = 0.05  # Height that an object must gain in the lift [m]

# An object is in the bowl if its centre is this near to the axis, and its lowest point
# this far below the rim [m].
CENTRED, BELOW = 0.06, 0.01

# Time at the end [s] in which an object at rest moves by less than this [m], as in L07.
WINDOW, STILL = 0.2, 2e-4


def lowest(trace: Episodes, case: PickCase) -> FloatArray:
    """Return the height (n+1, e) of the lowest point of a cylinder or box [m]."""
    back = trace.object_quat * np.array([1.0, -1.0, -1.0, -1.0])
    up, half = np.abs(rotate(back, np.array([0.0, 0.0, 1.0]))), np.array(case.size) / 2
    if case.shape == "cylinder":
        reach = np.hypot(up[..., 0], up[..., 1]) * half[0] + up[..., 2] * half[2]
    else:
        reach = up @ half
    return trace.object_pos[..., 2] - reach


def off_axis(trace: Episodes, case: PickCase) -> FloatArray:
    """Return the horizontal distance (n+1, e) of the object from the axis of the bowl [m]."""
    return np.linalg.norm(trace.object_pos[..., :2] - case.bowl_at, axis=-1)


def pressed(trace: Episodes) -> np.ndarray:
    """Return the samples (n+1, e) in which both fingers hold the object."""
    return np.asarray((trace.force > PRESSES).all(axis=2))


def risen(trace: Episodes) -> FloatArray:
    """Return how far the object is above its start (n+1, e) [m]."""
    return trace.object_pos[..., 2] - trace.object_pos[0, :, 2]


def contained(trace: Episodes, case: PickCase) -> np.ndarray:
    """Return which objects (e,) are in the bowl at the end."""
    inside = off_axis(trace, case)[-1] < CENTRED
    return np.asarray(inside & (lowest(trace, case)[-1] < bowl.HEIGHT - BELOW))


def resting(trace: Episodes) -> np.ndarray:
    """Return which objects (e,) are at rest at the end."""
    last = trace.object_pos[-round(WINDOW / trace.dt) - 1 :]
    moved = np.linalg.norm(last[-1] - last, axis=2)
    return np.asarray(moved.max(axis=0) < STILL)


def of_object(trace: Episodes, case: PickCase) -> dict[str, np.ndarray]:
    """Return by rung which episodes (e,) pass it; no phase of an expert is used.

    `carried` is an object that both fingers press over the bowl, above its rim.
    """
    held = pressed(trace)
    raised = held & (risen(trace) >= RAISED)
    over = raised & (off_axis(trace, case) < CENTRED)
    return {
        "held": held.any(axis=0),
        "lifted": raised.any(axis=0),
        "carried": (over & (lowest(trace, case) > bowl.HEIGHT)).any(axis=0),
        "released": trace.touches[-1] == 0,
        "contained": contained(trace, case),
        "resting": resting(trace),
    }


def count(passed: dict[str, np.ndarray]) -> np.ndarray:
    """Return how many rungs each episode (e,) passes before the first that it fails."""
    return np.logical_and.accumulate(np.stack([*passed.values()])).sum(axis=0)
