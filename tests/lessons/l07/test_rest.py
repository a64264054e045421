"""The formulas, the criterion of rest and the checks of the page on rest, without Genesis."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import body_at
from lessons.changed_runs import case, copied, metric, reading
from lessons.experiments import require_spoilers

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l07 import rest
from robo_genesis.lessons.l07.rest_checks import REST
from robo_genesis.sim.bodies.contacts import SETTINGS
from robo_genesis.sim.bodies.soft_contact import depth_and_creep
from robo_genesis.sim.mujoco import contacts as mujoco_contacts


@pytest.fixture(scope="module")
def run():
    cases = REST.cases
    traces = {name: mujoco_contacts.run_case(of) for name, of in cases.items()}
    for name in rest.TWINS:  # two engines never agree to the last bit
        traces[name] = replace(
            traces[name], link_pos=traces[name].link_pos + np.float32(1e-7)
        )
    readings = {
        s: {name: getattr(cases[name], s) for name in rest.CASES} for s in SETTINGS
    }
    return Experiment(REST, traces, ("body",), readings, {}, False)


@pytest.mark.parametrize(
    ("changes", "depth", "creep"),
    [
        ({}, 4.27e-6, 0.0),
        ({"tilt": np.radians(10)}, 4.2e-6, 2.81e-4),
        (
            {"tilt": np.radians(10), "cone": "elliptic", "impratio": 100.0},
            26.9e-6,
            2.25e-6,
        ),
        ({"friction": 1.0, "time_constant": 0.02}, 107.8e-6, 0.0),
        (
            {"friction": 2.0},
            252.3e-6,
            0.0,
        ),  # deeper than half of the width of the impedance
    ],
)
def test_the_formulas_give_known_values(changes, depth, creep):
    found = depth_and_creep(replace(rest.BOX, **changes))
    assert found == pytest.approx((depth, creep), rel=5e-3)


def test_the_scope_ends_where_an_uphill_edge_is_free():
    for degrees, pressing in ((11.0, True), (11.5, False)):
        assert rest.in_scope(replace(rest.BOX, tilt=np.radians(degrees))) is pressing


@pytest.mark.parametrize(
    ("heights", "moved"),
    [
        (np.zeros(31), 0.0),
        (np.linspace(0, 3e-4, 31), 2e-4),  # creeps at 1 mm/s
        (
            5e-3 * np.sin(np.pi * np.arange(31) / 10),
            1e-2,
        ),  # both ends of each window are equal
    ],
)
def test_the_window_compares_all_its_samples(heights, moved):
    assert rest.moved(body_at(heights)) == pytest.approx(moved, rel=1e-3)


SPOILERS = [
    ("settings", reading("friction", "tilt_10_box", 0.4)),
    ("stamps", case("tilt_10_box", duration=0.6)),
    ("creeps_as_computed", metric("tilt_5_firm", creep=2.4e-4)),
    (
        "creeps_as_computed",
        metric("tilt_15_box", creep=4.2e-4),
    ),  # where an edge is free
    ("sinks_as_computed", metric("elliptic_0_box", sunk=4.3e-6)),
    ("what_counts", copied("h_1ms_box", "tilt_10_firm")),
    ("round_cone_holds", metric("elliptic_10_firm", creep=5e-5)),
    ("engines_agree", metric("mujoco_tilt_5_box", creep=2e-4)),
    ("speed_misleads", metric("fall_box", slow_at=0.3)),
    ("window_has_an_edge", metric("tilt_10_rough", moved=1e-4)),
]


def test_each_check_fails_for_its_spoiled_runs(run):
    # MuJoCo repeats fewer steps of the run with impratio 100 that takes the place of Genesis here.
    require_spoilers(run, SPOILERS)
