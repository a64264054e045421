"""Camera geometry against values in closed form."""

import numpy as np
import pytest
from closed_views import SIZE, TRANSFORM, K, sphere_depth

from robo_genesis.sim.camera import geometry as cameras


def test_a_field_of_view_of_90_degrees_spans_the_rows():
    expected = [[60, 0, 80], [0, 60, 60], [0, 0, 1]]
    assert cameras.intrinsics(90.0, SIZE) == pytest.approx(np.array(expected))


def test_points_on_the_axes_of_the_camera_are_where_they_should_be():
    x, y, z = TRANSFORM[:3, :3].T
    ahead = TRANSFORM[:3, 3] - 2 * z
    found = cameras.project(
        np.array([ahead, ahead + 0.1 * x, ahead + 0.1 * y]), K, TRANSFORM
    )
    f = K[0, 0]
    assert found == pytest.approx(
        np.array([[80, 60], [80 + f / 20, 60], [80, 60 - f / 20]])
    )


def test_a_point_behind_the_camera_has_no_pixel():
    behind = TRANSFORM[:3, 3] + TRANSFORM[:3, 2]
    assert np.isnan(cameras.project(behind, K, TRANSFORM)).all()


def test_projection_of_back_projected_pixels_gives_their_centres():
    points = cameras.back_project(np.full((120, 160), 1.7), K, TRANSFORM)
    pixels = cameras.project(points, K, TRANSFORM)
    assert pixels[0, 0] == pytest.approx([0.5, 0.5])
    assert pixels[119, 159] == pytest.approx([159.5, 119.5])


def test_the_centre_of_a_silhouette_is_farther_out_than_the_picture_of_the_centre():
    large, size = cameras.intrinsics(60.0, (640, 480)), (640, 480)
    centre, radius = (TRANSFORM @ (0.5, 0.3, -1.2, 1.0))[:3], 0.2
    hit = np.isfinite(
        sphere_depth(*cameras.rays(large, TRANSFORM, size), centre, radius)
    )
    found = cameras.silhouette_centre(centre, radius, large, TRANSFORM)
    assert found == pytest.approx(cameras.centroid(hit), abs=0.05)
    picture = cameras.project(centre, large, TRANSFORM)
    assert found - large[:2, 2] == pytest.approx(
        (picture - large[:2, 2]) / (1 - 0.2**2 / 1.2**2)
    )
    assert np.isnan(cameras.silhouette_centre(centre, 1.21, large, TRANSFORM)).all()


def test_the_centroid_of_a_mask_is_that_of_the_centres_of_its_pixels():
    mask = np.zeros((6, 8), bool)
    mask[1:4, 2:7] = True
    assert cameras.centroid(mask).tolist() == [4.5, 2.5]
    assert np.isnan(cameras.centroid(~mask & mask)).all()


def test_residuals_keep_the_sign_of_their_mean():
    found = cameras.residuals(np.array([0.5, -1.0]))
    assert (found.count, found.mean, found.largest) == (2, -0.25, 1.0)
    assert np.isnan(cameras.residuals(np.empty(0)).largest)
    assert np.isnan(cameras.residuals(np.array([0.5, np.nan])).largest)
