"""The formulas, the laws and the checks of held boxes, without Genesis."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import (
    case,
    copied,
    metric,
    put,
    reading,
    shift,
    trace,
)
from lessons.experiments import require_spoilers

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l08 import creep
from robo_genesis.lessons.l08.creep_checks import CREEP
from robo_genesis.sim.bodies.grippers import CONTACTS, LINKS, HeldCase
from robo_genesis.sim.bodies.soft_contact import depth_and_creep, impratio
from robo_genesis.sim.mujoco import grippers as mujoco_grippers

GROUPS = ("friction", "time_constant")


def as_genesis(held):
    """Make the edges of MuJoCo's pyramid as soft as those of Genesis.

    With μ² / impratio for each μ², Genesis has 1 + μ² / impratio where MuJoCo has 1 + μ².
    """
    ratio, square = impratio(held), held.friction**2
    if held.cone == "pyramidal":
        ratio *= (1 + square) / (1 + square / ratio)
    return replace(held, impratio=ratio)


@pytest.fixture(scope="module")
def run():
    cases = CREEP.cases
    traces = {
        n: mujoco_grippers.run_case(as_genesis(of) if n in creep.CASES else of)
        for n, of in cases.items()
    }
    for name in creep.TWINS:  # two engines never agree to the last bit
        traces[name] = replace(
            traces[name], link_pos=traces[name].link_pos + np.float32(3e-8)
        )
    readings = {of: {n: getattr(cases[n], of) for n in creep.CASES} for of in GROUPS}
    readings["contacts"] = dict.fromkeys(creep.CASES, CONTACTS)
    readings["turned"] = dict.fromkeys(creep.TURNED, 5e-6) | {"plain_45": 0.0306}
    return Experiment(CREEP, traces, LINKS, readings, {}, False)


@pytest.mark.parametrize(
    ("changes", "depth", "speed"),
    [
        ({}, 263.1e-6, 1.2318e-3),
        (
            {"friction": 2.0},
            1287.9e-6,
            1.5793e-3,
        ),  # deeper than the width of the impedance
        ({"force": 40.0}, 654.5e-6, 0.7925e-3),
        ({"mass": 1.5}, 14.3e-6, 3.0886e-3),  # heavier than µN
        ({"cone": "elliptic"}, 263.1e-6, 6.16e-6),
        ({"impratio": 100.0}, 1.45e-6, 6.73e-6),
    ],
)
def test_the_formulas_give_known_values(changes, depth, speed):
    found = depth_and_creep(HeldCase(**changes))
    assert found == pytest.approx((depth, speed), rel=3e-3)


def test_a_pyramid_with_impratio_is_softer_in_mujoco():
    one, other = (
        np.array(depth_and_creep(HeldCase(impratio=1e4), of)) for of in (False, True)
    )
    assert other / one == pytest.approx(2, rel=1e-3)


def test_both_sides_of_the_weight_µn_meet():
    below, above = (HeldCase(mass=creep.LIGHT * (1 + of)) for of in (-1e-6, 1e-6))
    assert depth_and_creep(below) == pytest.approx(depth_and_creep(above), rel=1e-5)


SPOILERS = [
    ("settings", reading("friction", "base", 0.9)),
    ("settings", reading("contacts", "m_15", 4)),
    ("stamps", case("base", duration=0.3)),
    ("laws_of_motion", trace("base", link_vel=shift((-1, 0, 2), 1e-5))),
    ("laws_of_motion", trace("base", link_quat=put((3, 0, 1), 2e-4))),
    ("creeps_as_computed", metric("base", creep=1.25e-3)),
    ("creeps_as_computed", metric("mujoco_elliptic_mu_2", creep=6.5e-6)),
    ("sinks_as_computed", metric("elliptic_mu_03", depth=14e-6)),
    ("friction_lets_creep", copied("mu_2", "mu_03")),
    ("what_counts", copied("h_1ms_base", "T_5ms_base")),
    ("noslip_ends_at_half", copied("noslip_5_m_15", "noslip_5_base")),
    ("noslip_ends_at_half", metric("mujoco_noslip_5_mu_2", creep=-5e-5)),
    ("round_cone_holds", copied("elliptic_m_15", "elliptic_10_m_15")),
    ("engines_agree", metric("mujoco_T_5ms_base", creep=6.7e-4)),
    ("pyramid_has_corners", reading("turned", "plain_45", 1e-3)),
    ("creeps_on", metric("long", path=0.0125)),
]


def test_each_check_fails_for_its_spoiled_runs(run):
    require_spoilers(run, SPOILERS)
