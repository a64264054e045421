"""The decimal numbers that prose of L05 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l05 import spec
from robo_genesis.sim.arm import kinematics

CONFIGURED = {
    "length of a run [s]": spec.BASELINE.steps * spec.BASELINE.dt,
    "radius of the marker [m]": spec.MARKER_RADIUS,
    "distance of the hand from an axis, by hand [m]": 0.6,
    "tangent of 30 degrees": 0.577,
    "depth of the point in the third calculation [m]": 1.5,
    "another depth [m]": 1.51,
    "distance of the target along x [m]": spec.TARGET[0],
    "height of the target [m]": spec.TARGET[2],
    "near limit that cuts the hand [m]": spec.CUT[0],
    "far limit that cuts the floor [m]": spec.CUT[1],
    "fingertips from the hand's origin [m]": kinematics.TIP,
    "height of a target near the border of the reach [m]": 0.143,
    "depth of the sag, rounded for a calculation by hand [m]": 1.7,
    "planar arm, first link [m]": 0.4,
    "planar arm, second link [m]": 0.3,
    "planar arm, cosine of 30 degrees": 0.866,
    "planar arm, x of joint 2 by hand [m]": 0.346,
    "planar arm, y of joint 2 by hand [m]": 0.2,
    "planar arm, y of the hand by hand [m]": 0.5,
    "planar arm, step by hand [rad]": 0.033,
    "planar arm, determinant at 90 degrees by hand": 0.12,
    "damping of the engine, and way of the planar arm's step [m]": spec.IK.damping,
    "height of the shoulder in the model file [m]": 0.333,
    "reach that the manufacturer gives [m]": 0.855,
    "shoulder to the target beyond reach, by hand [m]": 2.6,
    "what the reach leaves of it, by hand [m]": 1.75,
    "offset of a pixel's centre, without the halves [pixel]": 0.7,
    "near limit of a camera by default, distance to the right in the third calculation [m]": 0.1,
    "far limit with a share for rounding": 0.999,
}
