"""Frames are accepted only if they show something, and software renderers are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.core.scene import FRAME_SHAPE
from robo_genesis.sim.camera.frames import FrameError, Renderer, capture


@pytest.mark.parametrize(
    ("name", "software"), [("llvmpipe (LLVM)", True), ("AMD Instinct", False)]
)
def test_software_renderers_are_known_by_name(name, software):
    assert Renderer("vendor", name).software is software


@pytest.fixture
def picture(frames):
    return frames["initial"]


SKY = np.broadcast_to(np.array([10, 20, 31], np.uint8), FRAME_SHAPE)


@pytest.mark.parametrize(
    ("frame", "message"),
    [
        (np.zeros((720, 540, 3), np.uint8), r"expected \(540, 720, 3\)"),
        (None, r"shape \(\), expected"),
        (SKY, r"every pixel is \[10, 20, 31\]"),
    ],
)
def test_a_frame_that_is_not_usable_is_refused(frame, message):
    with pytest.raises(FrameError, match=message):
        capture(SimpleNamespace(render=lambda **_: (frame, None, None, None)))


def test_capture_returns_its_own_copy_of_the_colours(picture):
    buffer = picture.copy()
    frame = capture(SimpleNamespace(render=lambda **_: (buffer, None, None, None)))
    buffer[:] = 0
    assert (frame == picture).all()
