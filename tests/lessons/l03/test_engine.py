"""Landing, sliding and bouncing in the real engine."""

import numpy as np
import pytest

from robo_genesis.core import checks
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import LAB, LECTURE, spec, study
from robo_genesis.sim import contacts, mujoco_contacts, rigid_bodies, visual_shape
from robo_genesis.sim.camera import capture

pytestmark = pytest.mark.engine
FIELDS = ("link_pos", "link_quat", "link_vel", "link_ang", "contacts", "penetration")


@pytest.fixture(scope="module")
def ran(real_engine):
    """All runs of the lab, with the baseline's world and camera frames."""
    gs, traces, settings, masses = real_engine.gs, {}, {}, {}
    baseline = contacts.build_world(gs, {"baseline": spec.BASELINE}, spec.VIEW)
    frames = {"initial": capture(baseline.camera)}
    contacts.record_world(baseline, traces, settings)
    frames["final"] = capture(baseline.camera)
    for name, case in (spec.LANDINGS | spec.BOUNCES).items():
        world = contacts.build_world(gs, {name: case})
        contacts.record_world(world, traces, settings)
        masses[case.shape] = float(world.bodies[name].get_mass())
    for surface in ("050", "030"):
        pair = {name: case for name, case in spec.SLIDES.items() if name.endswith(surface)}
        contacts.record_world(contacts.build_world(gs, pair), traces, settings)
    model = rigid_bodies.read_model(baseline.scene, baseline.bodies["baseline"])
    readings = {"model": model, "mass": masses} | settings
    return Experiment(LAB, traces, [spec.LINK], readings, frames, True), baseline


def test_the_lab_passes_its_checks(ran):
    experiment, _ = ran
    assert checks.require("l03", experiment.outcomes()) == "L03 CHECK: PASSED"


def test_a_second_run_of_one_scene_is_the_same_to_the_last_bit(ran):
    experiment, world = ran
    again = contacts.run_world(world)["baseline"]
    for name in FIELDS:
        first = getattr(experiment.traces["baseline"], name)
        assert np.array_equal(getattr(again, name), first), name


def test_the_ball_bounces_alike_in_mujoco(ran):
    experiment, _ = ran
    other = mujoco_contacts.run_case(spec.BOUNCES["bounce_sub20"])
    difference = np.abs(experiment.traces["bounce_sub20"].link_pos - other.link_pos)
    assert difference[:40].max() < 1e-4  # drop, first bounce and half of the second flight


def test_the_drawn_table_is_the_engine_s(ran):
    _, world = ran
    (part,) = visual_shape.read_shape(world.surface)
    drawn = visual_shape.slab(contacts.SURFACE_SIZE, contacts.TOP)
    centre = world.surface.get_pos().cpu().numpy()
    for end in (np.min, np.max):
        assert end(drawn.vertices, axis=0) == pytest.approx(
            end(part.vertices, axis=0) + centre, abs=1e-6
        )
    a, b, c = (drawn.vertices[drawn.faces[:, k]] for k in range(3))
    outward = (np.cross(b - a, c - a) * ((a + b + c) / 3 - centre)).sum(axis=1)
    assert (outward > 0).all()  # every face looks away from the middle


def test_the_studies_hold(real_engine, ran):
    gs, traces, seconds = real_engine.gs, {}, {}
    for name, group in spec.STEP_CASES.items():
        world = contacts.build_world(gs, group)
        traces |= contacts.run_world(world)
        seconds[name] = contacts.time_constant(world)
    for end in ("050_elliptic", "030_elliptic", "sub10", "convex"):
        pair = {name: case for name, case in spec.CONE_CASES.items() if name.endswith(end)}
        traces |= contacts.run_world(contacts.build_world(gs, pair))
    traces |= {name: mujoco_contacts.run_case(case) for name, case in spec.OTHER_ENGINE.items()}
    traces[spec.OWN_DEFAULTS] = mujoco_contacts.run_case(spec.BASELINE, own_defaults=True)
    traces |= {name: ran[0].traces[name] for name in spec.REPEATED}
    run = Experiment(LECTURE, traces, [spec.LINK], {study.GROUP: seconds}, {}, False)
    outcomes = checks.evaluate(study.CHECKS, run, LECTURE.claims)
    assert checks.require("l03", outcomes) == "L03 CHECK: PASSED"
