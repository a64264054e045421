"""Free fall from rest: continuous, and stepped as a solver does.

The module does not use an engine. Results are distances fallen [m], so down is positive.
"""

import numpy as np
from numpy.typing import ArrayLike

from robo_genesis.core.scene import FloatArray

GRAVITY = 9.81  # Magnitude of the engine's default acceleration of gravity [m/s²]


def continuous_drop(t: ArrayLike, gravity: float = GRAVITY) -> FloatArray:
    """Return g t² / 2, the distance fallen from rest after times `t` (k,) [s]: (k,) [m]."""
    return 0.5 * gravity * np.asarray(t, dtype=np.float64) ** 2


def summed_drop(h: float, steps: ArrayLike, gravity: float = GRAVITY) -> FloatArray:
    """Return g h² n (n + 1) / 2, the distance fallen after n = `steps` steps [m].

    Semi-implicit Euler changes the velocity first, then the position. The velocity after step k is
    k g h, so step k moves by k g h²; 1 + 2 + … + n is n (n + 1) / 2.
    """
    n = np.asarray(steps, dtype=np.float64)
    return gravity * h**2 * n * (n + 1) / 2


def ahead_of_continuous(h: float, t: ArrayLike, gravity: float = GRAVITY) -> FloatArray:
    """Return g h t / 2: how much farther the stepped body is than g t² / 2 after times `t` [m].

    With t = n h, g h² n (n + 1) / 2 is g t² / 2 + g h t / 2. The second term goes to zero with h.
    """
    return 0.5 * gravity * h * np.asarray(t, dtype=np.float64)
