"""Robots that are not the Franka: two hand-written arms, and a quadruped of the engine."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from robot_runs import driven

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.lessons.l01 import spec
from robo_genesis.sim.arm import dynamics, laws
from robo_genesis.sim.arm import engine_kinematics as engine
from robo_genesis.sim.arm.joint_control import ControlCase, run_case
from robo_genesis.sim.arm.joints import describe, resolve_joints
from robo_genesis.sim.arm.model import ModelError, RobotModel, model_file
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

MJCF = """<mujoco>
  <include file="parts/tool.xml"/>
  <default><joint armature="0.02" damping="0.5"/></default>
  <option gravity="0 0 0"/>
  <worldbody><body name="base" pos="2 0 0.1">
    <geom type="box" size="0.1 0.1 0.05"/>
    <body name="upper" pos="0 0 0.1" euler="20 0 0">
      <joint name="turn" axis="0 0 1" range="-90 90" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04"/>
      <body name="fore" pos="0.4 0 0">
        <joint name="lift" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
        <body name="tool" pos="0.3 0 0" quat="0 1 0 0">
          <joint name="push" type="slide" axis="1 0 0" range="0 0.2" limited="true"/>
          <geom type="mesh" mesh="tool" mass="0.5"/>
  </body></body></body></body></worldbody>
</mujoco>"""
TOOL = '<mujoco><asset><mesh name="tool" file="tool.obj"/></asset></mujoco>'
MESH = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
URDF = """<robot name="arm">
  <link name="base"/>
  <joint name="swing" type="continuous">
    <parent link="base"/><child link="boom"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.3" rpy="0.3 0 3.1"/><dynamics damping="0.4"/>
  </joint>
  <link name="boom"><inertial><origin xyz="0.1 0 0"/><mass value="3"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="reach" type="prismatic">
    <parent link="boom"/><child link="rod"/><axis xyz="1 0 0"/>
    <origin xyz="0.2 0 0" rpy="0 1.2 -2.5"/><limit lower="0" upper="0.3" effort="90" velocity="1"/>
  </joint>
  <link name="rod"><inertial><mass value="1"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="weld" type="fixed"><parent link="rod"/><child link="plate"/></joint>
  <link name="plate"/>
</robot>"""
# An actuator, shapes with and without a mesh, and whatever can refer to them.
WIRED = """<mujoco>
  <asset><mesh name="tool" file="parts/tool.obj"/></asset>
  <worldbody>
    <site name="wall" pos="0 0 1"/>
    <body name="boom">
      <joint name="swing"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <geom name="drum" type="cylinder" size="0.1 0.1"/>
      <geom name="cover" type="mesh" mesh="tool"/>
      <site name="end" pos="1 0 0"/>
    </body>
  </worldbody>
  <tendon><spatial>
    <site site="wall"/><geom geom="drum"/><site site="end"/>
  </spatial></tendon>
  <actuator><motor name="motor" joint="swing"/></actuator>
  <contact><pair geom1="drum" geom2="cover"/></contact>
  <sensor>
    <actuatorfrc actuator="motor"/><framepos objtype="geom" objname="cover"/>
  </sensor>
  <custom><tuple name="all">
    <element objtype="geom" objname="cover" prm="0"/>
  </tuple></custom>
</mujoco>"""
XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm"><joint name="swing"/></xacro:macro>
  <link name="base"/>
</robot>"""
FILES = {
    "arm.xml": MJCF,
    "wired.xml": WIRED,
    "xacro.urdf": XACRO,
    "arm.xacro": XACRO,
    "arm.urdf": URDF,
    "parts/tool.xml": TOOL,
    "parts/tool.obj": MESH,
}

LEGS = [
    f"{at}_{of}_joint"
    for at in ("FL", "FR", "RL", "RR")
    for of in ("hip", "thigh", "calf")
]


def case_of(model, *q_start):
    """Return a case in which each joint moves by 0.1 rad or m; `effort_limit` bounds some."""
    start, gain = np.array(q_start), np.full(len(q_start), 400.0)
    gains = {"kp": gain, "kv": gain / 10, "effort_limit": gain / 12}
    return ControlCase(
        model=model, q_start=start, q_target=start + 0.1, steps=20, **gains
    )


SLIDER = case_of(
    RobotModel("arm.xml", ("turn", "lift", "push"), hand="tool"), 0.2, -0.4, 0.05
)
CRANE = case_of(RobotModel("arm.urdf", ("swing", "reach"), hand="rod"), 0.5, 0.1)
GO2 = RobotModel("urdf/go2/urdf/go2.urdf", tuple(LEGS), free_base=True)
DOG = case_of(GO2, *(0.0, 0.8, -1.5) * 4)
MOTORS = {
    name: getattr(CRANE, name) * [0.0, 1.0] for name in ("kp", "kv", "effort_limit")
}
PASSIVE = replace(CRANE, **MOTORS)  # its first joint has no motor
ARMS = pytest.mark.parametrize("case", [SLIDER, CRANE], ids=["MJCF", "URDF"])


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    """Both arms, in a folder that takes the place of a lesson's."""
    place = tmp_path_factory.mktemp("lesson")
    (place / "parts").mkdir()
    for name, text in FILES.items():
        (place / name).write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mujoco_kinematics, "model_file", lambda name: str(place / name))
        yield place


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("lessons/l01/arm.xml", "The package robo_genesis"),
        ("arm.xml", "genesis-world"),
    ],
)
def test_a_model_lies_in_a_lesson_or_among_the_assets_of_the_engine(name, owner):
    assert Path(model_file("lessons/l01/spec.py")) == Path(spec.__file__)
    with pytest.raises(
        ModelError, match=f"{owner}.* has no model '{name}'. .*models .*/lNN"
    ):
        model_file(name)


@pytest.mark.parametrize(
    "case", [SLIDER, CRANE, PASSIVE], ids=["MJCF", "URDF", "passive"]
)
def test_a_run_of_any_arm_obeys_the_laws_of_its_own_model(folder, case):
    robot = mujoco_kinematics.bare_robot(of=case.model)[0]
    links = [robot.body(k).name for k in range(robot.nbody)]
    run = driven(case, links)
    for trace in (run, mujoco_joints.run_case(case, links, 0.005)):
        assert [*laws.driven_run(trace, case, links)] == []
    other = next(one for one in (SLIDER, CRANE) if one != case)
    with pytest.raises((ValueError, KeyError)):
        [*laws.driven_run(run, other, links)]


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (
            "arm.xml",
            'name="push"',
            "",
            "arm.xml has the joints turn, lift, , and",
        ),
        (
            "arm.xml",
            '"lift"',
            '"elbow"',
            "elbow, push, and .* its RobotModel names turn, lift, push, and",
        ),
        ("arm.urdf", '<mass value="1"/>', "", "MuJoCo cannot read .*arm.urdf"),
    ],
)
def test_a_model_that_is_not_as_it_is_declared_is_named(
    folder, file, old, new, message
):
    model = next(one.model for one in (SLIDER, CRANE) if one.model.file == file)
    assert old in FILES[file] + TOOL
    name = f"changed-{abs(hash(new))}-{file}"
    (folder / name).write_text(FILES[file].replace(old, new))
    with pytest.raises(ModelError, match=message):
        mujoco_kinematics.bare_robot(of=replace(model, file=name))


def test_what_is_left_out_leaves_no_reference():
    model, *_ = mujoco_kinematics.bare_robot(
        of=RobotModel("wired.xml", ("swing",), hand="boom")
    )
    assert (model.ntendon, model.nu, model.nsensor, model.nmesh) == (1, 0, 0, 0)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"file": "xacro.urdf"},
            r"has the joints \(none\), .* xacro file has to become",
        ),
        ({"file": "arm.xacro"}, "cannot read .*xacro file has to become a URDF first"),
        ({"hand": "tol"}, "links world, base, upper, fore, tool; .*the hand 'tol'"),
    ],
)
def test_a_xacro_file_and_a_misspelt_hand_are_named(changed, message):
    with pytest.raises(ModelError, match=message):
        mujoco_kinematics.bare_robot(of=replace(SLIDER.model, **changed))


@pytest.fixture(scope="module")
def robots(real_engine, folder):
    """Scene and robots in it, far from one another: both arms, one of them twice, and the dog."""
    gs = real_engine.gs
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False
    )
    scene.add_entity(gs.morphs.Plane())
    mjcf, urdf = str(folder / "arm.xml"), str(folder / "arm.urdf")
    morphs = {
        SLIDER.model: gs.morphs.MJCF(file=mjcf, default_armature=None),
        CRANE.model: gs.morphs.URDF(file=urdf, default_armature=None, fixed=True),
        DOG.model: gs.morphs.URDF(file=DOG.model.file, pos=(-3, 0, 1), collision=False),
        "heavier joints": gs.morphs.URDF(file=urdf, pos=(0, 3, 0), fixed=True),
    }
    found = {name: scene.add_entity(morph) for name, morph in morphs.items()}
    scene.build()
    return SimpleNamespace(scene=scene, of=found)


@pytest.mark.engine
@ARMS
def test_any_arm_is_the_same_in_both_engines(robots, case):
    of, robot = case.model, robots.of[case.model]
    page = SimpleNamespace(readings={})
    joints = describe(page, robot, of)
    trace = run_case(robots.scene, robot, joints, case)
    assert [*laws.driven_run(trace, case, page.links)] == []
    dofs, hand = joints.dofs, robot.get_link(of.hand)
    robot.set_dofs_position(case.q_start.copy(), dofs, zero_velocity=True)
    position, quat = (
        value.cpu().numpy() for value in (hand.get_pos(), hand.get_quat())
    )
    expected = mujoco_kinematics.link_poses(case.q_start[None], [of.hand], of)
    assert position == pytest.approx(expected.position[0, 0], abs=1e-6)
    one = engine.IkSettings(samples=1)
    answer = engine.solve_ik(robot, joints, position, quat, case.q_start, one, of=of)
    command = engine.accepted_command(answer, engine.IkSettings(), case.q_start, of)
    assert command == pytest.approx(case.q_start, abs=1e-3)
    assert engine.tip_height(answer.q, of) == pytest.approx(position[2], abs=1e-4)
    inertia, gravity, _ = mujoco_kinematics.at_rest(case.q_start, of=of)
    scene = robots.scene, robot, joints
    assert dynamics.gravity_effort(*scene, case.q_start) == pytest.approx(
        gravity, abs=1e-2
    )
    assert dynamics.effective_inertia(*scene, case.q_start) == pytest.approx(
        inertia, rel=1e-3
    )
    robot.set_dofs_position(case.q_start.copy(), dofs)
    robots.scene.step()
    q = robot.get_dofs_position(dofs).cpu().numpy().astype(float)
    rows = mujoco_kinematics.jacobian(q, of)
    assert engine.jacobian(robot, joints, of.hand) == pytest.approx(rows, abs=1e-5)


@pytest.mark.engine
def test_a_quadruped_drives_its_legs_and_what_needs_a_fixed_base_says_so(robots):
    of, robot, page = DOG.model, robots.of[DOG.model], SimpleNamespace(readings={})
    joints = describe(page, robot, of)
    assert page.readings["model"] == {"links": 13, "joints": 13, "dofs": 18, "qpos": 19}
    trace = run_case(robots.scene, robot, joints, DOG)
    assert [*laws.driven_run(trace, DOG, page.links)] == []
    hand, asked = replace(of, hand="base"), [DOG.q_start] * 3
    for refused, message in (
        (
            lambda: mujoco_kinematics.jacobian(DOG.q_start, hand),
            "a base that moves freely",
        ),
        (
            lambda: describe(page, robot, replace(of, free_base=False)),
            "moves by .*'FREE'",
        ),
        (
            lambda: engine.solve_ik(robot, joints, *asked, engine.IkSettings()),
            "The robot has 18 DOFs, the map 12",
        ),
    ):
        with pytest.raises(ModelError, match=message):
            refused()


@pytest.mark.engine
def test_what_the_engine_adds_to_a_model_is_named(robots):
    robot, page = robots.of["heavier joints"], SimpleNamespace(readings={})
    with pytest.raises(
        ModelError, match=r"armature of swing, reach is \[0.1 0.1\] in the engine"
    ):
        describe(page, robot, CRANE.model)
    with pytest.raises(ModelError, match="declare a free base with free_base=True"):
        describe(page, robot, replace(CRANE.model, free_base=True))
    part = resolve_joints(robot, ["swing"])
    with pytest.raises(ModelError, match="The robot has 2 DOFs, the map 1"):
        dynamics.let_go(robots.scene, robot, part, np.zeros(1))
