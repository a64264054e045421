"""Named checks of the recorded views of the page about cameras."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import Finding, above, equal, noted
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import camera_spec
from robo_genesis.lessons.l05.metrics import HAND
from robo_genesis.lessons.l05.view_record import SEGMENTS, view_of
from robo_genesis.sim import camera_checks

PLANE, MARKER = "plane", "marker"


def marker(run: Experiment) -> camera_checks.Marker:
    """Return the marker with its number; without pictures, it has none."""
    number = run.readings[SEGMENTS][MARKER] if run.rendered else 0
    return camera_checks.Marker(int(number), camera_spec.MARKER, camera_spec.MARKER_RADIUS)


def camera_matrix(run: Experiment) -> Iterator[Finding]:
    for name, fov in camera_spec.FOV.items():
        yield from camera_checks.camera_matrix(name, view_of(run, name), fov)


def mounted_camera(run: Experiment) -> Iterator[Finding]:
    trace, offset = run.traces["baseline"], np.array(camera_spec.ON_HAND)
    pose = trace.link_pos[-1, HAND], trace.link_quat[-1, HAND]
    yield from camera_checks.mounted_camera("hand", view_of(run, "hand"), *pose, offset)


def projection(run: Experiment) -> Iterator[Finding]:
    yield from camera_checks.projection("world", view_of(run, "world"), marker(run))


def sphere_surface(run: Experiment) -> Iterator[Finding]:
    yield from camera_checks.sphere_surface("world", view_of(run, "world"), marker(run))


def plane_surface(run: Experiment) -> Iterator[Finding]:
    number = int(run.readings[SEGMENTS][PLANE]) if run.rendered else 0
    for name in camera_spec.FOV:
        yield from camera_checks.plane_surface(name, view_of(run, name), number)


def near_and_far(run: Experiment) -> Iterator[Finding]:
    view = view_of(run, "cut")
    if view.depth is None or view.segmentation is None:
        yield noted("cut.depth", camera_checks.SKIP)
        return
    surface = view.segmentation > 0
    outside = (view.depth < camera_spec.CUT[0]) | (view.depth > camera_spec.CUT[1])
    yield equal("cut.surface_pixels_outside", int((outside & surface).sum()), 0)
    yield above("cut.pixels_without_surface", int((~surface).sum()), camera_checks.FEWEST_PIXELS)


CAMERAS = (
    camera_matrix, mounted_camera, projection, sphere_surface, plane_surface, near_and_far,
)  # fmt: skip

CLAIMS: dict[str, str] = {
    "camera_matrix": "The engine's camera matrix is that of the vertical field of view.",
    "mounted_camera": "The camera on the hand is at the pose of the hand times the offset.",
    "projection": "The centroid of the whole marker is where the picture of a sphere is.",
    "sphere_surface": "Each pixel of the marker lies on its surface.",
    "plane_surface": "Each pixel of the plane that is nearer than 3 m is at height 0.",
    "near_and_far": "No surface nearer than the near limit or farther than the far one is drawn.",
}
