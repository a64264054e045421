"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

from functools import partial

import numpy as np
import pytest

from robo_genesis.lessons.l06 import exercises
from robo_genesis.sim import arm_kinematics as of


def norms(error, axis=1):
    return np.linalg.norm(error[:, :3], axis=axis), np.linalg.norm(error[:, 3:], axis=axis)


def all_at_once(q, error, most, angle):
    """Forget the axis: one verdict for the batch."""
    found = norms(error, None)
    return np.isfinite(q).all() and found[0] <= most and found[1] <= angle


def on_mean(q, error, most, angle):
    """Take the mean over the rows, and repeat it for each."""
    small = np.mean(norms(error)[0]) <= most
    return np.full(len(q), bool(small))


def q_not_looked_at(q, error, most, angle):
    apart, turned = norms(error)
    return (apart <= most) & (turned <= angle)


def checked(robot, dofs, q, envs, known=range(4), axes=2, twice=False):
    """Check what the task asks for; other values of the last arguments forget something."""
    if not {*envs} <= {*known} or (len({*envs}) < len(envs) and not twice):
        raise ValueError(envs)
    if np.shape(q)[:axes] != (len(envs), len(dofs))[:axes]:
        raise ValueError(np.shape(q))
    if len(envs):
        robot.control_dofs_position(q, dofs, envs_idx=envs)


def sorted_rows(robot, dofs, q, envs):
    checked(robot, dofs, q, sorted(envs))


def rows_of_the_batch(robot, dofs, q, envs):
    """Take the number of an environment for the number of a row."""
    checked(robot, dofs, np.asarray(q)[list(envs)], envs)


RIGHT = {"acceptance": {"ours": of.accepted}, "subset": {"ours": checked}}
WRONG = {
    "acceptance": {
        "always": lambda q, e, most, angle: np.ones(len(q), bool),
        "one verdict": all_at_once,
        "mean": on_mean,
        "other axis": lambda q, e, most, angle: np.linalg.norm(e, axis=0) <= most,
        "q not looked at": q_not_looked_at,
        "one norm of six": lambda q, e, most, angle: np.linalg.norm(e, axis=1) <= most,
        "typed tolerances": lambda q, e, most, angle: of.accepted(q, e, 5e-4, 5e-3),
        "last joint alone": lambda q, e, *most: of.accepted(q[:, 8:], e, *most),
        "infinite": lambda q, e, *most: of.accepted(np.nan_to_num(q, nan=np.nan), e, *most),
        "not written": lambda q, e, most, angle: None,
    },
    "subset": {
        "engine alone": lambda robot, dofs, q, envs: robot.control_dofs_position(q, dofs, envs),
        "sorted": sorted_rows,
        "row by the number of the environment": rows_of_the_batch,
        "numbers too high": partial(checked, known=range(9)),
        "negative numbers": partial(checked, known=range(-9, 4)),
        "named twice": partial(checked, twice=True),
        "columns not looked at": partial(checked, axes=1),
        "to all": lambda robot, dofs, q, envs: robot.control_dofs_position(q, dofs),
        "nothing": lambda robot, dofs, q, envs: None,
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in RIGHT.items() for how in of])
def test_a_right_solution_passes(name, how):
    (check,) = getattr(exercises, name)(RIGHT[name][how])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_the_message_says_what_was_found(name, how):
    (check,) = getattr(exercises, name)(WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail or "cannot" in check.detail
