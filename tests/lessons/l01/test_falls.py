"""L01's sphere: metrics with known answers, checks that fail alone, bundles that are refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from bundles import written
from lessons.body_runs import body_run, make_drop
from lessons.changed_runs import failed as fails
from lessons.lesson_bundles import in_archive, metric, refused
from spoilers import seal

from robo_genesis.core.experiment import Experiment
from robo_genesis.evidence.compare import compare
from robo_genesis.lessons.l01 import LECTURE, machine, spec, text
from robo_genesis.lessons.l01.metrics import fall_metrics
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.sim.bodies.rigid_bodies import run_drop

CASE = spec.BASELINE
TIMES = {f"{start}_{part}": 0.5 for start in machine.STARTS for part in machine.PARTS}
READINGS = {
    "model": spec.EXPECTED_MODEL,
    machine.DOCTOR: dict.fromkeys(machine.STEPS, 1),
    machine.TIMES: TIMES,
}


def test_a_stepped_fall_has_no_error_and_a_continuous_one_is_behind():
    found = fall_metrics(make_drop(CASE), CASE)
    assert found.final_height == pytest.approx(0.298895, abs=1e-6)
    assert found.asked_height == pytest.approx(0.5 - 9.81 * CASE.h**2 * 30 * 31 / 2, abs=1e-6)
    assert found.formula_error < spec.FORMULA_TOLERANCE
    assert found.school_gap == pytest.approx(9.81 * CASE.h * 0.2 / 2, abs=1e-6)
    t = np.arange(CASE.steps + 1) * CASE.dt
    continuous = body_run(t, z=CASE.height - 9.81 * t**2 / 2, vz=-9.81 * t)
    found = fall_metrics(continuous, CASE)
    assert found.formula_error == pytest.approx(9.81 * CASE.h * 0.2 / 2, abs=1e-6)
    assert found.school_gap == pytest.approx(0, abs=1e-6)


def experiment(frames, page=LECTURE, case=CASE, **changed) -> Experiment:
    readings = {name: READINGS[name] for name in page.readings(True)} | changed
    return Experiment(page, {"baseline": make_drop(case)}, [spec.LINK], readings, frames, True)


@pytest.mark.parametrize(
    ("case", "changed", "failed"),
    [
        (CASE, {}, set()),
        (CASE, {"model": spec.EXPECTED_MODEL | {"geoms": 2}}, {"structure"}),
        (type(CASE)(0.16, 500.0, 0.6, 20), {}, {"start"}),
        (type(CASE)(0.16, 500.0, 0.5, 19), {}, {"stamps"}),
        (type(CASE)(0.16, 500.0, 0.5, 20, gravity=9.82), {}, {"computed_height"}),
        (CASE, {machine.DOCTOR: READINGS[machine.DOCTOR] | {"render": 0}}, {"doctor"}),
        (CASE, {machine.TIMES: dict.fromkeys(TIMES, 900.0)}, set()),
    ],
)
def test_each_check_fails_on_its_own_fault_and_none_judges_a_time(frames, case, changed, failed):
    assert fails(experiment(frames, case=case, **changed)) == failed


@pytest.fixture(scope="module")
def sound(tmp_path_factory, engine, frames) -> Path:
    """The lecture's bundle."""
    return written(engine, tmp_path_factory.mktemp("fell"), "l01", "lecture", experiment(frames))


def test_the_text_says_what_was_measured(frames):
    run = experiment(frames)
    assert "| first divided by second | 1.0 |" in text.start_table(run)
    other = experiment(frames, case=type(CASE)(0.16, 500.0, 0.5, 20, gravity=9.82))
    assert ["more than rounding" in text.conclusion(of) for of in (run, other)] == [False, True]


def test_a_slower_machine_agrees(sound, tmp_path):
    slower = Path(shutil.copytree(sound, tmp_path / "l01" / "lecture" / "cpu"))
    metric(machine.TIMES, "first_build", 60.0)(slower)
    seal(slower)
    verify_bundle(slower)
    assert compare(sound, slower).state == "equal"


def moved(by):
    return in_archive("baseline", lambda a: a["link_pos_m"][5:, 0, 2].__iadd__(by))


@pytest.mark.parametrize(
    ("code", "spoil"),
    [
        ("motion", moved(1e-4)),
        ("metrics", metric("baseline", "final_height", 0.3038)),
        ("metrics", metric(machine.DOCTOR, "render", 0.5)),
        ("checks", metric(machine.DOCTOR, "render", 0)),
    ],
)
def test_a_spoiled_bundle_is_refused(sound, tmp_path, code, spoil):
    folder = Path(shutil.copytree(sound, tmp_path / "l01" / "lecture" / "cpu"))
    spoil(folder)
    assert refused(folder).startswith(f"{code}: ")


@pytest.mark.engine
def test_a_second_fall_is_the_same_to_the_last_bit(real_engine):
    gs = real_engine.gs
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=CASE.dt, substeps=CASE.substeps), show_viewer=False
    )
    scene.add_entity(gs.morphs.Plane())
    sphere = scene.add_entity(gs.morphs.Sphere(radius=spec.RADIUS, pos=(0, 0, CASE.height)))
    scene.build()
    first, second = (run_drop(scene, sphere, CASE) for _ in range(2))
    assert np.array_equal(first.link_pos, second.link_pos)
