"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

from functools import partial

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l06 import exercises
from robo_genesis.sim.arm import kinematics as of

SOLVED = solutions("l06")


def checked(
    robot,
    dofs,
    q,
    envs,
    known=None,
    axes=None,
    twice=False,
    change=lambda q, envs, n: (q, envs),
):
    """Check what the task asks for; other values of the last arguments make mistakes."""
    known = known or range(robot.scene.n_envs)
    if len(envs) and np.asarray(envs).dtype.kind != "i":
        raise ValueError(envs)
    envs = [int(k) for k in envs]
    if not {*envs} <= {*known} or (len({*envs}) < len(envs) and not twice):
        raise ValueError(envs)
    if np.shape(q)[:axes] != (len(envs), len(dofs))[:axes]:
        raise ValueError(np.shape(q))
    if len(envs):
        q, envs = change(q, envs, robot.scene.n_envs)
        robot.control_dofs_position(q, dofs, envs_idx=envs)


def timed(
    step,
    finish,
    clock,
    warm_up,
    steps,
    repeats,
    *,
    middle=np.median,
    before=True,
    after=True,
    warm=True,
):
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
        times.append((clock() - begin) / steps)
    return middle(times)


CASES = {
    "acceptance": {
        "right": SOLVED["accept"],
        "one verdict": lambda q, e, most, angle: bool(np.linalg.norm(e[:, :3]) <= most),
        "mean": lambda q, e, most, angle: np.full(
            len(q), np.abs(e[:, :3]).mean() <= most
        ),
        "typed tolerances": lambda q, e, most, angle: of.accepted(q, e, 5e-4, 5e-3),
        "first and last joint": lambda q, e, *most: of.accepted(q[:, [0, 8]], e, *most),
        "two axes": lambda q, e, *most: of.accepted(q, e * [1, 1, 1, 1, 1, 0], *most),
        "parts": lambda q, e, m, a: (
            (abs(e) <= [m] * 3 + [a] * 3).all(1) & np.isfinite(q).all(1)
        ),
        "no angle": lambda q, e, *most: of.accepted(
            q, np.where(e == e, e, e[:, :1]), *most
        ),
        "numbers of rows": lambda q, e, *most: np.flatnonzero(of.accepted(q, e, *most)),
        "infinite": lambda q, e, *most: of.accepted(
            np.nan_to_num(q, nan=np.nan), e, *most
        ),
    },
    "subset": {
        "right": SOLVED["command"],
        "engine alone": lambda robot, dofs, q, envs: robot.control_dofs_position(
            q, dofs, envs
        ),
        "right in another way": checked,
        "masks in lists": lambda r, d, q, e: checked(
            r, d, q, [k + 0 for k in e] if isinstance(e, list) else e
        ),
        "masks of Torch": lambda r, d, q, e: checked(
            r, d, q, [int(k) for k in e] if hasattr(e, "cpu") else e
        ),
        "parts cut off": lambda r, d, q, e: checked(
            r, d, q, e if np.asarray(e).dtype == bool else [int(k) for k in e]
        ),
        "rows for none": lambda r, d, q, e: checked(r, d, q, e) if len(e) else None,
        "a further axis": lambda r, d, q, e: checked(
            r, d, q[..., 0] if np.ndim(q) > 2 else q, e
        ),
        "sorted": lambda robot, dofs, q, envs: checked(robot, dofs, q, sorted(envs)),
        "numbers too high": partial(checked, known=range(9)),
        "negative numbers": lambda r, d, q, e: checked(
            r, d, q, e, range(-9, r.scene.n_envs)
        ),
        "named twice": partial(checked, twice=True),
        "columns not looked at": partial(checked, axes=1),
        "zeros to the others": partial(
            checked, change=lambda q, e, n: (np.eye(n)[:, e] @ q, range(n))
        ),
        "a mask": partial(checked, change=lambda q, e, n: (q, np.isin(range(n), e))),
        "whole positions": lambda r, d, q, envs: checked(
            r, d, np.asarray(q).astype(int), envs
        ),
        "always four": partial(checked, known=range(4)),
        "any shape of its size": lambda r, d, q, e: checked(
            r, d, np.reshape(q, (len(e), -1)), e
        ),
        "a row without its axis": lambda r, d, q, envs: checked(
            r, d, np.atleast_2d(q), envs
        ),
    },
    "throughput": {
        "right": timed,
        "without both ends": partial(
            timed, middle=lambda t: np.mean(sorted(t)[1:-1] or t)
        ),
        "upper of both": partial(
            timed, middle=lambda times: sorted(times)[len(times) // 2]
        ),
        "queue before the clock": partial(timed, before=False),
        "queue after the clock": partial(timed, after=False),
        "no warm-up": partial(timed, warm=False),
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_the_right_solution_passes(name, how):
    check = getattr(exercises, name)(CASES[name][how])
    assert check.passed == how.startswith("right"), check.detail
