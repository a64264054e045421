"""The decimal numbers that prose of L01 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l01.spec import BASELINE

CONFIGURED = {
    "height of the sphere [m]": BASELINE.height,
    "length of the fall [s]": BASELINE.dt * BASELINE.steps,
    "solver step [s]": BASELINE.h,
    "height at the end that robo-genesis-101 publishes [m]": 0.298895,
    "height at the end by the school formula [m]": 0.304,
    "height at the end with one solver step in each outer step [m]": 0.294,
    "length of an outer step [s]": BASELINE.dt,
    "height at the end after 20 solver steps, by hand [m]": 0.45,
    "distance of the first outer step, by hand [mm]": 0.74,
}
