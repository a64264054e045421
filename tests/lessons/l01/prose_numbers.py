"""The decimal numbers that prose of L01 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l01.spec import BASELINE

CONFIGURED = {
    "height of the sphere [m]": BASELINE.height,
    "length of the fall [s]": BASELINE.dt * BASELINE.steps,
    "solver step [s]": BASELINE.h,
    "height at the end that robo-genesis-101 publishes [m]": 0.298895,
    "height and distance by the school formula [m]": 0.3038,
    "distance by the school formula [m]": 0.1962,
    "distance of the first outer step, by hand [mm]": 0.74,
}
