"""The decimal numbers that prose of L05 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l05 import spec

CONFIGURED = {
    "length of a run [s]": spec.BASELINE.steps * spec.BASELINE.dt,
    "radius of the marker [m]": spec.MARKER_RADIUS,
    "distance of the hand from an axis, by hand [m]": 0.45,
    "tangent of 21 degrees": 0.384,
    "angle of a sagging joint, by hand [mrad]": 4.9,
    "sag by hand [mm]": 2.2,
    "depth of the point in the third calculation [m]": 1.5,
    "its distance to the right [m]": 0.1,
    "another depth [m]": 1.51,
}
