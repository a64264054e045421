"""A view is read freshly, and refused if its arrays do not fit the camera."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim import camera_views
from robo_genesis.sim.camera_views import View, ViewError

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

    def attach(self, link, offset):
        self.link, self.offset = link, offset

    def move_to_attach(self):
        self.transform = (self.link @ self.offset).astype(np.float32)


@pytest.fixture
def camera():
    return Camera()


def test_a_view_has_pictures_pose_and_meaning_of_the_numbers(camera):
    view = camera_views.look(camera, SCENE)
    assert (view.rgb.shape, view.depth.shape) == ((HEIGHT, WIDTH, 3), (HEIGHT, WIDTH))
    assert (view.segmentation.dtype, view.segmentation.max()) == (np.int32, 2)
    assert view.shown == {1: (0, 0), 2: (3, 14)}
    assert (view.size, view.limits) == ((WIDTH, HEIGHT), (0.1, 20.0))
    assert not view.depth.flags.writeable


def test_depth_is_rendered_without_colours_and_all_pictures_are_new(camera):
    camera_views.look(camera, SCENE)
    assert camera.rendered == [(False, True, True, True), (True, False, False, True)]


def test_without_rendering_there_are_matrix_and_pose_but_no_pictures(camera):
    view = camera_views.look(camera, SCENE, render=False)
    assert camera.rendered == []
    assert (view.rgb, view.depth, view.segmentation) == (None, None, None)
    assert (view.intrinsics == Camera.intrinsics).all()
    assert (view.transform == np.eye(4)).all()


def test_a_moved_camera_has_its_new_pose(camera):
    link, offset = np.eye(4), np.eye(4)
    link[0, 3], offset[2, 3] = 2.0, 0.5
    camera_views.place_on_link(camera, link, offset)
    found = camera_views.look(camera, SCENE, render=False).transform
    assert found[:3, 3].tolist() == [2.0, 0.0, 0.5]


@pytest.mark.parametrize(
    ("keys", "expected"),
    [({0: -1, 1: 0, 2: 4}, {1: (0,), 2: (4,)}), ({0: -1, 1: (0, 0, 2)}, {1: (0, 0, 2)})],
    ids=["entity", "geom"],
)
def test_each_level_of_segmentation_gives_indices(keys, expected):
    assert camera_views.read_segments(SimpleNamespace(segmentation_idx_dict=keys)) == expected


def test_pictures_with_rows_and_columns_swapped_are_refused(camera):
    camera.rgb = np.zeros((WIDTH, HEIGHT, 3), np.uint8)
    with pytest.raises(ViewError, match=r"rgb has shape \(8, 5, 3\), expected \(5, 8, 3\)"):
        camera_views.look(camera, SCENE)


@pytest.mark.parametrize("axes", [2 * np.eye(3), np.diag([1.0, 1.0, -1.0])])
def test_axes_of_no_rigid_body_are_refused(axes):
    transform = np.eye(4)
    transform[:3, :3] = axes
    with pytest.raises(ViewError, match="expected three orthogonal unit vectors"):
        View(np.eye(3), transform, (WIDTH, HEIGHT), (0.1, 20.0))
