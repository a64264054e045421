"""The decimal numbers that prose of L03 may hold: configured inputs, and calculations by hand."""

import numpy as np

from robo_genesis.lessons.l03 import spec, study_spec
from robo_genesis.lessons.l03.metrics import STOP_SPEED
from robo_genesis.sim.bodies import contacts
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

FALL = study_spec.HEIGHTS_STUDIED[-1] - spec.BASELINE.rest_height
FASTEST = float(np.sqrt(2 * spec.BASELINE.gravity * FALL))
LOW, HIGH = spec.PUSHED.friction, spec.PUSHED.surface_friction
CONFIGURED = {
    "edge of the cube [m]": spec.BASELINE.size,
    "height of the surface [m]": contacts.TOP,
    "thickness of the surface [m]": contacts.SURFACE_SIZE[2],
    "centre of a cube at rest [m]": spec.BASELINE.rest_height,
    "fall of the cube [m]": spec.BASELINE.start[2] - spec.BASELINE.rest_height,
    "lowest height studied [m]": study_spec.HEIGHTS_STUDIED[0],
    "highest height studied [m]": study_spec.HEIGHTS_STUDIED[-1],
    "finest step studied [ms]": 0.125,
    "fastest landing of the heights studied [m/s]": round(FASTEST, 1),
    "least speed of a rebound with T = 10 ms [m/s]": round(
        4 * 9.81 * 0.01 * np.e**2, 1
    ),
    "window of a landing [s]": spec.BASELINE.duration,
    "friction of the first cubes, and the hold of a stop [s]": spec.PUSHED.friction,
    "friction of the other cubes": spec.BESIDE.friction,
    "friction of the surface": spec.PUSHED.surface_friction,
    "mean of both coefficients": round((LOW + HIGH) / 2, 2),
    "friction of the other surface, and the time to settle [s]": spec.PUSHED.settle,
    "speed of a stopped body [m/s], and a damping ratio": STOP_SPEED,
    "speed of a gentle push [m/s]": study_spec.SLOW,
    "step of T / 4 [ms]": 2.5,
    "height of the fixed step [m]": 0.02,
    "fall in the first calculation [m]": 0.05,
    "e, to one digit, and the speed [m/s] of v T / e = 2 mm with T = 2 ms": round(
        float(np.e), 1
    ),
    "largest impedance": mujoco_contacts.IMPEDANCE[1],
    "1 + μ² of the hop by hand": 1 + HIGH**2,
    "its upward speed [m/s]": 0.4,
    "T / 10 in the first calculation [ms]": 0.27,
    "an outer step of 2 ms, divided by it": round(2 / 0.27, 1),
    "the same with 5 ms": round(5 / 0.27, 1),
    "fall in the third calculation [m]": 0.11,
}
