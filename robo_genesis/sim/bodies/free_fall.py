"""Free fall from rest: continuous, stepped as a solver does, and as a run has it.

The module does not use an engine. Results are distances fallen [m], so down is
positive. A `case` has `h`, `substeps` and `gravity`.
"""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace

GRAVITY = 9.81  # Magnitude of the engine's default acceleration of gravity [m/s²]


def continuous_drop(t: Any, gravity: float) -> Any:
    """Return g t² / 2, the distance fallen from rest after times `t` (…) [s]: (…) [m]."""
    return 0.5 * gravity * t**2


def summed_drop(h: float, n: Any, gravity: float = GRAVITY) -> Any:
    """Return g h² n (n + 1) / 2, the distance fallen after n (…) steps: (…) [m].

    Semi-implicit Euler changes the velocity first, then the position. The velocity
    after step k is k g h, so step k moves by k g h²; 1 + 2 + … + n is n (n + 1) / 2.
    """
    return gravity * h**2 * n * (n + 1) / 2


def ahead_of_continuous(h: float, t: float, gravity: float) -> float:
    """Return g h t / 2: how much farther the stepped body is than g t² / 2 after `t` [s]: [m].

    With t = n h, g h² n (n + 1) / 2 is g t² / 2 + g h t / 2. The second term goes to
    zero with h.
    """
    return 0.5 * gravity * h * t


def fallen(trace: BodyTrace) -> FloatArray:
    """Return how far the first link is below its start at each sample, (n+1,) [m]."""
    height = trace.link_pos[:, 0, 2].astype(np.float64)
    return height[0] - height


def predicted(trace: BodyTrace, case: Any) -> FloatArray:
    """Return the distance that semi-implicit Euler falls until each sample, (n+1,) [m]."""
    solver_steps = case.substeps * np.arange(len(trace.t))
    return summed_drop(case.h, solver_steps, case.gravity)


def formula_error(trace: BodyTrace, case: Any) -> float:
    """Return the largest distance of a sample from the stepped formula [m]."""
    return float(np.abs(fallen(trace) - predicted(trace, case)).max())


def continuous_gap(trace: BodyTrace, case: Any) -> float:
    """Return how much farther than g t² / 2 the body fell until the last sample [m]."""
    return float(fallen(trace)[-1] - continuous_drop(trace.t[-1], case.gravity))
