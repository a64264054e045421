"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
from lessons.exercise_cells import require_exercise, solutions

from robo_genesis.lessons.l04 import exercises, spec

SOLVED = solutions("l04") | solutions("l04", "formula")


class Tensor:
    """An array with the methods that convert a tensor of Torch."""

    def __init__(self, values):
        self.values = np.asarray(values)

    def cpu(self):
        return self

    def numpy(self):
        return self.values


class Playback:
    """Scene and robot whose getters play a recorded run."""

    def __init__(self, trace):
        self.trace, self.now, self.commands = trace, 0, []

    def step(self):
        self.now += 1

    def control_dofs_position(self, target, dofs):
        self.commands.append(np.array(target))

    def get_dofs_position(self, dofs):
        return Tensor(self.trace.q[self.now])

    def get_dofs_velocity(self, dofs):
        return Tensor(self.trace.qd[max(0, self.now - 1)])

    def get_dofs_control_force(self, dofs):
        return Tensor(self.trace.control_force[max(0, self.now - 1)])

    def get_dofs_force(self, dofs):
        return Tensor(self.trace.internal_force[max(0, self.now - 1)])


def robot_of(joints):
    def get_joint(name):
        k = joints.names.index(name)
        return exercises._joint(int(joints.dofs_idx_local[k]))

    return SimpleNamespace(get_joint=get_joint)


def reset_and_record(steps, shift=0, dt=0.01, getter="get_dofs_control_force", once=False):
    """Return a loop with one mistake."""

    def record(scene, robot, dofs, q_target, n):
        q, qd, force = [], [], []
        if not shift:
            q.append(robot.get_dofs_position(dofs).numpy())
        for k in range(n + steps):
            if not (once and k):
                robot.control_dofs_position(q_target, dofs)
            scene.step()
            q.append(robot.get_dofs_position(dofs).numpy())
            qd.append(robot.get_dofs_velocity(dofs).numpy())
            force.append(getattr(robot, getter)(dofs).numpy())
        return np.arange(len(q)) * dt, np.stack(q), np.stack(qd), np.stack(force)

    return record


def qpos_not_counted(robot, names):
    """Refuse a joint with several DOFs only."""
    joints = [robot.get_joint(name) for name in names]
    for name, joint in zip(names, joints, strict=True):
        if joint.n_dofs != 1 or len(set(names)) < len(names):
            raise ValueError(name)
    return [dof for joint in joints for dof in joint.dofs_idx_local]


def other_exception(robot, names):
    """Refuse with an exception of another type."""
    try:
        return SOLVED["resolve"](robot, names)
    except ValueError as error:
        raise KeyError(*error.args) from error


def law(error, qd, kp, kv, limit):
    return SOLVED["pd_effort"](error, qd, kp, kv, limit)


def measured(t, q, target):
    return SOLVED["measure"](t, q, target)


def not_settled(t, q, target):
    """Take the first time in the band, without looking at what follows."""
    rise, overshoot, _ = measured(t, q, target)
    inside = np.flatnonzero(np.abs(q - target) <= 0.01)
    return rise, overshoot, t[inside[0]] if inside.size else None


WRONG = {
    "resolver": {
        "typed indices": lambda robot, names: list(range(len(names))),
        "solver-level": lambda robot, names: [robot.get_joint(n).dofs_idx[0] for n in names],
        "no refusal": lambda robot, names: [
            d for n in names for d in robot.get_joint(n).dofs_idx_local
        ],
        "another exception": other_exception,
        "qpos not counted": qpos_not_counted,
        "sorted": lambda robot, names: sorted(SOLVED["resolve"](robot, names)),
        "not written": lambda robot, names: (_ for _ in ()).throw(NotImplementedError("write it")),
    },
    "control_loop": {
        "first state missing": reset_and_record(0, shift=1),
        "one step less": reset_and_record(-1),
        "another time step": reset_and_record(0, dt=0.005),
        "commanded once": reset_and_record(0, once=True),
        "net force": reset_and_record(0, getter="get_dofs_force"),
    },
    "pd_law": {
        "not clipped": lambda e, v, kp, kv, limit: kp * e - kv * v,
        "upper limit alone": lambda e, v, kp, kv, limit: min(limit, kp * e - kv * v),
        "wrong sign of damping": lambda e, v, kp, kv, limit: law(e, -v, kp, kv, limit),
        "position for error": lambda e, v, kp, kv, limit: law(-e, v, kp, kv, limit),
    },
    "step_response": {
        "end of the window for not observed": lambda t, q, target: [
            t[-1] if value is None else value for value in measured(t, q, target)
        ],
        "first time in the band": not_settled,
        "signed overshoot": lambda t, q, target: (
            measured(t, q, target)[0], (q - target).max(), measured(t, q, target)[2]
        ),
        "90 % of the target": lambda t, q, target: (
            next((s for s, v in zip(t, q, strict=True) if v >= 0.9 * target), None),
            *measured(t, q, target)[1:],
        ),
        "one sample late": lambda t, q, target: measured(t + t[1], q, target),
    },
    "stepped": {
        "not clipped": lambda i, kp, kv, d, limit, *rest: (
            SOLVED["stepped"](i, kp, kv, d, np.inf, *rest)
        ),
        "explicit damping": lambda i, kp, kv, d, limit, g, step, h, n: SOLVED["stepped"](
            i - h * (d + kv), kp, kv, d, limit, g, step, h, n
        ),
        "gravity upwards": lambda i, kp, kv, d, limit, g, *rest: (
            SOLVED["stepped"](i, kp, kv, d, limit, -g, *rest)
        ),
        "start missing": lambda *given: SOLVED["stepped"](*given)[1:],
        "passive damping of the inertia alone": lambda i, kp, kv, d, limit, g, step, h, n: (
            SOLVED["stepped"](i + h * d, kp, kv, 0.0, limit, g, step, h, n)
        ),
    },
}  # fmt: skip
OURS = {"resolver": "resolve", "control_loop": "record", "pd_law": "pd_effort",
        "step_response": "measure", "stepped": "stepped"}  # fmt: skip


@pytest.fixture
def tested(study_runs):
    """Return the checks of one exercise for a function."""
    joints, trace = study_runs.joints, study_runs.traces["baseline"]

    def test(name, function):
        playback = Playback(trace)
        more = {
            "resolver": (robot_of(joints), joints),
            "control_loop": (playback, playback, joints, spec.BASELINE, trace),
            "pd_law": ([(study_runs.traces[n], case) for n, case in spec.CASES.items()],),
            "step_response": ([(study_runs.traces[n], study_runs.metrics[n]) for n in spec.CASES],),
            "stepped": (),
        }[name]
        return getattr(exercises, name)(function, *more)

    return test


@pytest.mark.parametrize("name", OURS)
def test_our_solution_passes(tested, name):
    (check,) = tested(name, SOLVED[OURS[name]])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_its_check_says_what_was_found(tested, name, how):
    (check,) = tested(name, WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail


def test_each_function_has_at_least_three_wrong_solutions():
    assert all(len(found) >= 3 for found in WRONG.values())
    assert WRONG.keys() == OURS.keys()


@pytest.mark.parametrize("name", OURS.values())
def test_the_student_writes_at_most_fifteen_lines_below_a_docstring(name):
    require_exercise("l04", name, "formula" if name == "stepped" else "lab")
