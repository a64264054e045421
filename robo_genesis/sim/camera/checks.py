"""Named checks of a camera view: camera matrix, pose, projection of a marker, depth of its surface.

Each yields findings about one `View`; the label of a view keeps several apart. A view
without pictures passes the checks of pictures with the note SKIP.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, above, at_most, equal, noted
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.kinematics import rotate

from . import geometry as cameras
from .geometry import Residuals
from .views import View

SKIP = "SKIP"

SAME_MATRIX = 1e-9  # Largest difference of two camera matrices, both in float64 [pixel]

# Largest difference of a pose computed in float64 to the engine's float32 [m or 1].
SAME_POSE = 2e-6

FEWEST_PIXELS = 200  # A surface with fewer pixels is not judged by its picture

# A mask has whole pixels. At random places, the centroid of a disc of 200 pixels is up
# to 0.14 pixels from the centre of the disc. Largest distance of a centroid from the
# centre of the computed silhouette [pixel].
CENTROID = 0.15

# The engine draws a sphere as 1280 triangles, whose centres are 0.45 % nearer to its
# middle. Largest distance of a point from a sphere's surface, as a share of the radius.
MESH_SHARE = 0.006

# Largest distance of a point from a plane that is nearer than `PLANE_FAR` [m]
PLANE = 1e-4

PLANE_FAR = 3.0  # Depth up to which the bound of a plane holds [m]


@dataclass(frozen=True, slots=True, eq=False)
class Marker:
    """A sphere in view: number in the segmentation, centre (3,) and radius [m].

    Two markers are equal only if they are the same object, because a centre is an
    array.
    """

    number: int
    centre: FloatArray
    radius: float


def camera_matrix(label: str, view: View, given: Mapping[str, Any]) -> Findings:
    """Require the camera matrix of the vertical field of view, and the pose and the limits given.

    Args:
        label: of the view.
        view: as it was read.
        given: to `add_camera`: `fov` [degree], `near` and `far` [m], and, of a camera
            that is not on a link, `pos` and `lookat` [m].
    """
    apart = np.abs(view.intrinsics - cameras.intrinsics(given["fov"], view.size)).max()
    yield at_most(f"{label}.intrinsics_error_px", apart, SAME_MATRIX)
    yield equal(f"{label}.limits_m", view.limits, (given["near"], given["far"]))
    if "pos" in given:
        turned = view.transform - cameras.looking(given["pos"], given["lookat"])
        yield at_most(f"{label}.pose_error", np.abs(turned).max(), SAME_POSE)


def mounted_camera(
    label: str, view: View, position: FloatArray, quat: FloatArray, offset: FloatArray
) -> Findings:
    """Require the pose of a camera on a link to be the pose of the link times the offset.

    Args:
        label: of the view.
        view: as it was read.
        position: (3,) of the link in the world [m].
        quat: (4,) orientation of the link, (w, x, y, z).
        offset: (4, 4) the camera in the frame of the link [m].
    """
    link = np.eye(4)
    link[:3, :3], link[:3, 3] = rotate(quat, np.eye(3)).T, position
    apart = np.abs(view.transform - link @ offset)
    yield at_most(f"{label}.position_error_m", apart[:, 3].max(), SAME_POSE)
    yield at_most(f"{label}.axes_error", apart[:, :3].max(), SAME_POSE)


def computed(view: View, marker: Marker) -> tuple[FloatArray, FloatArray]:
    """Return where a marker's centre and the centre of its silhouette are, (2,) each [pixel]."""
    camera = view.intrinsics, view.transform
    ellipse = cameras.silhouette_centre(marker.centre, marker.radius, *camera)
    return cameras.project(marker.centre, *camera), ellipse


def projection(label: str, view: View, marker: Marker) -> Findings:
    """Require the centroid of a whole marker in the segmentation to be where a sphere's picture is.

    The picture of its centre is recorded too: perspective puts it nearer to the middle.
    """
    for axis, place in zip("uv", computed(view, marker)[0], strict=True):
        yield noted(f"{label}.centre_{axis}_px", place)
    if view.segmentation is None:
        yield noted(f"{label}.segmentation", SKIP)
        return
    mask = view.segmentation == marker.number
    yield equal(f"{label}.pixels_at_the_border", mask.sum() - mask[1:-1, 1:-1].sum(), 0)
    yield above(f"{label}.pixels", mask.sum(), FEWEST_PIXELS)
    apart = cameras.centroid(mask) - computed(view, marker)[1]
    to_ellipse = np.linalg.norm(apart)
    yield at_most(f"{label}.centroid_to_silhouette_px", to_ellipse, CENTROID)


def from_sphere(view: View, marker: Marker) -> Residuals | None:
    """Return how far outside a marker its back-projected pixels are, None without pictures."""
    if view.depth is None or view.segmentation is None:
        return None
    points = cameras.back_project(view.depth, view.intrinsics, view.transform)
    apart = np.linalg.norm(points - marker.centre, axis=-1) - marker.radius
    return cameras.residuals(apart[view.segmentation == marker.number])


def from_plane(view: View, number: int) -> Residuals | None:
    """Return how far above z = 0 the back-projected pixels of the ground are.

    Pixels deeper than `PLANE_FAR` are left out: the depth buffer resolves less there.

    Args:
        view: of the ground; without pictures, the result is None.
        number: of the ground in the segmentation.
    """
    if view.depth is None or view.segmentation is None:
        return None
    points = cameras.back_project(view.depth, view.intrinsics, view.transform)
    mask = (view.segmentation == number) & (view.depth < PLANE_FAR)
    return cameras.residuals(points[..., 2][mask])


def sphere_surface(label: str, view: View, marker: Marker) -> Findings:
    """Require the back-projected pixels of a marker, its edge included, to be on its surface."""
    return _surface(label, from_sphere(view, marker), MESH_SHARE * marker.radius)


def plane_surface(label: str, view: View, number: int) -> Findings:
    """Require the back-projected pixels of the ground to be at z = 0."""
    return _surface(label, from_plane(view, number), PLANE)


def _surface(label: str, found: Residuals | None, most: float) -> Findings:
    """Require pixels within a distance [m] of a surface; without pictures, they pass."""
    if found is None:
        yield noted(f"{label}.depth", SKIP)
        return
    yield above(f"{label}.pixels", found.count, FEWEST_PIXELS)
    yield at_most(f"{label}.largest_m", found.largest, most)
