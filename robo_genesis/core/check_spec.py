"""Values that only judge measurements, shared by lessons.

No run and no metric depends on them. Their change may change the verdict of a check; it
must not make recorded evidence stale.
"""

MEASURES = False

# Relative tolerance of an engine's mass against density times volume: float32
MASS_SHARE = 1e-5

TIME_TOLERANCE = 1e-9  # Tolerance of the time of a state against k · dt [s]

# Tolerance of a setting that is read back from an engine, in its own unit or as a
# share.
READ_BACK = 1e-6

LIMIT_TOLERANCE = 1e-6  # Tolerance for float32 at a joint limit [rad or m]

START_TOLERANCE = 1e-6  # Tolerance of the first height of a body against its case [m]

# By unit, or by array: (atol, rtol) of a value between engine versions, backends or
# processors.
TOLERANCES = {
    "m": (1e-5, 1e-3),
    "rad": (1e-5, 1e-3),
    "rad/s": (1e-3, 1e-3),
    "N·m": (1e-2, 1e-3),
    "N": (1e-2, 1e-3),
    "kg": (1e-6, 0.0),
    "pixel": (1e-6, 0.0),
    "1": (1e-6, 0.0),
    "m/s": (1e-3, 1e-3),
    "s": (0.0, 0.0),
    "link_quat_wxyz": (1e-4, 0.0),
}

# The same of a body that falls freely, and touches nothing.
FALL_TOLERANCES = {
    "m": (2e-6, 0.0),
    "m/s": (2e-5, 0.0),
    "rad/s": (1e-6, 0.0),
    "s": (0.0, 0.0),
    "kg": (1e-6, 0.0),
    "link_quat_wxyz": (1e-6, 0.0),
}
