"""When an expert that is asked solves again, and which answers are learned."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from robo_genesis.lessons.l09 import remedies, spec, study
from robo_genesis.lessons.l09.cloning import Rows
from robo_genesis.lessons.l09.experts import CLOSE, LIFT, RETREAT
from robo_genesis.lessons.l09.remedies import MOVED, Asking

STARTS = np.array([[0.5, 0.0], [0.45, -0.1]])
CASE = replace(spec.QUESTIONED, starts=STARTS, beliefs=STARTS)
Q = np.tile(CASE.q_start, (2, 1))
POSE = np.column_stack([STARTS, np.tile([0.035, 1, 0, 0, 0], (2, 1))])
FAR, GOALS = Q + 1, np.tile(Q[:, :7], (9, 1, 1))


def asked(always, *moves):
    """Return clones that were asked with the second object moved by these in y [m]."""
    clones = Mock(training=spec.LOOKING, return_value=FAR[:, None])
    solve = Mock(return_value=(GOALS - 2, np.array([False, False])))
    one = Asking(clones, solve, always, CASE, GOALS + 2, np.array([True, True]))
    for way in moves:
        one.act(Q, 0 * Q, POSE + np.outer([0, 1], np.eye(7)[1] * way))
    return one


def test_postures_are_solved_again_if_an_object_moves():
    moves = np.array([0.0, 0.9, 1.1, 1.1, 0.2, 0.0, -0.9]) * MOVED
    calls = [asked(False, *moves[:n]).solve.call_count for n in range(1, 8)]
    assert calls == [0, 0, 1, 1, 1, 2, 2]


@pytest.mark.parametrize(
    ("always", "phase", "calls"), [(False, CLOSE, 1), (False, LIFT, 0), (True, LIFT, 1)]
)
def test_in_the_hand_they_are_solved_again_only_on_demand(
    monkeypatch, always, phase, calls
):
    monkeypatch.setattr(remedies, "looked", Mock(return_value=np.array([0, phase])))
    assert asked(always, 2 * MOVED).solve.call_count == calls


def test_an_answer_steps_from_the_last_command_to_the_goal_of_its_own_object():
    rows = asked(False, 0, 2 * MOVED).rows()
    first, second = rows.command[..., :7] - [Q[:, :7], FAR[:, :7]]
    assert first == pytest.approx(CASE.stride, abs=1e-6)
    assert second / CASE.stride == pytest.approx(np.tile([[1], [-1]], 7), abs=1e-5)
    assert rows.used.tolist() == [[True, True], [True, False]]


def test_the_answers_of_two_episodes_of_each_network_are_learned():
    number = np.arange(128)[None]
    rows = Mock(rows=lambda: Rows({"q": number}, number, number))
    found = study.Study.ask(Mock(run=Mock(return_value=[rows])), Mock())
    right = [16 * k + j for k in range(8) for j in range(2)]
    for of in (found.seen["q"], *found[1:]):
        assert of[0].tolist() == right


def test_the_postures_are_those_above_the_bowl():
    """The last joint turns the hand, and does not move it."""
    way = np.zeros((9, 1, 7))
    way[RETREAT, :, 6] = -0.3
    solve = Mock(side_effect=[(GOALS, None), (GOALS + way, None)])
    found = study.Study.postures(Mock(solve=solve))
    assert found == pytest.approx({"joints": 0.3, "hand": 0}, abs=1e-6)
    assert (solve.call_args[0][0] == CASE.bowl_at).all()
