"""A view survives the way through frames and readings of a bundle."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.core.scene import CAMERA_RES, FRAME_SHAPE
from robo_genesis.evidence.reader import read_frames, write_frame
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera import record as view_record
from robo_genesis.sim.camera.views import View

K = cameras.intrinsics(42.0, CAMERA_RES)


@pytest.fixture
def view():
    rng = np.random.default_rng(0)
    depth = rng.uniform(0.1, 20.0, FRAME_SHAPE[:2]).astype(np.float32)
    rgb = rng.integers(0, 256, FRAME_SHAPE, np.uint8)
    numbers = rng.integers(0, 17, FRAME_SHAPE[:2], np.int32)
    return View(
        K, np.diag([1.0, -1, -1, 1]), CAMERA_RES, (0.1, 20.0), rgb, depth, numbers
    )


def recorded(view, rendered=True):
    frames = view_record.frames("world", view)
    readings = {"view_world": view_record.numbers(view)}
    return SimpleNamespace(frames=frames, readings=readings, rendered=rendered)


def test_a_recorded_view_differs_in_the_rounding_of_its_depth_alone(tmp_path, view):
    run = recorded(view)
    assert tuple(run.frames) == view_record.frame_names("world")
    (tmp_path / "frames").mkdir()
    for name, frame in run.frames.items():
        write_frame(tmp_path / "frames" / f"{name}.png", frame)
    run.frames = read_frames(tmp_path, run.frames)
    found = view_record.view_of(run, "world")
    for name in ("intrinsics", "transform", "rgb", "segmentation"):
        assert (getattr(found, name) == getattr(view, name)).all()
    assert (found.size, found.limits) == (view.size, view.limits)
    assert np.abs(found.depth - view.depth).max() <= view_record.DEPTH_UNIT
