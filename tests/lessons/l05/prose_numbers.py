"""The decimal numbers that prose of L05 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l05 import camera_spec, spec

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
    "height of the target [m]": spec.TARGET[2],
    "near limit of the narrow view [m]": camera_spec.CUT[0],
    "share of the far limit from which nothing is there": 0.999,
    "height of the shoulder in the model file [m]": 0.333,
    "reach of the arm as Franka publishes it [m]": 0.855,
    "distance from the shoulder to the target beyond reach, by hand [m]": 2.6,
    "that distance less the reach, by hand [m]": 1.75,
}
