"""The falls of L01 and L02 in the real engine."""

import pytest

from robo_genesis.core.comparison import same_arrays
from robo_genesis.lessons import l01, l02
from robo_genesis.sim.bodies.rigid_bodies import run_drop


@pytest.mark.engine
@pytest.mark.parametrize("lesson", [l01, l02], ids=["sphere", "box"])
def test_a_second_fall_is_the_same_to_the_last_bit(real_engine, lesson):
    gs, case = real_engine.gs, lesson.spec.BASELINE
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=case.dt, substeps=case.substeps), show_viewer=False
    )
    scene.add_entity(gs.morphs.Plane())
    at = (0.0, 0.0, case.height)
    shapes = {
        l01: gs.morphs.Sphere(radius=case.size / 2, pos=at),
        l02: gs.morphs.Box(size=(case.size,) * 3, pos=at),
    }
    body = scene.add_entity(shapes[lesson], material=gs.materials.Rigid(rho=case.density))
    scene.build()
    first, second = (run_drop(scene, body, case) for _ in range(2))
    assert same_arrays(first, second)
