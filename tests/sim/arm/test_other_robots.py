"""Robots that are not the Franka: hand-written arms and a quadruped, in both engines."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from robot_runs import driven

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.sim.arm import dynamics, laws
from robo_genesis.sim.arm import engine_kinematics as engine
from robo_genesis.sim.arm.joint_control import ControlCase, describe, run_case
from robo_genesis.sim.arm.joints import ModelError, RobotModel
from robo_genesis.sim.mujoco import joints as mujoco_joints
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics
from robo_genesis.sim.session import model_file

MJCF = """
<mujoco>
  <include file="parts/tool.xml"/>
  <default><joint armature="0.02" damping="0.5"/></default>
  <option gravity="0 0 0"/>
  <worldbody>
    <body name="base" pos="2 0 0.1">
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
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
PARTS = '<mujoco><asset><mesh name="tool" file="tool.obj"/></asset></mujoco>'
TOOL = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"

URDF = """
<robot name="arm">
  <link name="base"/>
  <joint name="swing" type="continuous">
    <parent link="base"/><child link="boom"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.3" rpy="0.3 0 3.1"/><dynamics damping="0.4"/>
  </joint>
  <link name="boom">{boom}</link>
  <joint name="reach" type="prismatic">
    <parent link="boom"/><child link="hand"/><axis xyz="1 0 0"/>
    <origin xyz="0.2 0 0" rpy="0 1.2 -2.5"/><limit lower="0" upper="0.3" effort="90" velocity="1"/>
  </joint>
  <link name="hand">{hand}</link>
  <joint name="weld" type="fixed"><parent link="hand"/><child link="plate"/></joint>
  <link name="plate"/>
</robot>
"""
INERTIAL = (
    '<inertial><origin xyz="0.1 0 0"/><mass value="{}"/><inertia ixx="0.02" iyy="0.03" izz="0.03" '
    'ixy="0" ixz="0" iyz="0"/></inertial>'
)
LEGS = tuple(
    f"{at}_{part}_joint" for at in ("FL", "FR", "RL", "RR") for part in ("hip", "thigh", "calf")
)
ARMS = {
    "arm.xml": RobotModel("lessons/l99/arm.xml", ("turn", "lift", "push"), hand="tool"),
    "arm.urdf": RobotModel("lessons/l99/arm.urdf", ("swing", "reach"), hand="hand"),
}
DOG = RobotModel("urdf/go2/urdf/go2.urdf", LEGS, free_base=True)


def case_of(model, q_start, by):
    d = len(model.joints)
    gains = {"kp": np.full(d, 400.0), "kv": np.full(d, 40.0), "effort_limit": np.full(d, 60.0)}
    start = np.array(q_start, dtype=float)
    return ControlCase(model=model, q_start=start, q_target=start + by, steps=20, **gains)


CASES = {
    "arm.xml": case_of(ARMS["arm.xml"], [0.2, -0.4, 0.05], 0.1),
    "arm.urdf": case_of(ARMS["arm.urdf"], [0.5, 0.1], 0.1),
    "dog": case_of(DOG, [0.0, 0.8, -1.5] * 4, 0.1),
}


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    """A folder of a lesson with both arms, and with their mesh and their tool below it."""
    place = tmp_path_factory.mktemp("l99")
    (place / "parts").mkdir()
    (place / "arm.xml").write_text(MJCF)
    (place / "arm.urdf").write_text(URDF.format(boom=INERTIAL.format(3), hand=INERTIAL.format(1)))
    (place / "parts/tool.xml").write_text(PARTS)
    (place / "parts/tool.obj").write_text(TOOL)
    with pytest.MonkeyPatch.context() as patch:
        found = lambda name: str(place / Path(name).name) if "l99" in name else model_file(name)
        patch.setattr(mujoco_kinematics, "model_file", found)
        yield place


@pytest.fixture(scope="module")
def robots(real_engine, folder):
    """Scene and robots, each far from the others."""
    gs = real_engine.gs
    scene = gs.Scene(sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False)
    scene.add_entity(gs.morphs.Plane())
    plain = {"default_armature": None}
    dog = {"collision": False, "visualization": False, "pos": (-3, 0, 1)}
    found = {
        "arm.xml": scene.add_entity(gs.morphs.MJCF(file=str(folder / "arm.xml"), **plain)),
        "arm.urdf": scene.add_entity(
            gs.morphs.URDF(file=str(folder / "arm.urdf"), fixed=True, **plain)
        ),
        "dog": scene.add_entity(gs.morphs.URDF(file=DOG.file, **dog)),
    }
    scene.build()
    return SimpleNamespace(scene=scene, **{name: found[name] for name in found})


def page():
    return SimpleNamespace(readings={}, links=[], joints=None)
