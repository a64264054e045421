"""A box that falls, as the runs of free bodies that pictures and replays show."""

import numpy as np

from robo_genesis.core.trace import BodyTrace

G = 10.0
LINKS = ("stand", "box")


def falling(
    height: float, steps: int = 30, dt: float = 0.01, drift: float = 0.0
) -> BodyTrace:
    """A box that falls from a height [m] and drifts along x [m/s], and a link that stays."""
    t = np.arange(steps + 1) * dt
    pos, vel = np.zeros((2, steps + 1, 2, 3), np.float32)
    pos[:, 1, 2], vel[:, 1, 2] = height - G * t**2 / 2, -G * t
    pos[:, 1, 0], vel[:, 1, 0] = drift * t, drift
    quat = np.tile(np.float32([1, 0, 0, 0]), (steps + 1, 2, 1))
    return BodyTrace(
        t=t, link_pos=pos, link_quat=quat, link_vel=vel, link_ang=np.zeros_like(pos)
    )
