"""Camera geometry against values in closed form, and the checks of views that it supports."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l05 import camera_checks, cameras
from robo_genesis.lessons.l05.camera_checks import Marker
from robo_genesis.lessons.l05.camera_exercises import TURNED
from robo_genesis.sim.camera_views import View

SIZE = (160, 120)
K = cameras.intrinsics(42.0, SIZE)
TRANSFORM = TURNED
MARKER = Marker(3, tuple((TURNED @ (0.3, 0.2, -1.2, 1.0))[:3].tolist()), 0.1)
PLANE = 1


def seen(marker=MARKER):
    """Return a view of a plane and one sphere, both in closed form."""
    start, directions = cameras.rays(K, TRANSFORM, SIZE)
    plane = cameras.plane_depth(start, directions)
    sphere = cameras.sphere_depth(start, directions, marker.centre, marker.radius)
    hit = np.isfinite(sphere) & ~(sphere > plane)
    depth = np.where(hit, sphere, np.where(plane < 20, plane, 20.0))
    numbers = np.where(hit, marker.number, np.where(depth < 20, PLANE, 0))
    return View(K, TRANSFORM, SIZE, (0.1, 20.0), np.zeros((120, 160, 3), np.uint8),
                depth.astype(np.float32), numbers.astype(np.int32))  # fmt: skip


def problems(findings):
    return [finding.label.split(".")[1] for finding in findings if not finding.passed]


def test_a_field_of_view_of_90_degrees_spans_the_rows():
    expected = [[60, 0, 80], [0, 60, 60], [0, 0, 1]]
    assert cameras.intrinsics(90.0, SIZE) == pytest.approx(np.array(expected))


def test_points_on_the_axes_of_the_camera_are_where_they_should_be():
    x, y, z = TRANSFORM[:3, :3].T
    ahead = TRANSFORM[:3, 3] - 2 * z
    found = cameras.project(np.array([ahead, ahead + 0.1 * x, ahead + 0.1 * y]), K, TRANSFORM)
    f = K[0, 0]
    assert found == pytest.approx(np.array([[80, 60], [80 + f / 20, 60], [80, 60 - f / 20]]))


def test_a_point_behind_the_camera_has_no_pixel():
    behind = TRANSFORM[:3, 3] + TRANSFORM[:3, 2]
    assert np.isnan(cameras.project(behind, K, TRANSFORM)).all()


def test_extrinsics_bring_the_position_of_the_camera_to_the_origin():
    found = cameras.extrinsics(TRANSFORM) @ TRANSFORM[:, 3]
    assert found == pytest.approx([0, 0, 0, 1])
    assert cameras.other_axes(cameras.other_axes(TRANSFORM)) == pytest.approx(TRANSFORM)


def test_projection_of_back_projected_pixels_gives_their_centres():
    points = cameras.back_project(np.full((120, 160), 1.7), K, TRANSFORM)
    pixels = cameras.project(points, K, TRANSFORM)
    assert pixels[0, 0] == pytest.approx([0.5, 0.5])
    assert pixels[119, 159] == pytest.approx([159.5, 119.5])


def test_depths_in_closed_form_lie_on_plane_and_sphere():
    start, directions = cameras.rays(K, TRANSFORM, SIZE)
    plane = start + cameras.plane_depth(start, directions, 0.2)[..., None] * directions
    assert np.nanmax(np.abs(plane[..., 2] - 0.2)) < 1e-9
    depth = cameras.sphere_depth(start, directions, MARKER.centre, MARKER.radius)
    radii = np.linalg.norm(start + depth[..., None] * directions - MARKER.centre, axis=-1)
    assert np.nanmax(np.abs(radii - MARKER.radius)) < 1e-9
    assert 1.1 < np.nanmin(depth) < 1.2


def test_nothing_behind_the_camera_has_a_depth():
    start, directions = cameras.rays(K, TRANSFORM, SIZE)
    behind = TRANSFORM[:3, 3] + TRANSFORM[:3, 2]
    assert np.isnan(cameras.sphere_depth(start, directions, behind, 0.1)).all()
    assert np.isnan(cameras.plane_depth(start, directions, 50.0)).all()


def test_the_distance_along_a_ray_is_longer_than_the_depth_except_on_the_axis():
    _, directions = cameras.rays(K, TRANSFORM, SIZE, shift=np.array([0.5, 0.5]))
    found = cameras.along_ray(np.ones((120, 160)), directions)
    assert found[59, 79] == pytest.approx(1.0)
    assert found.max() == found[119, 159] == pytest.approx(np.hypot(1, np.hypot(80, 60) / K[0, 0]))


def test_the_centre_of_a_silhouette_is_farther_out_than_the_picture_of_the_centre():
    large, size = cameras.intrinsics(60.0, (640, 480)), (640, 480)
    centre, radius = (TRANSFORM @ (0.5, 0.3, -1.2, 1.0))[:3], 0.2
    hit = np.isfinite(cameras.sphere_depth(*cameras.rays(large, TRANSFORM, size), centre, radius))
    found = cameras.silhouette_centre(centre, radius, large, TRANSFORM)
    assert found == pytest.approx(cameras.centroid(hit), abs=0.05)
    picture = cameras.project(centre, large, TRANSFORM)
    assert found - large[:2, 2] == pytest.approx((picture - large[:2, 2]) / (1 - 0.2**2 / 1.2**2))
    assert np.isnan(cameras.silhouette_centre(centre, 1.2, large, TRANSFORM)).all()


def test_the_centroid_of_a_mask_is_that_of_the_centres_of_its_pixels():
    mask = np.zeros((6, 8), bool)
    mask[1:4, 2:7] = True
    assert cameras.centroid(mask).tolist() == [4.5, 2.5]
    assert np.isnan(cameras.centroid(~mask & mask)).all()


def test_residuals_leave_out_what_was_not_computed():
    computed = np.array([[1.0, np.nan, 2.0, 0.0]])
    found = cameras.residuals(np.array([[1.5, 9, 1.0, 7]]), computed, np.array([[1, 1, 1, 0]]) > 0)
    assert (found.count, found.mean, found.largest) == (2, -0.25, 1.0)
    assert np.isnan(cameras.residuals(computed, computed, np.zeros((1, 4), bool)).rms)


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
