"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

from types import SimpleNamespace

import pytest
from lessons.exercise_cells import undetected

from robo_genesis.lessons.l04 import exercises, spec


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


def recorded(record, joints, trace):
    """Test a control loop with the playback from its start."""
    played = Playback(trace)
    return exercises.control_loop(record, played, played, joints, spec.BASELINE, trace)


MISTAKES = {  # by function, what is replaced in our solution, and what replaces it
    "resolve": {
        "joint.dofs_idx_local": ["[len(dofs)]"],  # typed indices
        "(joint.n_dofs, joint.n_qs) != (1, 1)": ["joint.n_dofs != 1"],
        "return dofs": ["return sorted(dofs)"],
    },
    "record": {
        "* DT": ["* DT / 2"],
        "[read(robot.get_dofs_position)]": ["[]"],
        "robot.get_dofs_control_force": ["robot.get_dofs_force"],
        "range(steps)": ["range(steps - 1)"],
    },
    "pd_effort": {
        "max(-limit, min(limit, kp * error - kv * qd))": [
            "min(limit, kp * error - kv * qd)"
        ],
        "- kv * qd": ["+ kv * qd"],
    },
    "measure": {
        "else None": ["else t[-1]"],
        "outside[-1] + 1": ["len(outside)"],  # as if the response stayed in the band
        "max(0.0, (q - q_target).max())": ["(q - q_target).max()"],
        "t[risen[0]]": ["t[risen[0] + 1]"],
    },
    "stepped": {
        "max(-limit, min(limit, -kp * q - kv * qd))": ["-kp * q - kv * qd"],
        "- g)": ["+ g)"],
        "path = [q]": ["path = []"],
    },
}


@pytest.mark.parametrize("name", MISTAKES)
def test_each_mistake_is_found(experiment, name):
    joints, traces = experiment.joints, experiment.traces
    dofs = dict(zip(joints.names, joints.dofs, strict=True))
    robot = SimpleNamespace(get_joint=lambda name: exercises._joint(dofs[name]))
    test, *given = {
        "resolve": (exercises.resolver, robot, joints),
        "record": (recorded, joints, traces["baseline"]),
        "pd_effort": (
            exercises.pd_law,
            [(traces[n], case) for n, case in spec.CASES.items()],
        ),
        "measure": (
            exercises.step_response,
            [(traces[n], experiment.metrics[n]) for n in spec.CASES],
        ),
        "stepped": (exercises.stepped,),
    }[name]
    page = "formula" if name == "stepped" else "lab"
    assert undetected(test, MISTAKES[name], "l04", name, *given, page=page) == []
