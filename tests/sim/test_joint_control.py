from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.core.scene import JOINT_NAMES
from robo_genesis.lessons.l04.spec import BASELINE, CASES, G1, G2
from robo_genesis.sim.joint_control import (
    CaseError,
    ControlCase,
    differences,
    reset,
    run_case,
    validate,
)

ARRAYS = ("q_start", "q_target", "kp", "kv", "effort_limit")
GAINS = ("kp", "kv", "effort_limit")
N = len(JOINT_NAMES)


def with_value(case, name, k, value):
    values = np.array(getattr(case, name))
    values[k] = value
    return replace(case, **{name: values})


class FakeRobot:
    """Counts steps into what it measures; it keeps what is set, as the engine does."""

    def __init__(self):
        self.calls = []
        self.steps = 0
        self.q = np.zeros(N)
        self.set = {}

    def step(self):
        self.calls.append("step")
        self.steps += 1

    def reset(self):
        self.calls.append("reset")
        self.steps = 0

    def set_dofs_kp(self, values, dofs):
        self.calls.append("kp")
        self.set["kp"] = values

    def set_dofs_kv(self, values, dofs):
        self.calls.append("kv")
        self.set["kv"] = values

    def set_dofs_force_range(self, lower, upper, dofs):
        self.calls.append("range")
        self.set["range"] = (lower, upper)

    def set_dofs_position(self, values, dofs, zero_velocity):
        self.calls.append("position")
        self.q = values

    def control_dofs_position(self, values, dofs):
        self.calls.append("target")

    def get_dofs_kp(self, dofs):
        return self.set["kp"]

    def get_dofs_kv(self, dofs):
        return self.set["kv"]

    def get_dofs_force_range(self, dofs):
        return self.set["range"]

    def get_dofs_position(self, dofs):
        return self.q + self.steps

    def get_dofs_velocity(self, dofs):
        return np.full(N, self.steps)

    def get_dofs_control_force(self, dofs):
        return np.full(N, 10 * self.steps)

    def get_dofs_force(self, dofs):
        return np.full(N, 100 * self.steps)

    def get_links_pos(self):
        return np.full((2, 3), self.steps)

    def get_links_quat(self):
        return np.full((2, 4), self.steps)


@pytest.fixture
def robot():
    return FakeRobot()


@pytest.fixture
def scene(robot):
    scene = SimpleNamespace(is_built=True, dt=0.01, substeps=2, t=0, reset=robot.reset)

    def step():
        scene.t += 1
        robot.step()

    scene.step = step
    return scene


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_the_lessons_cases_are_valid(joints, case):
    validate(case, joints)


@pytest.mark.parametrize("values", [np.ones(7), np.ones(10), np.ones((1, 9)), 1.0])
@pytest.mark.parametrize("name", ARRAYS)
def test_a_wrong_shape_is_refused_and_not_broadcast(joints, name, values):
    with pytest.raises(CaseError) as caught:
        validate(replace(BASELINE, **{name: values}), joints)
    assert f"{name} has shape {np.shape(values)}, expected (9,)" in str(caught.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ARRAYS)
def test_a_value_that_is_not_finite_is_refused(joints, name, value):
    with pytest.raises(CaseError, match=rf"{name}\[joint3\] is {value}, expected a finite"):
        validate(with_value(BASELINE, name, 2, value), joints)


@pytest.mark.parametrize(
    ("k", "value", "told"),
    [
        (3, 0.0, r"\[joint4\] is 0 rad, outside its range \[-3.0718, -0.0698\]"),
        (3, -3.1, r"\[joint4\] is -3.1 rad, outside its range \[-3.0718, -0.0698\]"),
        (8, 0.05, r"\[finger_joint2\] is 0.05 m, outside its range \[0, 0.04\]"),
    ],
)
@pytest.mark.parametrize("name", ["q_start", "q_target"])
def test_a_position_outside_its_limits_is_refused(joints, name, k, value, told):
    with pytest.raises(CaseError, match=name + told):
        validate(with_value(BASELINE, name, k, value), joints)


def test_a_position_outside_its_limits_is_not_clipped(scene, robot, joints):
    case = with_value(BASELINE, "q_target", 3, 0.0)
    with pytest.raises(CaseError, match="none is clipped"):
        run_case(scene, robot, joints, case)
    assert case.q_target[3] == 0.0
    assert robot.calls == []


@pytest.mark.parametrize(("beyond", "refused"), [(5e-7, False), (5e-6, True)])
def test_limits_leave_room_for_float32_only(joints, beyond, refused):
    case = with_value(BASELINE, "q_start", 0, joints.upper[0] + beyond)
    if refused:
        with pytest.raises(CaseError, match="outside its range"):
            validate(case, joints)
    else:
        validate(case, joints)


@pytest.mark.parametrize("name", GAINS)
def test_negative_gains_and_limits_are_refused(joints, name):
    with pytest.raises(CaseError, match=rf"{name}\[joint1\] is -1.0, expected zero or more"):
        validate(with_value(BASELINE, name, 0, -1.0), joints)


@pytest.mark.parametrize("name", GAINS)
def test_zero_gains_are_valid(joints, name):
    validate(with_value(BASELINE, name, 0, 0.0), joints)


@pytest.mark.parametrize(
    "change",
    [{"steps": 0}, {"steps": -1}, {"dt": 0.0}, {"dt": -0.01}, {"dt": np.nan}, {"substeps": 0}],
    ids=str,
)
def test_counts_and_time_step_are_positive(joints, change):
    with pytest.raises(CaseError, match="must be positive"):
        validate(replace(BASELINE, **change), joints)


def test_equal_cases_have_no_differences(joints):
    assert differences(G1, replace(G1, kp=G1.kp.copy()), joints) == []


@pytest.mark.parametrize("name", ARRAYS)
def test_differences_name_field_and_joint(joints, name):
    other = with_value(with_value(BASELINE, name, 0, 9.0), name, 7, 9.0)
    assert differences(BASELINE, other, joints) == [f"{name}[joint1]", f"{name}[finger_joint1]"]


@pytest.mark.parametrize("change", [{"steps": 7}, {"dt": 0.5}, {"substeps": 5}, {"seed": 1}])
def test_differences_name_scalars(joints, change):
    assert differences(BASELINE, replace(BASELINE, **change), joints) == list(change)


def test_differences_name_several_fields_at_once(joints):
    other = replace(with_value(G2, "kv", 3, 1.0), steps=3)
    assert differences(G1, other, joints) == ["kp[joint4]", "kv[joint4]", "steps"]


def test_every_field_of_a_case_is_compared(joints):
    other = ControlCase(*(np.full(N, -1.0) for _ in ARRAYS), steps=1, dt=1.0, substeps=1, seed=1)
    named = {entry.split("[")[0] for entry in differences(BASELINE, other, joints)}
    assert named == set(ControlCase.__dataclass_fields__)


def test_a_scene_that_is_not_built_is_refused(robot, joints):
    with pytest.raises(CaseError, match=r"not built: call scene.build\(\)"):
        run_case(SimpleNamespace(is_built=False), robot, joints, BASELINE)
    assert robot.calls == []


@pytest.mark.parametrize("change", [{"dt": 0.02}, {"substeps": 20}])
def test_a_scene_of_another_time_step_is_refused(scene, robot, joints, change):
    with pytest.raises(CaseError, match="Restart and build"):
        reset(scene, robot, joints, replace(BASELINE, **change))
    assert robot.calls == []


def test_reset_clears_first_and_assigns_the_start_last(scene, robot, joints):
    reset(scene, robot, joints, BASELINE)
    assert robot.calls == ["reset", "kp", "kv", "range", "position"]
    assert robot.set["range"][0].tolist() == (-BASELINE.effort_limit).tolist()


def test_reset_leaves_the_case_to_its_owner(scene, robot, joints):
    reset(scene, robot, joints, BASELINE)
    handed = (robot.q, *robot.set["range"], robot.set["kp"], robot.set["kv"])
    own = [getattr(BASELINE, name) for name in ARRAYS]
    assert not any(np.shares_memory(a, b) for a in handed for b in own)


@pytest.mark.parametrize(
    ("getter", "value", "name"),
    [
        ("get_dofs_kp", np.ones(N), "kp"),
        ("get_dofs_kv", np.ones(N), "kv"),
        ("get_dofs_force_range", (-BASELINE.effort_limit, np.ones(N)), "effort_limit"),
        ("get_dofs_force_range", (-np.ones(N), BASELINE.effort_limit), "-effort_limit"),
        ("get_dofs_position", np.zeros(N), "q_start"),
        ("get_dofs_velocity", np.ones(N), "velocity"),
    ],
)
def test_what_reads_back_differently_is_named(scene, robot, joints, getter, value, name):
    setattr(robot, getter, lambda dofs: value)
    with pytest.raises(CaseError, match=f"^{name} reads back"):
        reset(scene, robot, joints, BASELINE)


def test_the_target_is_commanded_before_every_step(scene, robot, joints):
    run_case(scene, robot, joints, replace(BASELINE, steps=3))
    assert robot.calls[5:] == ["target", *["target", "step"] * 3]


def test_states_carry_their_own_stamps(scene, robot, joints):
    trace = run_case(scene, robot, joints, replace(BASELINE, steps=3))
    assert trace.t.tolist() == [0, 0.01, 0.02, 0.03]
    assert (trace.q[:, 0] - trace.q[0, 0]).tolist() == [0, 1, 2, 3]
    assert trace.link_pos[:, 0, 0].tolist() == [0, 1, 2, 3]
    assert trace.link_quat[:, 0, 0].tolist() == [0, 1, 2, 3]


def test_velocity_and_forces_are_those_after_each_step(scene, robot, joints):
    trace = run_case(scene, robot, joints, replace(BASELINE, steps=3))
    assert trace.qd[:, 0].tolist() == [1, 2, 3]
    assert trace.control_force[:, 0].tolist() == [10, 20, 30]
    assert trace.internal_force[:, 0].tolist() == [100, 200, 300]
    assert (trace.start_qd == 0).all()
    assert (trace.start_control_force == 0).all()


def test_the_recorded_limit_is_the_one_read_back(scene, robot, joints):
    trace = run_case(scene, robot, joints, replace(BASELINE, steps=1))
    assert trace.effort_limit.tolist() == BASELINE.effort_limit.tolist()
    assert (trace.target == BASELINE.q_target).all()
