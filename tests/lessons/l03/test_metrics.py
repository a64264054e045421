"""Known answers: theory, energy, clearance, metrics, and the tables and figures of them."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import body_at

from robo_genesis.core.text import readable
from robo_genesis.lessons.l03 import (
    metrics,
    spec,
    study_spec,
    theory,
)
from robo_genesis.lessons.l03.metrics import (
    landing_metrics,
)
from robo_genesis.sim.bodies.contacts import TOP

PUSH = replace(spec.PUSHED, gravity=10.0)  # at 2 m/s with μ = 0.5
REST = spec.BASELINE.rest_height


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (theory.coulomb_distance(PUSH), 0.4),  # 4 / 10 m
        (theory.apparent_friction(PUSH, 0.4), 0.5),
        ([rule(0.2, 0.8) for rule in theory.RULES.values()], [0.8, 0.2, 0.5, 0.4]),
        (theory.kept_at_bounces(0.001), np.exp(-2 * np.pi * 0.001)),
        (theory.contact_seconds(spec.BASELINE), 0.01),
        (theory.rebound(spec.BASELINE), 0),
        (
            theory.upward_blow(replace(spec.PUSHED, speed=1.0)),
            0.4,
        ),  # 2 · 0.5 · 0.5 / 1.25 m/s
        (theory.hop(spec.PUSHED), 4 * theory.hop(replace(spec.PUSHED, substeps=4))),
    ],
)
def test_numbers_by_hand(found, expected):
    assert found == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("n", [40, 4.5])
def test_the_stepped_distance_is_what_a_loop_adds_up_to(n):
    h = 0.4 / n  # the body stops after n steps
    case = replace(PUSH, dt=h, substeps=1, duration=h, settle=0)
    x = h * (2.0 - 5 * h * np.arange(1, int(n) + 1)).sum()
    longer = x - theory.stepped_distance(case)
    assert longer == pytest.approx(0 if n == int(n) else 5 * h**2 / 8, abs=1e-12)


def test_depth_and_release_are_those_of_the_equation():
    case = study_spec.RELEASE_CASES["release_5ms"]["release_5ms_10000"]
    seconds, h = 0.005, 1e-7
    x, v, deepest = 0.0, theory.impact_speed(case), 0.0
    while (push := 2 * v / seconds + x / seconds**2) >= 0:  # it never pulls
        v -= h * push
        x += h * v
        deepest = max(deepest, x)
    assert deepest == pytest.approx(theory.depth(case), rel=1e-3)
    assert -v == pytest.approx(theory.release_speed(case), rel=1e-3)
    assert v**2 / (2 * case.gravity) - x == pytest.approx(
        theory.rebound(case), rel=1e-2
    )


def test_energies_of_a_state_by_hand():
    case = spec.BASELINE
    trace = body_at([REST + 1.0] * 2, vz=3.0)
    total = case.mass * (3.0**2 / 2 + 9.81)
    assert metrics.total_energy(trace, case) == pytest.approx([total] * 2)
    error = case.mass * 9.81 * case.h * 3.0 / 2
    assert metrics.conserved_energy(trace, case) == pytest.approx([total - error] * 2)
    turning = replace(trace, link_ang=np.full_like(trace.link_ang, 10))
    more = case.inertia * 300 / 2
    assert metrics.total_energy(turning, case) == pytest.approx([total + more] * 2)


REACHES = [((1, 0, 0), 0.04 * np.sqrt(2)), ((0, 0, 1), 0.04)]


@pytest.mark.parametrize(("axis", "reach"), REACHES)
def test_a_cube_on_its_edge_reaches_lower(axis, reach):
    half = np.pi / 8  # 45° about the axis
    trace = body_at([1.0, 1.0], quat=(np.cos(half), *(np.sin(half) * np.array(axis))))
    for case, lowest in ((spec.BASELINE, reach), (spec.DROPPED_BALL, 0.04)):
        expected = 1.0 - lowest - TOP
        assert metrics.clearance(trace, case) == pytest.approx([expected] * 2, abs=1e-6)


def test_flights_are_the_stretches_in_the_air():
    up, down = REST + 0.01, REST - 0.001
    trace = body_at([up] * 4 + [down] * 2 + [up] * 2 + [down] + [up] * 3)
    found = metrics.flights(trace, spec.DROPPED_BALL)
    assert found == [slice(0, 4), slice(9, 12)]  # two states are too few


def test_metrics_of_a_landing_by_hand():
    z = REST + np.array([0.02, 0.01, -0.008, -0.001, 0.003, 0.002, -0.0001, 0, 0, 0])
    trace = body_at(
        z, contacts=[0, 0, 0, 4, 0, 0, 4, 4, 4, 4], vz=[0, -1, 0.5, 0.2] + [0] * 6
    )
    found = landing_metrics(trace, spec.BASELINE)
    assert (found.penetration, found.rebound) == pytest.approx((0.008, 0.003), abs=1e-6)
    assert (found.touchdown, found.upward_speed) == pytest.approx((0.02, 0.5))
    assert found.separated == pytest.approx(
        0.02
    )  # two samples without contact and clear
    assert (found.resting_time, found.resting_offset) == pytest.approx(
        (0.06, 0), abs=1e-6
    )
    never = landing_metrics(body_at([1.0] * 5), spec.BASELINE)
    assert (never.touchdown, never.resting_time) == (None, None)
    assert (never.penetration, never.rebound, never.separated) == (0, 0, 0)


def test_a_stop_takes_a_hold():
    speed = np.array([1, 0.005, 0.5] + [0.005] * 11 + [0.0])
    assert metrics.stopped_at(speed, 0.01) == 3  # not the one slow sample before
    assert (
        metrics.stopped_at(speed[:13], 0.01) is None
    )  # the window ends before the hold does
    assert metrics.stopped_at(np.full(40, 0.01), 0.01) is None  # slower, not as slow


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (0.006431, "m", "6.43 mm"),
        (-2.5e-5, "m", "−0.0250 mm"),
        (0.41040, "m", "0.4104 m"),
        (0.00123, "J", "1.23 mJ"),
        (2.5e-7, "J", "0.250 µJ"),
        (0.0, "m", "0 mm"),
        (None, "m", "not observed"),
    ],
)
def test_a_value_has_a_unit_of_its_size(value, unit, words):
    assert readable(value, unit) == words
