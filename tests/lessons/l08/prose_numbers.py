"""The decimal numbers that prose of L08 may hold: configured inputs and calculations by hand."""

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.sim.arm.lifting import HAND_TO_PAD
from robo_genesis.sim.bodies.grippers import ARMATURE, PAD_MASS

CONFIGURED = {
    "z of the interval": statistics.Z,
    "its square": round(statistics.Z**2, 2),
    "72 of 96": 72 / 96,
    "the same for 24 episodes, divided by their number": 0.16,
    "hand above the pads [m]": HAND_TO_PAD,
    "the same [mm]": 1e3 * HAND_TO_PAD,
    "hand above the table at the grasp [mm]": 148.4,
    "width of a wide box [m]": 0.078,
    "w of a pad, by hand [1/kg]": round(1 / (3 * (PAD_MASS + ARMATURE)), 3),
    "1 + m w, by hand": 1.03,
    "creep of the base case, by hand [mm/s]": 1.33,
    "its path in 10 s [mm]": 13.3,
    "the same with the largest impedance [mm]": 6.3,
    "share of the path, by hand": 0.924,
    "the factor (1 − d)/d that follows": 0.1026,
    "the impedance that follows": 0.907,
    "path, by hand [mm]": 12.3,
    "path with the elliptic cone, by hand [mm]": 0.06,
    "weight of half a kilogram [N]": 4.9,
    "µ from which the creep is nearly constant, by the formula": 1.2,
    "µ up to which it is, by the formula": 1.7,
    "one unit of float32 at 0.4 m per solver step, by hand [mm/s]": round(
        float(np.spacing(np.float32(0.4))) / 0.0025 * 1e3, 3
    ),
    "largest gain of force": 2.1,
    "share of µN of the box with 0.9 kg": 0.88,
    "force of a finger in an example [N]": 11.7,
    "mass that it carries, by hand [kg]": round(2 * 11.7 / (9.81 + 5), 2),
    "what a pyramid of 10 N carries at 45° [N]": round(2**0.5 * 10, 1),
    "weight of the box of 1.5 kg [N]": round(1.5 * 9.81, 1),
    "error of the reader's own task [m]": 0.008,
    "z of a 95 % interval": statistics.Z,
    "half of the length of a pad [mm]": 8.5,
    "permitted speed of joints 1 to 4 [rad/s]": 2.175,
    "permitted speed of joints 5 to 7 [rad/s]": 2.61,
    "height of a wall [m]": 0.3,
}
