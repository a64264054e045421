"""Constants of the course scene, with units."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.floating]

DT = 0.01  # Outer time step that one `scene.step()` advances [s]

SUBSTEPS = 2  # Solver steps inside one outer step; one lasts DT / SUBSTEPS

SEED = 0
"""Seed of every run. It is part of the key of compiled kernels, so all pages use one value."""

CAMERA_RES = (720, 540)  # Width and height of a camera frame [pixel]

CAMERA = {
    "res": CAMERA_RES,
    "pos": (1.8, -1.8, 1.4),  # [m]
    "lookat": (0.0, 0.0, 0.55),  # [m]
    "fov": 42,  # vertical [degree]
    "GUI": False,
}
"""The course's camera, placed before build."""

FRAME_SHAPE = (CAMERA_RES[1], CAMERA_RES[0], 3)
"""Rows, columns and colour channels of one camera frame."""


def read_only(values: ArrayLike) -> FloatArray:
    """Return a copy of values in float64 that cannot be changed."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
