"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l04 import exercises, spec

SOLVED = solutions("l04") | solutions("l04", "formula")
RECORD = SOLVED["record"]


class Playback:
    """Scene and robot whose getters play a recorded run."""

    def __init__(self, trace):
        self.trace, self.now = trace, 0

    def step(self):
        self.now += 1

    def control_dofs_position(self, target, dofs):
        """Accept a command."""

    def __getattr__(self, getter):
        name = {
            "get_dofs_position": "q",
            "get_dofs_velocity": "qd",
            "get_dofs_force": "internal_force",
            "get_dofs_control_force": "control_force",
        }[getter]
        sample = max(0, self.now - (name != "q"))
        values = getattr(self.trace, name)[sample]
        tensor = SimpleNamespace(numpy=lambda: values)
        tensor.cpu = lambda: tensor
        return lambda dofs: tensor


def altered(k, change):
    """Return a loop that records one array otherwise."""

    def record(*given):
        found = list(RECORD(*given))
        found[k] = change(found[k])
        return found

    return record


def qpos_not_counted(robot, names):
    """Refuse a joint with several DOFs only."""
    joints = [robot.get_joint(name) for name in names]
    if any(joint.n_dofs != 1 for joint in joints) or len(set(names)) < len(names):
        raise ValueError(names)
    return [dof for joint in joints for dof in joint.dofs_idx_local]


def not_settled(t, q, target):
    """Take the first time in the band, without looking at what follows."""
    inside = np.flatnonzero(np.abs(q - target) <= 0.01)
    return *SOLVED["measure"](t, q, target)[:2], t[inside[0]] if inside.size else None


CASES = {  # of each exercise the right solution, then wrong ones
    "resolver": [
        SOLVED["resolve"],
        lambda robot, names: list(range(len(names))),  # typed indices
        qpos_not_counted,
        lambda robot, names: sorted(SOLVED["resolve"](robot, names)),
    ],
    "control_loop": [
        RECORD,
        altered(0, lambda t: t / 2),
        altered(1, lambda q: q[1:]),
        altered(3, lambda force: -force),
        lambda *given: RECORD(*given[:-1], given[-1] - 1),  # a command is missing
    ],
    "pd_law": [
        SOLVED["pd_effort"],
        lambda e, v, kp, kv, limit: min(limit, kp * e - kv * v),
        lambda e, v, *gains: SOLVED["pd_effort"](
            e, -v, *gains
        ),  # wrong sign of damping
    ],
    "step_response": [
        SOLVED["measure"],
        lambda *given: [
            given[0][-1] if v is None else v for v in SOLVED["measure"](*given)
        ],
        not_settled,
        lambda t, q, target: (1.0, (q - target).max(), None),  # signed overshoot
        lambda t, q, target: SOLVED["measure"](t + t[1], q, target),  # one sample late
    ],
    "stepped": [
        SOLVED["stepped"],
        lambda *given: SOLVED["stepped"](*given[:4], np.inf, *given[5:]),  # no limit
        lambda *given: SOLVED["stepped"](
            *given[:5], -given[5], *given[6:]
        ),  # gravity upwards
        lambda *given: SOLVED["stepped"](*given)[1:],  # start missing
    ],
}


@pytest.mark.parametrize(
    ("name", "k"), [(n, k) for n, of in CASES.items() for k in range(len(of))]
)
def test_only_the_right_solution_passes(experiment, name, k):
    joints, traces = experiment.joints, experiment.traces
    dofs = dict(zip(joints.names, joints.dofs, strict=True))
    robot = SimpleNamespace(get_joint=lambda name: exercises._joint(dofs[name]))
    playback = Playback(traces["baseline"])
    more = {
        "resolver": (robot, joints),
        "control_loop": (playback, playback, joints, spec.BASELINE, traces["baseline"]),
        "pd_law": ([(traces[n], case) for n, case in spec.CASES.items()],),
        "step_response": ([(traces[n], experiment.metrics[n]) for n in spec.CASES],),
    }
    check = getattr(exercises, name)(CASES[name][k], *more.get(name, ()))
    assert check.passed == (k == 0), check.detail
