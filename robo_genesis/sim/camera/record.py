"""A camera view in a bundle: colours, depth and segmentation as frames, K and pose as readings.

A bundle holds frames of one size, `CAMERA_RES`, with 8 bits for each of three colours.
A depth takes 24 bits in units of `DEPTH_UNIT`, the highest in red. The number of a
segmentation is in red.
"""

from dataclasses import replace

import numpy as np

from robo_genesis.core.experiment import Experiment, Readings
from robo_genesis.core.scene import CAMERA_RES

from .views import View

DEPTH_UNIT = 1e-5  # Resolution of a recorded depth [m]; 24 bits reach 167 m

# Group of counts: the numbers of things in the segmentation, by name
SEGMENTS = "segments"

PICTURES = ("rgb", "depth", "segmentation")

# Units of the readings of one view.
NUMBERS = {
    **{
        f"intrinsics_{i}{j}": "pixel" if i < 2 else "1"
        for i in range(3)
        for j in range(3)
    },
    **{
        f"transform_{i}{j}": "m" if i < 3 and j == 3 else "1"
        for i in range(4)
        for j in range(4)
    },
    "near": "m",
    "far": "m",
}


def frame_names(*views: str) -> tuple[str, ...]:
    """Return the names of the frames of views, for the declaration of a page."""
    return tuple(f"{view}_{picture}" for view in views for picture in PICTURES)


def groups(*views: str) -> dict[str, Readings]:
    """Return the groups of readings of views, for the declaration of a page."""
    return {f"view_{view}": Readings(NUMBERS) for view in views}


def numbers(view: View) -> dict[str, float]:
    """Return the readings of a view: camera matrix, pose, and limits."""
    parts = (view.intrinsics.ravel(), view.transform.ravel(), view.limits)
    return dict(zip(NUMBERS, np.concatenate(parts).tolist(), strict=True))


def frames(name: str, view: View) -> dict[str, np.ndarray]:
    """Return the frames (H, W, 3), uint8, of a view, none without pictures."""
    if view.rgb is None or view.depth is None or view.segmentation is None:
        return {}
    whole = np.rint(np.asarray(view.depth, dtype=float) / DEPTH_UNIT).astype(np.uint32)
    depth = np.stack([whole >> 16, whole >> 8 & 255, whole & 255], axis=-1).astype(
        np.uint8
    )
    segmentation = np.zeros(view.rgb.shape, np.uint8)
    segmentation[..., 0] = view.segmentation
    return dict(zip(frame_names(name), (view.rgb, depth, segmentation), strict=True))


def view_of(run: Experiment, name: str) -> View:
    """Return a recorded view; without a camera, it has no pictures."""
    found = run.readings[f"view_{name}"]
    values = np.array([found[number] for number in NUMBERS])
    K, transform, limits = (
        values[:9].reshape(3, 3),
        values[9:25].reshape(4, 4),
        values[25:],
    )
    view = View(K, transform, CAMERA_RES, (float(limits[0]), float(limits[1])))
    if not run.rendered:
        return view
    rgb, depth, segmentation = (run.frames[frame] for frame in frame_names(name))
    numbered = segmentation[..., 0].astype(np.int32)
    metres = depth.astype(float) @ (65536.0, 256.0, 1.0) * DEPTH_UNIT
    return replace(view, rgb=rgb, depth=metres, segmentation=numbered)
