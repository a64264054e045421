"""Each failure shows its symptom on the real engine, and is not found where nothing is wrong."""

import re
from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core import checks
from robo_genesis.core.exercises import Mistake
from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.lessons.l04 import mistakes, spec
from robo_genesis.lessons.l04.backend_mistake import absent_backend, absent_backend_failure
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.arm.joints import resolve_joints

JOINT = spec.STEPPED_JOINT
STAY = replace(spec.BASELINE, q_target=spec.BASELINE.q_start)
PAIR, AT_START = (spec.G2, spec.G3), replace(spec.G2, q_target=spec.G2.q_start)
BALL = """<mujoco><worldbody><body name="bob">
<joint name="ball" type="ball"/><geom type="sphere" size="0.05" pos="0 0 -0.3"/>
</body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def crowded(lab, tmp_path_factory):
    """A scene in which a pendulum's three DOFs come before the robot's."""
    path = tmp_path_factory.mktemp("models") / "ball.xml"
    path.write_text(BALL)
    gs = lab.gs
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS),
        rigid_options=gs.options.RigidOptions(enable_collision=False),
        show_viewer=False,
    )
    scene.add_entity(gs.morphs.MJCF(file=str(path), pos=(0, 2, 1)))
    franka = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    scene.build()
    return scene, franka, resolve_joints(franka, JOINT_NAMES)


@pytest.fixture(scope="module")
def fingers(crowded):
    """What the fingers of a robot do that nobody has set gains for."""
    return mistakes.fingers_without_gains(*crowded, spec.BASELINE, opening=0.02)


@pytest.fixture
def robot(lab):
    return lab.scene, lab.franka, lab.joints


@pytest.mark.engine
def test_fingers_close_whatever_is_commanded_until_gains_are_set(crowded, fingers):
    assert fingers.shown
    assert "ended at 0.0000 m before gains were set and at 0.0200 m" in fingers.evidence
    again = mistakes.fingers_without_gains(*crowded, spec.BASELINE, opening=0.02)
    assert not again.shown
    assert "ended at 0.0200 m before" in again.evidence


@pytest.mark.engine
def test_a_solver_level_index_moves_another_joint(crowded, fingers):
    found = mistakes.wrong_index(*crowded, spec.BASELINE, JOINT)
    assert found.shown
    assert "entity-local DOF 3 and the solver-level DOF 6" in found.evidence
    assert "`joint7` moved most" in found.evidence
    assert abs(np.ptp(found.curves["joint7, moved most"][1])) > 1
    assert abs(np.ptp(found.curves["joint4, meant"][1])) < 0.1


@pytest.mark.engine
@pytest.mark.parametrize(
    ("mistake", "args", "shown", "says"),
    [
        (mistakes.wrong_index, (spec.BASELINE, JOINT), False, [f"`{JOINT}` moved most"]),
        (mistakes.assigned_each_step, (spec.BASELINE, JOINT), True, ["would have needed 24.8"]),
        (mistakes.assigned_each_step, (STAY, JOINT), False, []),
        (mistakes.stale_target, (spec.BASELINE, JOINT), True, ["in 120 steps. After a complete"]),
        (mistakes.stale_target, (STAY, JOINT), False, []),
        (mistakes.gains_without_reset, (PAIR, JOINT), True, ["instead of 0.2500 rad"]),
        (mistakes.gains_without_reset, ((AT_START, spec.G3), JOINT), False, []),
        (mistakes.past_a_limit, (spec.BASELINE, JOINT, 0.5), True,
         ["CaseError`: q_target[joint4]", "none is clipped"]),
        (mistakes.past_a_limit, (spec.BASELINE, JOINT, -1.0), False, ["No exception was raised."]),
        (mistakes.lengths_differ, (spec.BASELINE, JOINT), True,
         ["`GenesisException`: Invalid input shape: (7,)", "`joint1`",
          "One value for nine joints: No exception was raised.",
          "CaseError`: q_target has shape (1,)"]),
    ],
)  # fmt: skip
def test_a_symptom_is_found_where_it_appears_and_nowhere_else(robot, mistake, args, shown, says):
    found = mistake(*robot, *args)
    assert found.shown == shown
    assert [phrase for phrase in says if phrase not in found.evidence] == []


@pytest.mark.engine
def test_an_absent_backend_raises_by_name_and_falls_back_in_general(lab):
    found = absent_backend(lab.engine.backend.hip_version)
    assert found.shown
    assert "`GenesisException`: Backend <gs.amdgpu> not available" in found.evidence
    assert "warnings (1): Backend <gs.gpu> not available" in found.evidence


GONE = ["GenesisException", "Backend ~~<gs.cuda>~~ not available on this machine."]
FALLS = ["WARNING", "Backend ~~<gs.gpu>~~ not available on this machine. Falling back to CPU."]


@pytest.mark.parametrize(
    ("answer", "shown", "words"),
    [
        ((GONE, "cpu", [FALLS]), True, "Backend <gs.cuda> not available"),
        ((GONE, "amdgpu", []), True, "started on `amdgpu`; its warnings (0): none"),
        ((GONE, "cpu", []), False, "its warnings (0): none"),
        ((GONE, "cpu", [FALLS, FALLS]), False, "its warnings (2)"),
        ((["ValueError", "not available"], "cpu", [FALLS]), False, "`ValueError`"),
        ((None, None, []), False, "`gs.init(backend=gs.cuda)` raised nothing."),
    ],
)
def test_an_absent_backend_is_shown_where_it_raises_and_falls_back(answer, shown, words):
    found = absent_backend_failure("cuda", *answer)
    assert found.shown is shown
    assert words in found.evidence
    assert "~" not in found.evidence


def test_the_net_force_at_rest_is_no_motor_torque(joints, traces):
    still = traces["G1"]
    net = np.zeros_like(still.internal_force)
    control = np.full_like(still.control_force, -22.5)
    found = mistakes.wrong_getter(
        replace(still, internal_force=net, control_force=control), joints, JOINT
    )
    assert found.shown
    assert "`get_dofs_force` is 0.00 N·m" in found.evidence
    assert "`get_dofs_control_force` is -22.50 N·m" in found.evidence
    moving = replace(still, internal_force=control, control_force=control)
    assert not mistakes.wrong_getter(moving, joints, JOINT).shown


def test_a_shift_by_one_sample_shifts_both_times_by_dt(joints, traces):
    trace = traces["G1"]
    found = mistakes.time_shift(trace, joints, JOINT)
    assert found.shown
    assert re.search(r"give rise time 0\.\d\d s instead of 0\.\d\d s and", found.evidence)
    unobserved = replace(trace, q=np.tile(trace.q[0], (len(trace.t), 1)))
    found = mistakes.time_shift(unobserved, joints, JOINT)
    assert not found.shown
    assert "rise time not observed instead of not observed" in found.evidence


def test_a_symptom_that_did_not_appear_fails_by_name():
    outcome = Mistake("time_shift", False, "Both are equal.").check
    with pytest.raises(checks.CheckFailed, match=r"\[gallery_time_shift\] Both are equal\."):
        checks.require("l04 gallery", [outcome])
