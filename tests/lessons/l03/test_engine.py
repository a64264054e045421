"""Landing, sliding and bouncing in the real engine."""

import numpy as np
import pytest
from lessons.engine_scenes import arrays

from robo_genesis.lessons.l03 import spec
from robo_genesis.sim import visual_shape
from robo_genesis.sim.bodies import contacts

pytestmark = pytest.mark.engine


@pytest.fixture(scope="module")
def world(real_engine):
    return contacts.build_world(real_engine.gs, {"baseline": spec.BASELINE})


def test_a_second_run_of_one_scene_is_the_same_to_the_last_bit(world):
    first, again = (contacts.run_world(world)["baseline"] for _ in range(2))
    assert arrays(first) == arrays(again)


def test_the_drawn_table_is_the_engine_s(world):
    (part,) = visual_shape.read_shape(world.surface)
    drawn = visual_shape.slab(contacts.SURFACE_SIZE, contacts.TOP)
    centre = world.surface.get_pos().cpu().numpy()
    for end in (np.min, np.max):
        expected = end(part.vertices, axis=0) + centre
        assert end(drawn.vertices, axis=0) == pytest.approx(expected, abs=1e-6)
    a, b, c = (drawn.vertices[drawn.faces[:, k]] for k in range(3))
    outward = (np.cross(b - a, c - a) * ((a + b + c) / 3 - centre)).sum(axis=1)
    assert (outward > 0).all()  # every face looks away from the middle
