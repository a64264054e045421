"""Values that only judge measurements, shared by lessons.

No run and no metric depends on them. Their change may change the verdict of a check; it must not
make recorded evidence stale.
"""

MEASURES = False

MASS_SHARE = 1e-5  # Relative tolerance of an engine's mass against density times volume: float32

TIME_TOLERANCE = 1e-9  # Tolerance of the time of a state against k · dt [s]

READ_BACK = 1e-6
"""Tolerance of a setting that is read back from an engine, in its own unit or as a share."""

LIMIT_TOLERANCE = 1e-6  # Tolerance for float32 at a joint limit [rad or m]

START_TOLERANCE = 1e-6  # Tolerance of the first height of a body against its case [m]
