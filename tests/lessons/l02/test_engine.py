"""The dropped box and the two sides of build, in the real engine."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.core import checks
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l02 import LAB, life_cycle, spec
from robo_genesis.sim.bodies import rigid_bodies
from robo_genesis.sim.camera.frames import capture

pytestmark = pytest.mark.engine


@pytest.fixture(scope="module")
def dropped(real_engine):
    gs = real_engine.gs
    case = spec.BASELINE
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(
            dt=case.dt, substeps=case.substeps, gravity=(0.0, 0.0, -case.gravity)
        ),
        show_viewer=False,
    )
    scene.add_entity(gs.morphs.Plane())
    box = scene.add_entity(
        morph=gs.morphs.Box(size=(case.size,) * 3, pos=(0.0, 0.0, case.height)),
        material=gs.materials.Rigid(rho=case.density),
    )
    camera = scene.add_camera(**spec.VIEW)
    scene.build()
    frames = {"initial": capture(camera)}
    traces = {"baseline": rigid_bodies.run_drop(scene, box, case)}
    frames["final"] = capture(camera)
    return SimpleNamespace(gs=gs, scene=scene, box=box, traces=traces, frames=frames)


def test_the_lab_passes_its_checks(dropped):
    model = rigid_bodies.read_model(dropped.scene, dropped.box)
    readings = {"model": model, "body": {"mass": float(dropped.box.get_mass())}}
    run = Experiment(LAB, dropped.traces, [spec.LINK], readings, dropped.frames, rendered=True)
    assert checks.require("l02", run.outcomes()) == "L02 CHECK: PASSED"


def test_a_second_drop_is_the_same_to_the_last_bit(dropped):
    again = rigid_bodies.run_drop(dropped.scene, dropped.box, spec.BASELINE)
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        assert np.array_equal(getattr(again, name), getattr(dropped.traces["baseline"], name)), name


def test_a_box_that_was_pushed_is_refused_as_a_start(dropped, monkeypatch):
    monkeypatch.setattr(dropped.scene, "reset", lambda: None)
    dropped.scene.step()
    with pytest.raises(rigid_bodies.DropError, match=r"asks for 0\.5 m, at rest"):
        rigid_bodies.run_drop(dropped.scene, dropped.box, spec.BASELINE)


def test_each_call_belongs_to_one_side_of_build(dropped):
    gs = dropped.gs
    scene = gs.Scene(show_viewer=False)
    box = scene.add_entity(gs.morphs.Box(size=(0.1,) * 3, pos=(0.0, 0.0, 0.5)))
    camera = scene.add_camera(GUI=False)
    late = gs.morphs.Sphere(radius=0.05, pos=(0.8, 0.0, 0.5))
    attempts = life_cycle.try_both_sides(scene, box, camera, late)
    assert life_cycle.counts(attempts) == life_cycle.expected(rendered=True)
