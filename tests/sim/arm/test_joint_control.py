"""Control cases are validated and never changed; what the engine reads back is compared."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04.spec import BASELINE, G1, G2
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import differences, reset, run_case, validate
from robo_genesis.sim.session import CaseError

ARRAYS = ("q_start", "q_target", "kp", "kv", "effort_limit")
N = len(JOINT_NAMES)


def value(name, k, number):
    """A change of one entry of one array of the baseline."""
    values = np.array(getattr(BASELINE, name))
    values[k] = number
    return {name: values}


def setter(name):
    def keep(robot, *values, **options):
        robot.calls.append(name)
        *kept, _ = values  # without the DOFs
        robot.kept[name] = kept[0] if len(kept) == 1 else tuple(kept)

    return keep


def kept(name):
    return lambda robot, dofs: robot.kept[name]


class FakeRobot:
    """Robot and scene in one: it keeps what is set, as the engine does."""

    is_built, dt, substeps = True, 0.01, 2

    def __init__(self):
        self.calls, self.kept = [], {}

    def reset(self):
        self.calls.append("reset")

    set_dofs_kp, set_dofs_kv = setter("kp"), setter("kv")
    set_dofs_force_range, set_dofs_position = setter("range"), setter("position")
    get_dofs_kp, get_dofs_kv = kept("kp"), kept("kv")
    get_dofs_force_range, get_dofs_position = kept("range"), kept("position")

    def get_dofs_velocity(self, dofs):
        return np.zeros(len(dofs))


@pytest.fixture
def robot():
    return FakeRobot()


def test_a_limit_of_float32_and_gains_of_zero_are_valid(joints):
    validate(replace(BASELINE, **value("q_start", 0, 2.8973 + 5e-7)), joints)
    validate(
        replace(BASELINE, kp=np.zeros(N), kv=np.zeros(N), effort_limit=np.zeros(N)),
        joints,
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"q_target": np.ones(7)}, "q_target has shape (7,), expected (9,)"),
        ({"kp": 1.0}, "kp has shape (), expected (9,)"),
        (value("kv", 2, np.nan), "kv[joint3] is nan"),
        (value("kp", 0, -1.0), "kp[joint1] is -1, outside its range [0, inf]"),
        (
            value("q_target", 8, 0.05),
            "finger_joint2] is 0.05 m, outside its range [0, 0.04]",
        ),
        (value("q_target", 0, 2.8973 + 5e-6), "none is clipped"),
    ],
)
def test_an_invalid_case_is_refused_with_entry_and_range(joints, change, message):
    with pytest.raises(CaseError) as caught:
        validate(replace(BASELINE, **change), joints)
    assert message in str(caught.value)


def test_differences_name_every_field_and_joint_that_differs_and_no_other(joints):
    assert differences(G1, replace(G1, kp=G1.kp.copy()), joints) == []
    other = replace(G2, kv=G2.kv + np.isin(np.arange(N), (3, 7)), steps=3)
    named = ["kp[joint4]", "kv[joint4]", "kv[finger_joint1]", "steps"]
    assert differences(G1, other, joints) == named


@pytest.mark.parametrize(
    ("scene", "case", "message"),
    [
        ({"dt": 0.02}, {}, "Restart and build"),
        ({"substeps": 20}, {}, "Restart and build"),
        ({}, value("q_target", 3, 0.0), "none is clipped"),
    ],
)
def test_what_does_not_fit_is_refused_before_the_engine_moves(
    robot, joints, scene, case, message
):
    vars(robot).update(scene)
    with pytest.raises(CaseError, match=message):
        run_case(robot, robot, joints, replace(BASELINE, **case))
    assert robot.calls == []


def test_reset_clears_first_assigns_the_start_last_and_leaves_the_case_alone(
    robot, joints
):
    reset(robot, robot, joints, BASELINE)
    assert robot.calls == ["reset", "kp", "kv", "range", "position"]
    given = (
        robot.kept["position"],
        *robot.kept["range"],
        robot.kept["kp"],
        robot.kept["kv"],
    )
    own = [getattr(BASELINE, name) for name in ARRAYS]
    assert not any(np.shares_memory(a, b) for a in given for b in own)


@pytest.mark.parametrize(
    ("getter", "found", "name"),
    [
        ("get_dofs_kp", np.ones(N), "kp"),
        ("get_dofs_force_range", (-np.ones(N), BASELINE.effort_limit), "-effort_limit"),
        ("get_dofs_velocity", np.ones(N), "velocity"),
    ],
)
def test_what_reads_back_differently_is_named(robot, joints, getter, found, name):
    setattr(robot, getter, lambda dofs: found)
    with pytest.raises(CaseError, match=f"^{name} reads back"):
        reset(robot, robot, joints, BASELINE)
