"""A view is read freshly, and refused if its arrays do not fit the camera."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.camera import views as camera_views

WIDTH, HEIGHT = 8, 5
SCENE = SimpleNamespace(segmentation_idx_dict={0: -1, 1: (0, 0), 2: (3, 14)})


class Camera:
    """A camera with the readings of the engine, which counts its renders."""

    res, near, far = (WIDTH, HEIGHT), 0.1, 20.0
    intrinsics = np.array([[6.0, 0, 4], [0, 6, 2.5], [0, 0, 1]])

    def __init__(self):
        self.transform, self.rendered = np.eye(4, dtype=np.float32), []
        self.extrinsics = np.linalg.inv(self.transform)  # not computed again
        self.rgb = np.zeros((HEIGHT, WIDTH, 3), np.uint8)

    def render(self, rgb=True, depth=False, segmentation=False, force_render=False):
        self.rendered.append((rgb, depth, segmentation, force_render))
        return (
            self.rgb if rgb else None,
            np.ones((HEIGHT, WIDTH), np.float32) if depth else None,
            np.full((HEIGHT, WIDTH), 2, np.int64) if segmentation else None,
            None,
        )


@pytest.fixture
def camera():
    return Camera()


def test_a_view_has_pictures_and_pose(camera):
    view = camera_views.look(camera)
    assert (view.rgb.shape, view.depth.shape) == ((HEIGHT, WIDTH, 3), (HEIGHT, WIDTH))
    assert (view.segmentation.dtype, view.segmentation.max()) == (np.int32, 2)
    assert (view.size, view.limits) == ((WIDTH, HEIGHT), (0.1, 20.0))
    # depth without colours, and all pictures new
    assert camera.rendered == [(False, True, True, True), (True, False, False, True)]


def test_without_rendering_there_are_matrix_and_present_pose_but_no_pictures(camera):
    camera.transform[0, 3] = 2.0  # `extrinsics` stays that of the first reading
    view = camera_views.look(camera, render=False)
    assert camera.rendered == []
    assert (view.rgb, view.depth, view.segmentation) == (None, None, None)
    assert (view.intrinsics == Camera.intrinsics).all()
    assert view.transform[:3, 3].tolist() == [2.0, 0.0, 0.0]


def test_a_link_has_one_number_in_the_segmentation():
    link = SimpleNamespace(entity=SimpleNamespace(idx=3), idx=14)
    assert camera_views.segment_number(SCENE, link) == 2
