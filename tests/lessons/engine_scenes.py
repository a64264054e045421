"""Scenes with the robot in the real engine."""

from dataclasses import astuple
from types import SimpleNamespace

from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.arm.joints import resolve_joints


def robot_in_scene(gs, envs=0, substeps=SUBSTEPS, **options):
    """Return scene, robot and joints; the options are those of the rigid solver."""
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=substeps),
        rigid_options=gs.options.RigidOptions(**options),
        show_viewer=False,
    )
    scene.add_entity(gs.morphs.Plane())
    robot = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    scene.build(n_envs=envs)
    return SimpleNamespace(
        scene=scene, robot=robot, joints=resolve_joints(robot, JOINT_NAMES)
    )


def arrays(trace):
    """The bytes of each array of a run."""
    return [values.tobytes() for values in astuple(trace)]
