"""When the experts of L09 go on, and what the one without memory sees."""

from dataclasses import replace

import numpy as np
import pytest
from robot_runs import answer

from robo_genesis.lessons.l09 import spec
from robo_genesis.lessons.l09.experts import KINDS, STAY, looked
from robo_genesis.sim.arm.lifting import HAND_TO_PAD
from robo_genesis.sim.arm.picking import PHASES

TABLE, EDGE, BOWL = [0.5, 0.0], [0.529, 0.22], spec.TRIED.bowl_at
CASE = replace(spec.TRIED, starts=np.array([TABLE]), beliefs=np.array([TABLE]))
Q, FAST = CASE.q_start[None], np.full((1, 9), 9.0)


def expert_of(kind, way=0.0):
    """Return an expert with all goals this far away in one joint [rad]."""
    goals = np.tile(CASE.q_start[:7], (len(PHASES), 1, 1))
    goals[..., 3] += way
    return KINDS[kind](CASE, goals, np.array([True]))


@pytest.mark.parametrize(
    ("phase", "way", "fingers", "ends"),
    [
        ("descend", 0.029, (0.04, 0.04), True),
        ("descend", 0.031, (0.02, 0.02), False),
        ("close", 1.0, (0.029, 0.029), True),
        ("close", 0.0, (0.029, 0.031), False),
        ("open", 1.0, (0.036, 0.036), True),
        ("open", 0.0, (0.034, 0.036), False),
    ],
)
def test_a_prompt_expert_goes_on_at_any_speed(phase, way, fingers, ends):
    expert, q = expert_of("prompt", way), Q.copy()
    expert.phase[:], q[:, 7:] = PHASES.index(phase), fingers
    assert expert.ends(q, FAST).tolist() == [ends]


@pytest.mark.parametrize("broken", [0, 3, STAY])
def test_a_delayed_expert_stays_and_counts_anew_if_it_leaves(broken):
    expert, phases = expert_of("delayed"), []
    for k in range(broken + 1 + 2 * (STAY + 1)):
        expert.act(Q + (k == broken), FAST)
        phases.append(int(expert.phase[0]))
    assert phases == [0] * (broken + 1 + STAY) + [1] * (STAY + 1) + [2]


@pytest.mark.parametrize(
    ("phase", "at", "height", "aside", "above", "fingers"),
    [
        ("pregrasp", TABLE, 0.035, 0.013, 0.01, 0.04),
        ("descend", TABLE, 0.035, 0.011, 0.023, 0.04),
        ("close", TABLE, 0.035, 0.011, 0.021, 0.031),
        ("pregrasp", TABLE, 0.104, 0.031, 0.01, 0.029),
        ("lift", TABLE, 0.104, 0.029, 0.01, 0.029),
        ("move", TABLE, 0.106, 0.0, 0.01, 0.029),
        ("move", EDGE, 0.12, 0.0, 0.01, 0.029),
        ("lower", BOWL, 0.061, 0.0, 0.01, 0.029),
        ("open", BOWL, 0.059, 0.0, 0.01, 0.029),
        ("open", BOWL, 0.059, 0.04, 0.01, 0.029),
        ("retreat", BOWL, 0.059, 0.0, 0.01, 0.031),
    ],
)
def test_each_phase_is_seen(phase, at, height, aside, above, fingers):
    pose = np.array([[*at, height, 1, 0, 0, 0]])
    hand = pose[0, :3] + [aside, 0, above + HAND_TO_PAD]
    q = answer(hand, CASE.q_start, 100).q[None].astype(float)
    q[:, 7:] = fingers
    assert PHASES[looked(CASE, q, pose)[0]] == phase
    expert = expert_of("looking")
    expert.phase[:] = 5  # whatever it was
    expert.act(q, FAST, pose)
    assert PHASES[expert.phase[0]] == phase


@pytest.mark.parametrize("kind", KINDS)
def test_a_command_moves_by_one_stride_at_most(kind):
    expert, pose = expert_of(kind, 0.15), np.ones((1, 7))
    sent = [expert.act(Q + 1, FAST, pose)[0, 3] for _ in range(4)]
    right = np.array([0.06, 0.12, 0.15, 0.15])
    assert sent == pytest.approx(CASE.q_start[3] + right)
