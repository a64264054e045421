"""The decimal numbers that prose of L05 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l05 import spec

CONFIGURED = {
    "length of a run [s]": spec.BASELINE.steps * spec.BASELINE.dt,
    "radius of the marker [m]": spec.MARKER_RADIUS,
    "distance of the hand from an axis, by hand [m]": 0.6,
    "tangent of 30 degrees": 0.577,
    "depth of the point in the third calculation [m]": 1.5,
    "its distance to the right [m]": 0.1,
    "another depth [m]": 1.51,
    "distance of the target along x [m]": spec.TARGET[0],
    "height of the target [m]": spec.TARGET[2],
    "near limit that cuts the hand [m]": spec.CUT[0],
    "far limit that cuts the floor [m]": spec.CUT[1],
    "damping of our search": 0.1,
    "largest step of our search [rad]": 0.2,
    "damping of the engine": spec.IK.damping,
    "height of the shoulder in the model file [m]": 0.333,
    "reach that the manufacturer gives [m]": 0.855,
    "shoulder to the target beyond reach, by hand [m]": 2.6,
    "what the reach leaves of it, by hand [m]": 1.75,
    "offset of a pixel's centre, without the halves [pixel]": 0.7,
    "near limit of a camera by default [m]": 0.1,
    "far limit with a share for rounding": 0.999,
}
