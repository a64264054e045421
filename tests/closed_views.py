"""Camera views in closed form: a ground at height 0 and one sphere."""

import numpy as np

from robo_genesis.sim import camera_geometry as cameras
from robo_genesis.sim.camera_checks import Marker
from robo_genesis.sim.camera_views import View

PLANE, FAR = 1, 20.0
"""Number of the ground in the segmentation, and where the view ends [m]."""


def looking(pos, at) -> np.ndarray:
    """Return the pose (4, 4) of a camera at a place, upright: x right, y up, z backwards."""
    z = np.subtract(pos, at) / np.linalg.norm(np.subtract(pos, at))
    x = np.cross((0, 0, 1), z) / np.linalg.norm(np.cross((0, 0, 1), z))
    transform = np.eye(4)
    transform[:3] = np.column_stack([x, np.cross(z, x), z, pos])
    return transform


def closed_view(fov: float, size: tuple[int, int], transform, marker: Marker) -> View:
    """Return the view that a camera has to find; its colours are the numbers as grey."""
    K = cameras.intrinsics(fov, size)
    start, directions = cameras.rays(K, transform, size)
    plane = cameras.plane_depth(start, directions)
    sphere = cameras.sphere_depth(start, directions, np.array(marker.centre), marker.radius)
    hit = np.isfinite(sphere) & ~(sphere > plane)
    depth = np.where(hit, sphere, np.where(plane < FAR, plane, FAR))
    numbers = np.where(hit, marker.number, np.where(depth < FAR, PLANE, 0))
    grey = np.repeat(numbers[..., None], 3, axis=2).astype(np.uint8)
    limits = (0.1, FAR)
    return View(
        K, transform, size, limits, grey, depth.astype(np.float32), numbers.astype(np.int32)
    )
