"""Constants of the course scene, with units."""

from dataclasses import dataclass

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Stepped:
    """Time steps of a run: `dt` is the outer step [s], which has `substeps` solver steps."""

    dt: float = DT
    substeps: int = SUBSTEPS

    @property
    def h(self) -> float:
        """Length of one solver step [s]."""
        return self.dt / self.substeps


def read_only(values: ArrayLike) -> FloatArray:
    """Return a copy of values in float64 that cannot be changed."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
