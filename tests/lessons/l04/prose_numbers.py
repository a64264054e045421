"""The decimal numbers that prose of L04 may hold: configured inputs."""

from robo_genesis.lessons.l04 import metrics, spec, study_spec
from robo_genesis.sim.arm.franka import Q_START

CONFIGURED = {
    "window [s]": spec.WINDOW,
    "step of joint4 [rad]": spec.STEP,
    "small step of joint4 [rad]": study_spec.SMALL_STEP,
    "demand of the small step of G1 [N·m]": float(spec.G1.kp[spec.ENTRY])
    * study_spec.SMALL_STEP,
    "target of a program [rad]": -study_spec.WANTED,
    "open finger [m]": Q_START[-1],
    "rise fraction": metrics.RISE_FRACTION,
    "settling band [rad]": metrics.SETTLING_BAND,
    "saturation threshold": metrics.SATURATION_THRESHOLD,
    "speed nearly at rest [rad/s]": study_spec.AT_REST,
    "margin of a rise time [s]": spec.MARGINS["rise_time"],
    "margin of a peak speed [rad/s]": spec.MARGINS["peak_speed"],
    "margin of an overshoot [rad]": spec.MARGINS["overshoot"],
    "margin of a count of samples": spec.MARGINS["saturation_samples"],
    "end of the time axis of figures [s]": 0.4,
    "armature of the model file [kg·m²]": 0.1,
}
