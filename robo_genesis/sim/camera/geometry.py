"""Camera geometry in NumPy: camera matrix, projection, back-projection, masks.

A pixel has two coordinates, u to the right and v down. The corner of the picture is (0,
0), so the centre of column i and row j is (i + ½, j + ½). An array of pixels has shape
(H, W): its first index is the row. `K` (3, 3) is the camera matrix [pixel]. A
`transform` (4, 4) is the pose of a camera in the world as the engine reports it: x
right, y up, z backwards (OpenGL) [m]. The computation uses x right, y down, z forwards
(OpenCV). Depth is the distance along the optical axis [m].
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray

# Turns y and z of a camera around: from OpenGL to OpenCV, and back.
FLIP = np.diag([1.0, -1.0, -1.0, 1.0])


def intrinsics(fov: float, size: tuple[int, int]) -> FloatArray:
    """Return the camera matrix (3, 3) of square pixels [pixel].

    Args:
        fov: vertical field of view [degree].
        size: columns and rows.
    """
    width, height = size
    f = 0.5 * height / np.tan(np.deg2rad(fov) / 2)
    return np.array([[f, 0, width / 2], [0, f, height / 2], [0, 0, 1]])


def other_axes(transform: FloatArray) -> FloatArray:
    """Return the pose (4, 4) of a camera with OpenCV axes from one with OpenGL axes, or back."""
    return np.asarray(transform, dtype=float) @ FLIP


def looking(pos: Sequence[float], at: Sequence[float]) -> FloatArray:
    """Return the pose (4, 4) of an upright camera at a place: x right, y up, z backwards [m].

    Args:
        pos: (3,) its place [m].
        at: (3,) the point in the middle of its picture, not straight above or below
            [m].
    """
    z = np.subtract(pos, at) / np.linalg.norm(np.subtract(pos, at))
    x = np.cross((0, 0, 1), z) / np.linalg.norm(np.cross((0, 0, 1), z))
    transform = np.eye(4)
    transform[:3] = np.column_stack([x, np.cross(z, x), z, pos])
    return transform


def in_camera(points: FloatArray, transform: FloatArray) -> FloatArray:
    """Return points (…, 3) of the world in camera coordinates: right, down, forwards [m]."""
    pose = other_axes(transform)
    return (np.asarray(points, dtype=float) - pose[:3, 3]) @ pose[:3, :3]


def project(points: FloatArray, K: FloatArray, transform: FloatArray) -> FloatArray:
    """Return the pixel coordinates (…, 2) of points (…, 3) [m]; NaN for points not in front."""
    seen = in_camera(points, transform)
    depth = np.where(seen[..., 2:] > 0, seen[..., 2:], np.nan)
    return (seen / depth @ K.T)[..., :2]


def silhouette_centre(
    centre: FloatArray, radius: float, K: FloatArray, transform: FloatArray
) -> FloatArray:
    """Return the centre (2,) of the ellipse that a sphere covers in a picture [pixel].

    The picture of the centre is nearer to the middle of the picture, by the factor 1 −
    r²/z². A sphere that the plane z = 0 of the camera touches or cuts gives NaN.
    """
    x, y, z = in_camera(centre, transform)
    if z <= radius:
        return np.full(2, np.nan)
    stretched = np.array([x, y, z - radius**2 / z])
    return (K @ stretched / stretched[2])[:2]


def rays(
    K: FloatArray, transform: FloatArray, size: tuple[int, int]
) -> tuple[FloatArray, FloatArray]:
    """Return the camera's position (3,) and the direction (H, W, 3) through each pixel [m].

    The component of a direction along the optical axis is 1. So position + depth ·
    direction is the point at that depth.

    Args:
        K: camera matrix.
        transform: of the camera.
        size: columns and rows.
    """
    width, height = size
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)  # (H, W)
    pose = other_axes(transform)
    directions = np.dstack([u, v, np.ones((height, width))]) @ np.linalg.inv(K).T
    return pose[:3, 3], directions @ pose[:3, :3].T


def back_project(depth: FloatArray, K: FloatArray, transform: FloatArray) -> FloatArray:
    """Return the point (H, W, 3) of the world that each pixel shows, from its depth (H, W) [m]."""
    height, width = np.shape(depth)
    start, directions = rays(K, transform, (width, height))
    return start + np.asarray(depth, dtype=float)[..., None] * directions


def centroid(mask: np.ndarray) -> FloatArray:
    """Return the mean (2,) of the pixel centres of a mask (H, W) [pixel], NaN if it is empty."""
    rows, columns = np.nonzero(mask)
    if not rows.size:
        return np.full(2, np.nan)
    return np.array([columns.mean() + 0.5, rows.mean() + 0.5])


@dataclass(frozen=True, slots=True)
class Residuals:
    """Distances of points from a surface [m]: their number, mean, and largest size."""

    count: int
    mean: float
    largest: float


def residuals(apart: FloatArray) -> Residuals:
    """Summarise signed distances (n,) [m]; without any, mean and largest are NaN.

    One distance that is not finite makes both of them not finite, which no check
    accepts.
    """
    if not apart.size:
        return Residuals(0, np.nan, np.nan)
    return Residuals(apart.size, float(apart.mean()), float(np.abs(apart).max()))
