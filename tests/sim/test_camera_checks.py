"""The checks of camera views: they pass in closed form, and each fails for its own fault."""

from dataclasses import replace

import numpy as np
import pytest
from closed_views import PLANE, closed_view

from robo_genesis.sim import camera_checks
from robo_genesis.sim import camera_geometry as cameras
from robo_genesis.sim.camera_checks import Marker
from robo_genesis.sim.camera_views import View

SIZE = (160, 120)
K = cameras.intrinsics(42.0, SIZE)
TRANSFORM = np.array([
    [0.6, -0.48, 0.64, 1.1],
    [0.8, 0.36, -0.48, -0.7],
    [0.0, 0.8, 0.6, 0.9],
    [0.0, 0.0, 0.0, 1.0],
])  # fmt: skip
MARKER = Marker(3, tuple((TRANSFORM @ (0.3, 0.2, -1.2, 1.0))[:3].tolist()), 0.1)


def seen(marker=MARKER):
    """Return a view of a plane and one sphere, both in closed form."""
    return closed_view(42.0, SIZE, TRANSFORM, marker)


def problems(findings):
    return [finding.label.split(".")[1] for finding in findings if not finding.passed]


def test_checks_pass_for_a_view_in_closed_form():
    view = seen()
    findings = [
        *camera_checks.camera_matrix("v", view, 42.0),
        *camera_checks.projection("v", view, MARKER),
        *camera_checks.sphere_surface("v", view, MARKER),
        *camera_checks.plane_surface("v", view, PLANE),
    ]
    assert problems(findings) == []


def test_checks_of_pictures_say_skip_without_them():
    view = replace(seen(), rgb=None, depth=None, segmentation=None)
    for check in (camera_checks.projection, camera_checks.sphere_surface):
        (finding,) = check("v", view, MARKER)
        assert (finding.passed, finding.found) == (True, "SKIP")
    assert next(camera_checks.plane_surface("v", view, PLANE)).found == "SKIP"


def along(view):
    _, directions = cameras.rays(K, TRANSFORM, SIZE)
    return replace(view, depth=cameras.along_ray(view.depth, directions))


def moved(view):
    return replace(view, transform=TRANSFORM + np.outer([1, 0, 0, 0], [0, 0, 0, 0.01]))


SMALL = replace(MARKER, radius=0.04)
SPOILED = {
    "another number": (camera_checks.projection, seen(), replace(MARKER, number=7)),
    "another radius": (camera_checks.sphere_surface, seen(), replace(MARKER, radius=0.11)),
    "too few pixels": (camera_checks.projection, seen(SMALL), SMALL),
    "moved pose": (camera_checks.projection, moved(seen()), MARKER),
    "depth along the ray": (camera_checks.sphere_surface, along(seen()), MARKER),
    "another height": (camera_checks.plane_surface, seen(), PLANE, 0.01),
    "another field of view": (camera_checks.camera_matrix, seen(), 43.0),
}


@pytest.mark.parametrize("how", SPOILED)
def test_a_check_fails_if_its_input_is_wrong(how):
    check, *given = SPOILED[how]
    assert problems(check("v", *given))


def test_a_camera_on_a_link_is_at_the_pose_of_the_link_times_the_offset():
    quat, offset = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]), np.eye(4)
    offset[:3, 3] = (0.1, 0, 0.05)
    expected = np.array([[0, -1, 0, 0.5], [1, 0, 0, 0.1], [0, 0, 1, 0.35], [0, 0, 0, 1]])
    view = View(K, expected, SIZE, (0.1, 20.0))
    position = np.array([0.5, 0.0, 0.3])
    assert not problems(camera_checks.mounted_camera("v", view, position, quat, offset))
    stale = camera_checks.mounted_camera("v", view, position + 0.01, quat, offset)
    assert problems(stale) == ["position_error_m"]
