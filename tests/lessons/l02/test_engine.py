"""The dropped box in the real engine."""

import numpy as np
import pytest

from robo_genesis.lessons.l02 import spec
from robo_genesis.sim.bodies.rigid_bodies import run_drop


@pytest.mark.engine
def test_a_second_drop_is_the_same_to_the_last_bit(real_engine):
    gs, case = real_engine.gs, spec.BASELINE
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=case.dt, substeps=case.substeps), show_viewer=False
    )
    scene.add_entity(gs.morphs.Plane())
    box = scene.add_entity(
        morph=gs.morphs.Box(size=(case.size,) * 3, pos=(0.0, 0.0, case.height)),
        material=gs.materials.Rigid(rho=case.density),
    )
    scene.build()
    first, second = (run_drop(scene, box, case) for _ in range(2))
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        assert np.array_equal(getattr(first, name), getattr(second, name)), name
