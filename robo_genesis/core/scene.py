"""Constants of the course scene, with units."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.floating]

DT = 0.01  # Outer time step that one `scene.step()` advances [s]

SUBSTEPS = 2  # Solver steps inside one outer step; one lasts DT / SUBSTEPS

# Seed of every run. It is part of the key of compiled kernels, so all pages
# use one value.
SEED = 0

CAMERA_RES = (720, 540)  # Width and height of a camera frame [pixel]

# The course's camera, placed before build.
CAMERA = {
    "res": CAMERA_RES,
    "pos": (1.8, -1.8, 1.4),  # [m]
    "lookat": (0.0, 0.0, 0.55),  # [m]
    "fov": 42,  # vertical [degree]
    "GUI": False,
}

# Rows, columns and colour channels of one camera frame.
FRAME_SHAPE = (CAMERA_RES[1], CAMERA_RES[0], 3)


def read_only(values: ArrayLike) -> FloatArray:
    """Return a copy of values in float64 that cannot be changed."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
