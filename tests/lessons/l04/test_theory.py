"""The ideal joint against another implementation and known answers; where a run leaves it."""

from dataclasses import astuple

import control
import numpy as np
import pytest

from robo_genesis.lessons.l04.theory import (
    IdealJoint,
    Parting,
    overshoot_share,
    parting,
    step_share,
    stepped_joint,
)

T = np.linspace(0, 1.2, 241)
REGIMES = {"under": 100.0, "nearly": 122.7, "over": 300.0, "undamped": 0.0}


def joint(damping):
    return IdealJoint(inertia=1.077, damping=damping, kp=3500.0)


@pytest.mark.parametrize("damping", REGIMES.values(), ids=REGIMES)
def test_the_response_is_that_of_the_transfer_function(damping):
    plant = control.tf([3500.0], [1.077, damping, 3500.0])
    oracle = control.step_response(plant, T).outputs
    assert joint(damping).response(T) == pytest.approx(oracle, abs=1e-6)


@pytest.mark.parametrize("damping", [20.0, 60.0, 100.0])
def test_the_overshoot_is_that_of_step_info(damping):
    plant = control.tf([3500.0], [1.077, damping, 3500.0])
    fine = np.linspace(0, 1.2, 24001)
    info = control.step_info(plant, T=fine)
    assert 100 * joint(damping).overshoot == pytest.approx(info["Overshoot"], abs=1e-3)


@pytest.mark.parametrize("damping", [5.0, 60.0, 100.0])
def test_damping_ratio_and_frequency_are_the_poles(damping):
    plant = control.tf([3500.0], [1.077, damping, 3500.0])
    omegas, zetas, _ = control.damp(plant, doprint=False)
    assert omegas == pytest.approx([joint(damping).omega] * 2)
    assert zetas == pytest.approx([joint(damping).zeta] * 2)


def test_critical_damping_has_its_closed_form():
    critical = IdealJoint(inertia=1.0, damping=20.0, kp=100.0)
    assert critical.zeta == 1
    assert critical.overshoot == 0
    assert critical.response(np.array([0.1])) == pytest.approx([1 - 2 / np.e])


@pytest.mark.parametrize("off", [1e-12, -1e-12, 1e-7, -1e-7])
def test_the_regimes_meet_at_critical_damping(off):
    near = IdealJoint(inertia=1.0, damping=20.0 * (1 + off), kp=100.0)
    critical = IdealJoint(inertia=1.0, damping=20.0, kp=100.0)
    assert near.response(T) == pytest.approx(critical.response(T), abs=1e-6)


def test_a_strongly_overdamped_joint_neither_overflows_nor_overshoots():
    slow = IdealJoint(inertia=0.01, damping=5000.0, kp=100.0)
    y = slow.response(np.array([0.0, 50.0, 1e6]))
    assert y == pytest.approx([0, 1 - np.exp(-1), 1], abs=1e-5)
    assert slow.overshoot == 0


@pytest.mark.parametrize(
    "spoiled", [{"inertia": 0.0}, {"inertia": -1.0}, {"kp": 0.0}, {"damping": -1.0}]
)
def test_a_joint_that_cannot_be_is_refused(spoiled):
    with pytest.raises(ValueError, match="must be positive"):
        IdealJoint(**({"inertia": 1.0, "damping": 1.0, "kp": 1.0} | spoiled))


GAINS = {"G1": (3500.0, 100.0), "G2": (7000.0, 100.0), "G3": (7000.0, 300.0)}
H, STEPS = 0.005, 240


def stepped(case, step, h=H, steps=STEPS, **forces):
    kp, kv = GAINS[case]
    return stepped_joint(IdealJoint(1.077, kv + 1.0, kp), 1.0, step, h, steps, **forces)


@pytest.mark.parametrize(("case", "share"), [("G1", 0.031), ("G2", 0.145), ("G3", 0.0)])
def test_the_stepped_joint_overshoots_a_small_step_by_known_shares(case, share):
    assert max(0.0, stepped(case, 0.005).max() / 0.005) == pytest.approx(share, abs=5e-4)


@pytest.mark.parametrize(("case", "overshoot"), [("G1", 0.0), ("G2", 0.054), ("G3", 0.0)])
def test_the_clipped_stepped_joint_with_gravity_overshoots_in_g2_alone(case, overshoot):
    path = stepped(case, 0.25, limit=87.0, gravity=(22.57 + 21.61) / 2)
    assert max(0.0, path.max()) == pytest.approx(overshoot, abs=5e-4)


@pytest.mark.parametrize("case", GAINS)
def test_the_stepped_joint_approaches_the_ideal_one_as_its_step_shrinks(case):
    kp, kv = GAINS[case]
    t = np.linspace(0, 0.4, 9)
    ideal = IdealJoint(1.077, kv + 1.0, kp).response(t)
    off = []
    for h in (1e-3, 1e-4):
        path = 1 + stepped(case, 1.0, h, round(0.4 / h))
        off.append(np.abs(path[:: round(0.05 / h)] - ideal).max())
    assert off[1] < 0.2 * off[0] < 0.2


def test_the_stepped_joint_rests_where_gravity_balances_its_gain():
    assert stepped("G3", 0.25, limit=87.0, gravity=21.0)[-1] == pytest.approx(-21 / 7000, abs=1e-5)


def test_a_clipped_first_step_does_not_depend_on_kp():
    first = [stepped(case, 0.25, limit=87.0)[1] for case in ("G1", "G2")]
    assert first[0] == first[1]


IDEAL = np.array([0.0, 0.2, 0.5, 0.8, 1.0])


# State 2 follows from the efforts at t[0], which is not clipped in these runs, and t[1].
@pytest.mark.parametrize(
    ("q", "efforts", "expected"),
    [
        ([0.0, 0.15, 0.3, 0.8, 1.0], (87.0, 87.0, 20.0, 10.0), Parting(0.02, 0.2, 1, 2)),
        ([0.0, 0.2, 0.3, 0.8, 1.0], (0.0, 87.0, 87.0, 87.0), Parting(0.02, 0.2, 0, 2)),
        (IDEAL + 0.05, (87.0, 87.0, 20.0, 10.0), Parting(None, 0.05, 2, 4)),
    ],
)
def test_parting_is_the_first_sample_beyond_the_threshold(make_trace, q, efforts, expected):
    trace = make_trace(q, 1.0, control_force=efforts)
    found = parting(trace, trace.q[:, 0], IDEAL, 0, 0.1)
    assert astuple(found) == pytest.approx(astuple(expected))


@pytest.mark.parametrize("short", ["measured", "ideal"])
def test_responses_of_another_length_are_refused(make_trace, short):
    trace = make_trace(IDEAL, 1.0)
    given = {"measured": IDEAL, "ideal": IDEAL} | {short: IDEAL[1:]}
    with pytest.raises(ValueError, match="one value for each state"):
        parting(trace, given["measured"], given["ideal"], 0, 0.1)


def test_what_acts_on_both_runs_is_gone_from_the_share(make_trace):
    sag = -0.02 * np.arange(5)
    share = step_share(make_trace(0.5 * IDEAL + sag, 0.5), make_trace(sag, 0.0), 0)
    assert share == pytest.approx(IDEAL)


@pytest.mark.parametrize(
    ("step", "hold", "says"),
    [
        (([0.0, 1.0], 1.0), ([0.0, 0.0, 0.0], 0.0), "different times"),
        (([0.1, 1.0], 1.0), ([0.0, 0.0], 0.0), "different states"),
        (([0.0, 1.0], 1.0), ([0.0, 0.0], 1.0), "step is 0"),
    ],
)
def test_runs_that_do_not_belong_together_give_no_share(make_trace, step, hold, says):
    with pytest.raises(ValueError, match=says):
        step_share(make_trace(*step), make_trace(*hold), 0)


@pytest.mark.parametrize(("peak", "share"), [(1.12, 0.12), (0.9, 0.0)])
def test_overshoot_is_counted_from_one(peak, share):
    assert overshoot_share(np.array([0.0, peak, 0.8])) == pytest.approx(share)
