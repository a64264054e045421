"""The lab's scene without its page, for the scripts that `make bench` measures."""

import os
from typing import Any

from robo_genesis import project
from robo_genesis.robot_model import JointMap, resolve_joints
from robo_genesis.runtime import Contract, start
from robo_genesis.scene_config import CAMERA, DT, FRANKA_MJCF, JOINT_NAMES, SUBSTEPS


def build(camera: bool) -> tuple[Any, Any, JointMap, Any]:
    """Start the engine with the course's caches and return scene, robot, joints and camera."""
    os.environ.update(project.engine_cache_environment())
    start(Contract("cpu", camera, project.CACHE))
    import genesis as gs

    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS),
        profiling_options=gs.options.ProfilingOptions(show_FPS=False),
        show_viewer=False,
    )
    scene.add_entity(gs.morphs.Plane())
    robot = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    eye = scene.add_camera(**CAMERA) if camera else None
    scene.build()
    return scene, robot, resolve_joints(robot, JOINT_NAMES), eye
