"""Link poses, Jacobian and gravity of the Franka in MuJoCo, on the model file that Genesis bundles.

The model has neither shapes nor actuators, so nothing but its frames and masses decides a result.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.arm.kinematics import Pose
from robo_genesis.sim.session import asset


@cache
def bare_robot(load: float = 0.0) -> tuple[Any, Any, list[int], list[int]]:
    """Return the model without shapes and actuators, its data, and the joints in qpos and qvel.

    `load` is added to the mass of the hand [kg]; its centre of mass and inertia remain. The data
    are made once, because that takes as long as a hundred states. Every use sets all of `qpos` and
    `qvel` that it reads.
    """
    spec = bare_spec()
    spec.body("hand").mass += load
    return with_data(spec.compile())


def bare_spec() -> Any:
    """Return the specification of the model without shapes and actuators."""
    import mujoco

    spec = mujoco.MjSpec.from_file(str(asset(FRANKA_MJCF)))
    for part in (*spec.actuators, *spec.keys, *spec.geoms, *spec.meshes):
        spec.delete(part)
    return spec


def with_data(model: Any) -> tuple[Any, Any, list[int], list[int]]:
    """Return a model of the robot, its data, and the joints' indices in qpos and qvel."""
    import mujoco

    joints = [model.joint(name) for name in JOINT_NAMES]
    q_at, dof_at = [int(j.qposadr[0]) for j in joints], [int(j.dofadr[0]) for j in joints]
    return model, mujoco.MjData(model), q_at, dof_at


def link_names() -> set[str]:
    """Return the names of the model's links."""
    model, *_ = bare_robot()
    return {model.body(k).name for k in range(1, model.nbody)}


def link_poses(q: FloatArray, links: Sequence[str]) -> Pose:
    """Return positions (n, l, 3) [m] and orientations (n, l, 4) of links at `q` (n, d)."""
    import mujoco

    model, data, q_at, _ = bare_robot()
    bodies = [model.body(name).id for name in links]
    position, orientation = np.empty((len(q), model.nbody, 3)), np.empty((len(q), model.nbody, 4))
    joints = np.empty((len(q), model.nq))
    joints[:, q_at] = q
    qpos, xpos, xquat = data.qpos, data.xpos, data.xquat
    for values, places, turns in zip(joints, position, orientation, strict=True):
        qpos[:] = values
        mujoco.mj_kinematics(model, data)
        places[:], turns[:] = xpos, xquat
    return Pose(position[:, bodies], orientation[:, bodies])


def jacobian(q: FloatArray) -> FloatArray:
    """Return the Jacobian (6, d) of the hand's origin at `q` (d,), as `kinematics.jacobian`."""
    import mujoco

    model, data, q_at, dof_at = bare_robot()
    data.qpos[q_at] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    rows = np.zeros((6, model.nv))
    mujoco.mj_jacBody(model, data, rows[:3], rows[3:], model.body("hand").id)
    return np.asarray(rows[:, dof_at])


def gravity_effort(q: FloatArray, load: float = 0.0) -> FloatArray:
    """Return the effort (d,) [N·m or N] that holds posture `q` (d,) against gravity at rest.

    Args:
        q: (d,) positions [rad or m].
        load: mass at the hand's centre of mass, beside its own [kg].
    """
    import mujoco

    model, data, q_at, dof_at = bare_robot(load)
    data.qpos[q_at], data.qvel[:] = q, 0.0
    mujoco.mj_forward(model, data)
    return np.array(data.qfrc_bias[dof_at])
