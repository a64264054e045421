"""The decimal numbers that prose of L07 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l07 import mistakes

CONFIGURED = {
    "mass of a cylinder of steel [kg]": mistakes.HEAVY,
    "its weight, by hand [N]": 10.6,
    "weight that two pads carry with little friction, by hand [N]": 7.2,
}
