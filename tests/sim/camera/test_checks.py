"""The checks of camera views: they pass in closed form, and each fails for its own fault."""

from dataclasses import replace

import numpy as np
import pytest
from closed_views import FAR, FOV, MARKER, PLANE, SIZE, TRANSFORM, K, closed_view

from robo_genesis.sim.camera import checks
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.views import View


def problems(findings):
    return [finding.label.split(".")[1] for finding in findings if not finding.passed]


def along(view):
    _, directions = cameras.rays(K, TRANSFORM, SIZE)
    return replace(view, depth=view.depth * np.linalg.norm(directions, axis=-1))


def moved(view, axis=0):
    return replace(
        view, transform=TRANSFORM + 0.01 * np.outer(np.eye(4)[axis], np.eye(4)[3])
    )


GIVEN = {
    "fov": FOV,
    "near": 0.1,
    "far": FAR,
    "pos": TRANSFORM[:3, 3],
    "lookat": (TRANSFORM @ (0, 0, -1, 1))[:3],
}
SMALL = replace(MARKER, radius=0.04)
SPOILED = {
    "another number": (checks.projection, closed_view(), replace(MARKER, number=7)),
    "another radius": (
        checks.sphere_surface,
        closed_view(),
        replace(MARKER, radius=0.11),
    ),
    "too few pixels": (checks.projection, closed_view(SMALL), SMALL),
    "moved pose": (checks.projection, moved(closed_view()), MARKER),
    "depth along the ray": (checks.sphere_surface, along(closed_view()), MARKER),
    "another height": (checks.plane_surface, moved(closed_view(), 2), PLANE),
}
OTHER = {"fov": 43.0, "near": 0.2, "far": 21.0, "lookat": (0, 0, 0)}
SPOILED |= {
    n: (checks.camera_matrix, closed_view(), GIVEN | {n: of}) for n, of in OTHER.items()
}


@pytest.mark.parametrize("how", SPOILED)
def test_a_check_fails_if_its_input_is_wrong(how):
    check, *given = SPOILED[how]
    assert problems(check("v", *given))
    assert not problems(checks.camera_matrix("v", closed_view(), GIVEN))


def test_a_camera_on_a_link_is_at_the_pose_of_the_link_times_the_offset():
    quat, offset = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)]), np.eye(4)
    offset[:3, 3] = (0.1, 0, 0.05)
    expected = np.array(
        [[0, -1, 0, 0.5], [1, 0, 0, 0.1], [0, 0, 1, 0.35], [0, 0, 0, 1]]
    )
    view = View(K, expected, SIZE, (0.1, 20.0))
    position = np.array([0.5, 0.0, 0.3])
    assert not problems(checks.mounted_camera("v", view, position, quat, offset))
    stale = checks.mounted_camera("v", view, position + 0.01, quat, offset)
    assert problems(stale) == ["position_error_m"]
