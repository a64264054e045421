"""The tests of the student's functions: our solutions pass, and those with a typical mistake fail."""

import numpy as np
import pytest
from lessons.exercise_cells import page_of

from robo_genesis.lessons import l08
from robo_genesis.lessons.l08 import exercises

SOLVED = {
    cell.source.partition("(")[0].removeprefix("def "): cell.source
    for cell in page_of("l08", "lab").notebook.cells
    if "solution" in cell.metadata.get("tags", [])
}
TESTS = dict(zip(SOLVED, ("grasp", "ends", "ladders", "intervals", "sliding"), strict=True))

# By function, what is replaced in our solution, and by what
MISTAKES = {
    "grasp_pose": {
        "z + height": ["height", "z + height / 2", "z"], "- 0.025": ["+ 0.025", ""],
        "+ 0.1034": ["- 0.1034", ""], "[0, 0, 0.1]": ["0.1", "[0.1, 0, 0]", "[0, 0, -0.1]", "[0, 0, 0.1 - grasp[2]]"],
        "grasp + [0, 0, 0.1], grasp": ["grasp, grasp + [0, 0, 0.1]", "grasp", "[0, 0, 0.1], grasp"],
        "return grasp + [0, 0, 0.1]": ["above = grasp; above[2] += 0.1\n    return above"],
        "x, y, z = place": ["place[2] += 0; place += 1e-9; x, y, z = place"],
        "np.array([x, y, z + height - 0.025 + 0.1034])": ["np.round([x, y, z + height + 0.0784], 2)", "1000 * np.array([x, y, z + height + 0.0784])"],
    },
    "ended": {
        "near & slow": ["near | slow", "near", "slow", "near & slow & (since >= 5)", "near & slow & still"],
        "still & (since >= 5)": ["still", "since >= 5", "still & (since > 5)", "still | (since >= 5)", "near & still & (since >= 5)", "slow & still & (since >= 5)"],
        "where(of_fingers": ["where(np.logical_not(of_fingers)"], "0.002": ["0.02", "0.05"], "0.015": ["0.0014", "0.15"], "0.05": ["0.5", "0.04"],
        "np.abs(q[..., :7] - goal) <": ["q[..., :7] - goal <", "goal - q[..., :7] <", "np.nan_to_num(np.abs(q[..., :7] - goal)) <", "0.014999 >= 0 * q[..., :7] + np.abs(q[..., :7].sum(axis=-1, keepdims=True) - goal.sum(axis=-1, keepdims=True)) <"],
        "np.abs(q[..., :7] - goal) < 0.015": ["np.abs(q[..., :7] - goal) <= 0.015", "~(np.abs(q[..., :7] - goal) >= 0.015)"],
        "np.abs(qd[..., :7]) < 0.05": ["qd[..., :7] < 0.05", "np.abs(qd[..., :7]) <= 0.05", "np.abs(qd) < 0.05", "~(np.abs(qd[..., :7]) >= 0.05)"],
        "np.abs(qd[..., 7:]) < 0.002": ["qd[..., 7:] < 0.002", "np.abs(qd[..., 7:]) <= 0.002", "np.abs(qd[..., 7:].sum(axis=-1, keepdims=True)) < 0.002", "np.abs(qd[..., 8:]) < 0.002", "np.abs(q[..., 7:]) < 0.002"],
        ".all(axis=-1)": [".any(axis=-1)", ".all()", ".all(axis=0)", ".all(axis=1)"], "return ": ["return not "],
        "np.where(of_fingers, still & (since >= 5), near & slow)": ["np.all(np.where(of_fingers, still & (since >= 5), near & slow))", "still & (since >= 5) if of_fingers else near & slow"],
    },
    "rungs": {
        "np.cumprod(passed).sum()": ["sum(passed)", "all(passed)", "7 - sum(passed)", "max(np.flatnonzero([1, *passed]))"],
        "force > of.PRESSES": ["force >= of.PRESSES", "force > 0", "force > 1"], "both = (force > of.PRESSES).all(axis=1)": ["both = (force > of.PRESSES).any(axis=1)", "both = force.sum(axis=1) > 0.2", "both = force[:, 0] > 0.1", "both = force[:, 1] > 0.1", "both = force.mean(axis=1) > 0.1"],
        "phase[0] != of.DONE": ["True", "(phase != of.DONE).any()", "phase[-1] != of.DONE"],
        "both[phase == of.LIFT].any()": ["both.any()", "both[phase == of.LIFT].all()", "both[phase >= of.LIFT].any()", "(force > 0.1)[phase == 3].any(0).all()", "both[phase <= of.LIFT].any()"],
        "pos[phase >= of.MOVE][:1, 2]": ["pos[phase == of.MOVE][:1, 2]", "pos[phase >= of.MOVE][:, 2]", "pos[phase == of.LIFT][-1:, 2]", "pos[(phase >= of.MOVE).argmax():, 2]", "pos[:, 2]", "pos[phase <= of.MOVE][-1:, 2]"],
        "- pos[0, 2] >=": [">=", "- 0.035 >=", "- pos[0, 2] >", "- pos[2, 2] >="], "np.isin(phase, (of.MOVE, of.LOWER))": ["phase == of.MOVE", "phase == of.LOWER", "phase >= of.MOVE", "np.isin(phase, (3, 4, 5))", "np.isin(phase, (4, 5, 6))"],
        "carry.any() and both[carry].all()": ["both[carry].all()", "both[carry].any()", "carry.any() and both[carry][-1]", "carry.any() and both[carry].mean() > 0.5", "set(phase) >= {4, 5} and both[carry].all()"],
        "phase[-1] == of.DONE and touches[-1] == 0": ["phase[-1] == of.DONE", "touches[-1] == 0", "(phase == of.DONE).any() and touches[-1] == 0", "phase[-1] == of.DONE and touches[phase == of.DONE].sum() == 0", "phase[-1] == of.DONE and not both[-1]", "phase[-1] == of.DONE and touches.any() == 0"],
        "near and lowest < rim[2] - of.BELOW": ["near", "lowest < rim[2] - of.BELOW", "near and lowest < rim[2]", "near and lowest < 0.04", "near and pos[-1, 2] < rim[2] - of.BELOW / 2", "near and not lowest >= rim[2] - of.BELOW", "near and lowest < of.BELOW", "near and lowest > of.BELOW - rim[2]"],
        "np.linalg.norm(pos[-1, :2] - rim[:2])": ["abs(pos[-1, :2] - rim[:2]).max()", "np.linalg.norm(pos[-1] - rim)", "np.linalg.norm(pos[-1, :2] - (0.55, 0.22))", "abs(pos[-1, 0] - rim[0])", "np.linalg.norm(pos[:, :2] - rim[:2], axis=1).min()"],
        "pos[-5:]": ["pos[-4:]", "pos[-6:]", "pos[-5]", "pos[-2:]", "pos[phase == of.DONE]", "pos[-5::4]", "pos[-3:]"],
        "np.linalg.norm(pos[-5:] - pos[-1], axis=1)": ["abs(pos[-5:] - pos[-1])", "np.linalg.norm((pos[-5:] - pos[-1])[:, :2], axis=1)", "abs(pos[-5:, 2] - pos[-1, 2])", "pos[-5:] - pos[-1]", "np.ptp(pos[-5:], axis=0)", "np.linalg.norm(np.diff(pos[-5:], axis=0), axis=1)", "np.linalg.norm(pos[-5:] - pos[-5], axis=1)"],
        "moved.max()": ["moved.mean()", "moved.min()", "moved.sum()"],
    },
    "wilson": {
        "1.96**2": ["1.96", "2**2", "1.645**2"], "half = 1.96 *": ["half =", "half = 2 *", "half = 1.96**2 *"], "np.sqrt(": ["("],
        "(4 * n)": ["4 * n", "4", "(2 * n)"], "p * (1 - p) / n": ["p * (1 - p)", "p / n"], "more / 2": ["more", "0"], "/ (1 + more)": ["", "/ (1 + more / 2)"],
        "(-1, 1)": ["(1, -1)", "(0, 1)", "(-2, 2)"], "n < 1 or ": [""], "not 0 <= k <= n": ["k > n", "k < 0", "not 0 < k <= n", "not 0 <= k < n", "False"],
        "return tuple(": ["return sum(", "return tuple(100 * x for x in "], "ValueError": ["KeyError", "ZeroDivisionError"],
        "p, more": ["p, more = k / n, 1.96**2 / n; p = round(p, 2); q, more", "p, more = (k + 2) / (n + 4), 1.96**2 / n; q, more"],
    },
    "creep": {
        "hand_z - object_z": ["object_z - hand_z", "-object_z", "hand_z", "1000 * (hand_z - object_z)", "np.diff(hand_z - object_z, prepend=0)"],
        "t.mean()": ["0", "t[0]", "np.median(t)", "t.sum()"], "(after**2).sum()": ["after.sum()", "len(t)", "(t**2).sum()", "after.sum()**2", "(t[-1] - t[0])", "0.05"],
        "after = ": ["t = 0.05 * np.arange(len(t)); after = ", "t = np.arange(len(t)); after = ", "t = np.linspace(t[0], t[-1], len(t)); after = "],
        "return ": ["s = hand_z - object_z; return (s[-1] - s[0]) / (t[-1] - t[0]); ", "return np.median(np.diff(hand_z - object_z) / np.diff(t)); ", "return np.gradient(hand_z - object_z, t).mean(); ", "return abs", "return -"],
    },
}  # fmt: skip


def judged(name, old, new):
    names = {"np": np, "l08": l08}
    assert old in SOLVED[name]
    exec(SOLVED[name].replace(old, new), names)
    return getattr(exercises, TESTS[name])(names[name])


@pytest.mark.parametrize("name", SOLVED)
def test_our_solution_passes(name):
    found = judged(name, "", "")
    assert found.passed, found.detail


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(
    ("name", "old", "new"),
    [(name, old, new) for name, of in MISTAKES.items() for old, all_new in of.items() for new in all_new],
)
def test_a_mistake_is_found(name, old, new):
    assert not judged(name, old, new).passed
