"""Camera geometry against values in closed form."""

import numpy as np
import pytest

from robo_genesis.sim import camera_geometry as cameras

SIZE = (160, 120)
K = cameras.intrinsics(42.0, SIZE)
TRANSFORM = np.array([
    [0.6, -0.48, 0.64, 1.1],
    [0.8, 0.36, -0.48, -0.7],
    [0.0, 0.8, 0.6, 0.9],
    [0.0, 0.0, 0.0, 1.0],
])  # fmt: skip
"""A camera that looks down, z backwards [m]."""

CENTRE, RADIUS = (TRANSFORM @ (0.3, 0.2, -1.2, 1.0))[:3], 0.1
"""A sphere in its view [m]."""


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
    depth = cameras.sphere_depth(start, directions, CENTRE, RADIUS)
    radii = np.linalg.norm(start + depth[..., None] * directions - CENTRE, axis=-1)
    assert np.nanmax(np.abs(radii - RADIUS)) < 1e-9
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
