"""Each view is a new picture. Pages compare views with the geometry of the scene."""

from unittest.mock import Mock, call

import numpy as np
import pytest

from robo_genesis.sim.camera.views import look

WIDTH, HEIGHT = 8, 5


@pytest.fixture
def camera():
    """A camera that keeps its first pose as `extrinsics`, as the engine's does."""
    camera = Mock(res=(WIDTH, HEIGHT), near=0.1, far=20.0, intrinsics=np.eye(3))
    camera.transform, camera.extrinsics = np.eye(4), np.eye(4)
    picture = np.zeros((HEIGHT, WIDTH), np.int64)
    camera.render.return_value = picture, picture, picture, None
    return camera


def test_depth_is_rendered_without_colours_and_each_picture_is_new(camera):
    look(camera)
    depth = call(rgb=False, depth=True, segmentation=True, force_render=True)
    assert camera.render.mock_calls == [depth, call(force_render=True)]


def test_without_rendering_there_are_matrix_and_present_pose_but_no_pictures(camera):
    camera.transform[0, 3] = 2.0
    view = look(camera, render=False)
    camera.render.assert_not_called()
    assert (view.rgb, view.depth, view.segmentation) == (None, None, None)
    assert (view.intrinsics == camera.intrinsics).all()
    assert view.transform[:3, 3].tolist() == [2.0, 0.0, 0.0]
