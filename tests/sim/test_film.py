"""Frames of a run are taken at the samples that were asked for, and of nothing else."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.core.scene import FRAME_SHAPE
from robo_genesis.sim.camera import FrameError
from robo_genesis.sim.film import FilmedScene


class Scene:
    """Counts its steps; its camera shows the count."""

    dt = 0.25

    def __init__(self):
        self.steps = 0

    def step(self):
        self.steps += 1

    def render(self):
        picture = np.full(FRAME_SHAPE, self.steps, np.uint8)
        picture[0] = 255
        return (picture,)


@pytest.fixture
def filmed():
    scene = Scene()
    return FilmedScene(scene, scene, (0, 2, 3))


def test_frames_show_the_states_that_were_asked_for(filmed):
    for _ in range(4):
        filmed.step()
    assert {k: int(frame[1, 0, 0]) for k, frame in filmed.frames.items()} == {0: 0, 2: 2, 3: 3}


def test_all_else_is_the_scene_s_own(filmed):
    filmed.step()
    assert (filmed.dt, filmed.steps) == (0.25, 1)
    with pytest.raises(AttributeError, match="has no attribute 'reset'"):
        filmed.reset()


def test_a_frame_that_shows_nothing_is_refused():
    scene = Scene()
    blind = SimpleNamespace(render=lambda: (np.zeros(FRAME_SHAPE, np.uint8),))
    with pytest.raises(FrameError):
        FilmedScene(scene, blind, (0,)).step()
