"""Constants of the course scene, with units."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.floating]

FRANKA_MJCF = "xml/franka_emika_panda/panda.xml"
"""The Franka Panda that Genesis bundles, relative to the engine's asset folder."""

DT = 0.01
"""Outer time step that one `scene.step()` advances [s]."""

SUBSTEPS = 2
"""Solver steps inside one outer step; one lasts DT / SUBSTEPS."""

SEED = 0
"""Seed of every run. It is part of the key of compiled kernels, so all pages use one value."""

CAMERA_RES = (720, 540)
"""Width and height of a camera frame [pixel]."""

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

ARM_JOINTS = tuple(f"joint{number}" for number in range(1, 8))
FINGER_JOINTS = ("finger_joint1", "finger_joint2")
JOINT_NAMES = ARM_JOINTS + FINGER_JOINTS
"""The nine one-DOF joints, in the order of every array of the course."""


FRANKA_MODEL = {"links": 11, "joints": 9, "dofs": 9, "qpos": 9}
"""Counts of the robot's model, as the engine reports them."""

FRANKA_TYPES = ("REVOLUTE",) * 7 + ("PRISMATIC",) * 2
"""Type of each joint of `JOINT_NAMES`."""


def per_joint(*values: float) -> FloatArray:
    """Return a read-only array of shape (9,), one value for each of `JOINT_NAMES`."""
    if len(values) != len(JOINT_NAMES):
        raise ValueError(f"{len(values)} values given, one for each of {len(JOINT_NAMES)} joints")
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


Q_START = per_joint(0, -0.3, 0, -2.0, 0, 1.7, 0.79, 0.04, 0.04)
"""Start position: arm [rad], fingers [m]."""

KP_BASELINE = per_joint(4500, 4500, 3500, 3500, 2000, 2000, 2000, 100, 100)
"""Position gains: arm [N·m/rad], fingers [N/m]."""

KV_BASELINE = per_joint(450, 450, 350, 350, 200, 200, 200, 10, 10)
"""Velocity gains: arm [N·m·s/rad], fingers [N·s/m]."""

EFFORT_LIMIT = per_joint(87, 87, 87, 87, 12, 12, 12, 100, 100)
"""Symmetric bound of the commanded effort: arm [N·m], fingers [N]."""
