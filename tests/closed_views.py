"""Camera views in closed form: a ground at height 0 and one sphere; and a camera for tests."""

import numpy as np

from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.checks import Marker
from robo_genesis.sim.camera.views import View

PLANE, FAR = (
    1,
    20.0,
)  # Number of the ground in the segmentation, and where the view ends [m]

SIZE, FOV = (
    (160, 120),
    42.0,
)  # Columns and rows, and vertical field of view [degree] of the camera

# Pose of the camera, which looks down, z backwards [m].
TRANSFORM = cameras.looking((1.1, -0.7, 0.9), (0.46, -0.22, 0.3))

K = cameras.intrinsics(FOV, SIZE)
MARKER = Marker(
    3, (TRANSFORM @ (0.3, 0.2, -1.2, 1.0))[:3], 0.1
)  # A sphere in its view [m]


def plane_depth(start, directions, height=0.0) -> np.ndarray:
    """Return the depth (…) of the plane z = height along rays (…, 3) [m], NaN where behind."""
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = (height - start[2]) / directions[..., 2]
    return np.where(depth > 0, depth, np.nan)


def sphere_depth(start, directions, centre, radius) -> np.ndarray:
    """Return the depth (…) of the near side of a sphere along rays (…, 3), NaN for a miss [m]."""
    away = start - centre
    a = (directions**2).sum(axis=-1)
    half_b = directions @ away
    discriminant = half_b**2 - a * (away @ away - radius**2)
    depth = (-half_b - np.sqrt(np.where(discriminant >= 0, discriminant, np.nan))) / a
    return np.where(depth > 0, depth, np.nan)


def closed_view(
    marker: Marker = MARKER, fov=FOV, size=SIZE, transform=TRANSFORM
) -> View:
    """Return the view that a camera has to find; its colours are the numbers as grey."""
    matrix = cameras.intrinsics(fov, size)
    start, directions = cameras.rays(matrix, transform, size)
    plane = plane_depth(start, directions)
    sphere = sphere_depth(start, directions, marker.centre, marker.radius)
    hit = np.isfinite(sphere) & ~(sphere > plane)
    depth = np.where(hit, sphere, np.where(plane < FAR, plane, FAR))
    numbers = np.where(hit, marker.number, np.where(depth < FAR, PLANE, 0))
    grey = np.repeat(numbers[..., None], 3, axis=2).astype(np.uint8)
    limits = (0.1, FAR)
    return View(
        matrix, transform, size, limits, grey, np.float32(depth), np.int32(numbers)
    )
