"""Checks of the camera functions that a student writes in L05's lab; see `core/exercises.py`."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from robo_genesis.core.checks import Check, Finding, at_most, equal
from robo_genesis.core.exercises import outcome
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim import camera_geometry as cameras

TINY_PIXEL = 1e-6
"""Largest difference of a pixel coordinate that rounding explains."""

TINY_POINT = 1e-6
"""Largest difference of a coordinate that rounding explains [m]."""

SIZE = (32, 20)
"""Columns and rows of the invented cameras."""

TURNED = np.array([
    [0.6, -0.48, 0.64, 1.1],
    [0.8, 0.36, -0.48, -0.7],
    [0.0, 0.8, 0.6, 0.9],
    [0.0, 0.0, 0.0, 1.0],
])  # fmt: skip
"""The pose of an invented camera that looks down, z backwards [m]."""

CAMERAS = {
    "straight": (cameras.intrinsics(60.0, SIZE), np.eye(4)),
    "turned": (cameras.intrinsics(42.0, SIZE), TURNED),
}
"""Camera matrix and pose of each invented camera."""


def world_points(transform: FloatArray, seen: FloatArray) -> FloatArray:
    """Return points (…, 3) of the world from coordinates in a camera: right, down, forwards."""
    pose = cameras.other_axes(transform)
    return seen @ pose[:3, :3].T + pose[:3, 3]


def project(function: Callable[..., Any]) -> list[Check]:
    """Check `project(points, K, transform)`: pixel coordinates (n, 2) of points (n, 3).

    The corner of the picture is (0, 0). `transform` is the engine's: x right, y up, z backwards.
    """

    def findings(_: None) -> Iterator[Finding]:
        seen = np.array([[0, 0, 1], [0.3, 0, 1], [0, 0.2, 1], [-0.4, 0.1, 2], [0.1, 0.3, 0.5]])
        for name, (K, transform) in CAMERAS.items():
            expected = (seen / seen[:, 2:] @ K.T)[:, :2]
            found = np.asarray(function(world_points(transform, seen), K, transform), dtype=float)
            yield equal(f"{name}.shape", list(found.shape), [len(seen), 2])
            if found.shape == expected.shape:
                apart = float(np.abs(found - expected).max())
                yield at_most(f"{name}.distance_px", apart, TINY_PIXEL)

    return outcome("project", findings)


def back_project(function: Callable[..., Any]) -> list[Check]:
    """Check `back_project(depth, K, transform)`: the point (H, W, 3) of each pixel's centre.

    `depth` (H, W) is measured along the optical axis. The pictures are of a plane in front of the
    camera, where depth is constant, and of a sloping one.
    """

    def findings(_: None) -> Iterator[Finding]:
        width, height = SIZE
        rows, columns = np.mgrid[:height, :width]
        depths = {
            "flat": np.full((height, width), 1.5),
            "sloping": 1 + 0.02 * rows + 0.01 * columns,
        }
        for name, (K, transform) in CAMERAS.items():
            right = (columns + 0.5 - K[0, 2]) / K[0, 0]
            down = (rows + 0.5 - K[1, 2]) / K[1, 1]
            for kind, depth in depths.items():
                label = f"{name}.{kind}"
                expected = world_points(transform, np.dstack([right * depth, down * depth, depth]))
                found = np.asarray(function(depth.copy(), K, transform), dtype=float)
                yield equal(f"{label}.shape", list(found.shape), list(expected.shape))
                if found.shape == expected.shape:
                    apart = float(np.abs(found - expected).max())
                    yield at_most(f"{label}.distance_m", apart, TINY_POINT)

    return outcome("back_project", findings)
