"""Frames of a run are taken at the samples that were asked for, and of nothing else."""

import io
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from robo_genesis.core.scene import FRAME_SHAPE
from robo_genesis.sim import film, session


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
    return film.Filmed(scene, scene, (0, 2, 3))


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
    with pytest.raises(session.FrameError):
        film.Filmed(scene, blind, (0,)).step()


def test_a_strip_names_the_times_in_their_order_and_is_light(frames):
    figure = Figure(figsize=(7, 3))
    axes = figure.subplots(1, 2)
    film.strip(axes, {20: frames["final"], 0: frames["initial"]}, dt=0.01)
    assert [ax.get_title() for ax in axes] == ["t = 0.00 s", "t = 0.20 s"]
    with Image.open(io.BytesIO(film.jpeg(figure))) as picture:
        assert picture.format == "JPEG"
        assert picture.size == (630, 270)
