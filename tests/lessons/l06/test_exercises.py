"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

from functools import partial

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l06 import exercises
from robo_genesis.sim.arm import kinematics as of

SOLVED = solutions("l06")


def checked(robot, dofs, q, envs, known=range(4), axes=2, twice=False):
    """Check what the task asks for; other values of the last arguments forget something."""
    if not {*envs} <= {*known} or (len({*envs}) < len(envs) and not twice):
        raise ValueError(envs)
    if np.shape(q)[:axes] != (len(envs), len(dofs))[:axes]:
        raise ValueError(np.shape(q))
    if len(envs):
        robot.control_dofs_position(q, dofs, envs_idx=envs)


def timed(step, finish, clock, warm_up, steps, repeats, *, middle=np.median, before=True,
          after=True, share=True, warm=True):  # fmt: skip
    """Time a step as the task asks; other values of the last arguments make mistakes."""
    for _ in range(warm_up if warm else 0):
        step()
    times = []
    for _ in range(repeats):
        if before:
            finish()
        begin = clock()
        for _ in range(steps):
            step()
        if after:
            finish()
        times.append((clock() - begin) / (steps if share else 1))
    return middle(times)


CASES = {
    "acceptance": {
        "right": SOLVED["accept"],
        "always": lambda q, e, most, angle: np.ones(len(q), bool),
        "one verdict": lambda q, e, most, angle: bool(np.linalg.norm(e[:, :3]) <= most),
        "mean": lambda q, e, most, angle: np.full(len(q), np.abs(e[:, :3]).mean() <= most),
        "other axis": lambda q, e, most, angle: np.linalg.norm(e, axis=0) <= most,
        "q not looked at": lambda q, e, *most: of.accepted(np.zeros_like(q), e, *most),
        "one norm of six": lambda q, e, most, angle: np.linalg.norm(e, axis=1) <= most,
        "typed tolerances": lambda q, e, most, angle: of.accepted(q, e, 5e-4, 5e-3),
        "last joint alone": lambda q, e, *most: of.accepted(q[:, 8:], e, *most),
        "infinite": lambda q, e, *most: of.accepted(np.nan_to_num(q, nan=np.nan), e, *most),
        "not written": lambda q, e, most, angle: None,
    },
    "subset": {
        "right": SOLVED["command"],
        "engine alone": lambda robot, dofs, q, envs: robot.control_dofs_position(q, dofs, envs),
        "sorted": lambda robot, dofs, q, envs: checked(robot, dofs, q, sorted(envs)),
        "numbers as rows": lambda r, d, q, envs: checked(r, d, np.asarray(q)[list(envs)], envs),
        "numbers too high": partial(checked, known=range(9)),
        "negative numbers": partial(checked, known=range(-9, 4)),
        "named twice": partial(checked, twice=True),
        "columns not looked at": partial(checked, axes=1),
        "to all": lambda robot, dofs, q, envs: robot.control_dofs_position(q, dofs),
        "nothing": lambda robot, dofs, q, envs: None,
    },
    "throughput": {
        "right": timed,
        "mean": partial(timed, middle=np.mean),
        "last": partial(timed, middle=lambda times: times[-1]),
        "queue before the clock": partial(timed, before=False),
        "queue after the clock": partial(timed, after=False),
        "time of all steps": partial(timed, share=False),
        "no warm-up": partial(timed, warm=False),
    },
}


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in CASES.items() for how in of])
def test_only_the_right_solution_passes(name, how):
    check = getattr(exercises, name)(CASES[name][how])
    assert check.passed == (how == "right"), check.detail
