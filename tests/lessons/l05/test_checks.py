"""The named checks pass for plausible runs, and each fails when one input changes."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import copied, put, reading, shift, trace
from lessons.exercise_cells import with_mistake
from lessons.experiments import require_spoilers
from robot_runs import LINKS, answer, driven

from robo_genesis.core.checks import evaluate
from robo_genesis.lessons.l05 import checks, exercises, spec, study
from robo_genesis.lessons.l05.pages import LECTURE
from robo_genesis.lessons.l05.run import control_case
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.engine_kinematics import IkAnswer, NotAccepted
from robo_genesis.sim.arm.kinematics import HAND


def moved_hand(name, by):
    return trace(name, link_pos=shift((slice(None), HAND), by))


def on_the_other_side(at):
    """Let the hand end as far from its target as before, on the other side of it."""
    return put((-1, HAND), 2 * spec.TARGET - at[-1, HAND])(at)


def with_answer(position, quat, name="unreachable"):
    """Let the engine's answers of a run put the hand into a pose."""
    index = slice(1, None), HAND
    return trace(name, link_pos=put(index, position), link_quat=put(index, quat))


CHANGES = [
    (
        "mapping",
        lambda run: replace(run, links=(*run.links[:8], "flange", *run.links[9:])),
    ),
    ("stamps", trace("baseline", t=lambda t: 2 * t)),
    ("acceptance", reading("ik", "residual_m", 6e-4)),
    ("acceptance", reading("ik", "residual_m", 2e-5)),
    ("forward_kinematics", moved_hand("kp_doubled", 1e-5)),
    ("second_engine", moved_hand("kp_doubled", 1e-5)),
    ("arrived", moved_hand("kp_doubled", 0.05)),
    ("sag_explains", copied("baseline", "kp_doubled")),
    (
        "smaller_angles_explain_more",
        trace("kp_doubled", link_pos=lambda at: 1.001 * at),
    ),
    ("kp_has_a_price", copied("kp_doubled", "baseline")),
    ("kp_has_a_price", copied("kp_doubled_ramp", "kp_doubled")),
    ("kp_has_a_price", trace("kp_doubled_ramp", link_pos=on_the_other_side)),
    ("solver_ignores_the_floor", reading("ik", "low_tip_m", -0.04)),
    ("solver_ignores_the_floor", reading("ik", "low_residual_rad", 0.01)),
    ("tolerance_costs_little", reading("iterations", "at_5_um", 8)),
    ("tolerance_costs_little", reading("ik_residuals", "at_5_um", 6e-6)),
    ("repeatable", trace("kp_doubled", target=shift((0, 0), 1e-6))),
    ("first_start_fails", with_answer(spec.TARGET, spec.DOWN, "many_starts")),
    ("restarts_rescue_few", copied("vertical_restarted", "vertical")),
    (
        "restarts_rescue_few",
        with_answer(spec.PLANES["vertical"], spec.DOWN, "vertical_restarted"),
    ),
    (
        "map_has_targets_in_the_floor",
        with_answer(spec.BEYOND_REACH, spec.DOWN, "vertical"),
    ),
    ("unreachable_refused", with_answer(spec.BEYOND_REACH, spec.DOWN)),
    ("nearest_is_nearer", with_answer(*kinematics.hand_pose(study.nearest()[0]))),
]


def test_each_check_fails_when_its_input_changes(reaches):
    require_spoilers(reaches, CHANGES)


def test_a_quaternion_of_the_other_sign_is_right(reaches):
    chain = with_mistake("l05", "chain", "return at, turn", "return at, -turn")
    assert exercises.forward(chain, reaches.traces["baseline"]).passed


def test_the_lecture_compares_solver_steps_and_force_limits(reaches):
    found = answer(spec.TARGET, spec.BASELINE.q_start, 100)
    more = {
        name: case for name, case in LECTURE.cases.items() if name not in reaches.traces
    }
    runs = {
        name: driven(control_case(case, found), LINKS) for name, case in more.items()
    }
    run = replace(reaches, page=LECTURE, traces={**reaches.traces, **runs})
    changes = (
        lambda of: of,
        copied("kp_doubled_fine", "kp_doubled"),
        copied("unlimited", "kp_doubled"),
    )
    outcomes = [evaluate(checks.LECTURE[-2:], change(run)) for change in changes]
    assert [[check.passed for check in of] for of in outcomes] == [
        [True, True],
        [False, True],
        [True, False],
    ]


@pytest.mark.parametrize(
    ("change", "label"),
    [
        (moved_hand("unreachable", 1e-4), "link_pos"),
        (trace("many_starts", q=shift(3, 1e-4)), "q [rad"),
        (trace("baseline", control_force=shift(9, 1.0)), "control_force"),
    ],
)
def test_a_run_that_breaks_a_law_is_found(reaches, change, label):
    found = checks.laws_of_motion(change(reaches))
    assert [label in one.label for one in found if not one.passed] == [True]


def test_an_answer_that_is_not_accepted_is_not_commanded():
    q = np.float32(spec.BASELINE.q_start)
    with pytest.raises(NotAccepted, match=r"The residual is 0\.001 m .* Nothing is"):
        control_case(spec.BASELINE, IkAnswer(q, np.float32([1e-3, 0, 0, 0, 0, 0])))
    q[0] = np.nan
    with pytest.raises(NotAccepted, match="finite joint positions"):
        control_case(spec.BASELINE, IkAnswer(q, np.zeros(6, np.float32)))
    low = answer(spec.IN_THE_FLOOR.position, spec.BASELINE.q_start, 100)
    assert kinematics.distances(low.error)[0] < spec.IK.position_tolerance
    with pytest.raises(
        NotAccepted, match=r"fingertips is -0\.0623 m, accepted is 0\.03 m"
    ):
        control_case(spec.IN_THE_FLOOR, low)


def test_a_self_motion_keeps_the_hand_in_place_and_groups_solutions(reaches):
    curve = study.self_motion(reaches.traces["baseline"].target[0, :7])
    error = kinematics.pose_error(study.GOAL, kinematics.hand_pose(curve))
    assert np.abs(error).max() < 1e-3
    assert np.linalg.norm(np.diff(curve, axis=0), axis=1).max() < 0.1
    assert np.ptp(curve, axis=0).max() > 0.5
    ((of_curve, inside),) = study.families(curve[::5])
    assert len(inside) == len(curve[::5])
    assert len(of_curve) > 10
