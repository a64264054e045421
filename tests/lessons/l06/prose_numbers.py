"""The decimal numbers that prose of L06 may hold: configured inputs and calculations by hand."""

from robo_genesis.lessons.l06 import spec

CONFIGURED = {
    "time of the second command [s]": spec.SWITCH * spec.FIRST.dt,
    "time of the partial reset [s]": spec.RESET_AFTER * spec.FIRST.dt,
    "declared bound of a control force [N·m]": spec.SAME_RUN["control_force"],
    "position tolerance of the solver [mm]": 1000 * spec.IK.position_tolerance,
    "duration of the run in contact [s]": spec.STEPS * spec.FIRST.dt,
    "time constant of a row, by hand [s]": 0.8,
    "mean residual of a question [mm]": 0.1,
    "difference of a row in a question [µrad]": 0.3,
    "distance of neighbouring float32 numbers between 2 and 4, by hand": 0.24,
    "the same between 16 and 32 [1e-6], by hand": 1.9,
    "fixed part of a step, by hand [ms]": 0.6,
}
