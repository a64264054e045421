"""The decimal numbers that prose of L07 may hold: configured inputs and calculations by hand."""

import numpy as np

from robo_genesis.lessons.l07 import spec, table_map
from robo_genesis.sim.arm.kinematics import TIP
from robo_genesis.sim.arm.lifting import HAND_TO_PAD

GOOD, OUTSIDE = spec.SCENES["baseline"], spec.SCENES["outside"]

CONFIGURED = {
    "radius of the cylinder [m]": GOOD.size[0] / 2,
    "height of the cylinder [m]": GOOD.size[2],
    "its centre above the table [m]": GOOD.size[2] / 2,
    "its mass, by hand [kg]": 0.055,
    "force that holds it, by hand [N]": 0.27,
    "weight of the cylinder, by hand [N]": 0.54,
    "width of the slippery box [mm]": 1000 * spec.FORCED.size[1],
    "support error of a ball, by hand [mm]": 1.1,
    "the same with iteration [mm]": 0.64,
    "hand above the grip [mm]": 1e3 * HAND_TO_PAD,
    "hand above the table at the grasp, by hand [mm]": 148.4,
    "hand above the fingertips [mm]": 1e3 * TIP,
    "place of the bowl, x [m]": GOOD.bowl_at[0],
    "place of the bowl, y [m]": GOOD.bowl_at[1],
    "place of scene D, x [m]": OUTSIDE.place[0],
    "place of scene D, y [m]": OUTSIDE.place[1],
    "width of a box at its diagonal, by hand [mm]": 70.7,
    "cos ψ + sin ψ, by hand": 1.4,
    "speed after half a metre, by hand [m/s]": 3.1,
    "depth of a contact by it, by hand [mm]": 11.5,
    "mass of a cylinder of steel [kg]": 1.08,
    "its weight, by hand [N]": 10.6,
    "weight that two pads carry with little friction, by hand [N]": 2.4,
    "largest y of the map [m]": round(float(table_map.Y[-1]), 2),
    "farthest corner of the map, by hand [m]": round(
        float(np.hypot(table_map.X[-1], table_map.Y[-1])), 2
    ),
}
