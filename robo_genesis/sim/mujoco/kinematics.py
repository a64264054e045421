"""Link poses, Jacobian and gravity of an arm in MuJoCo, on the model file that Genesis reads.

The model has neither actuators nor shapes, except where a shape decides the inertia of
a link. So nothing but its frames and masses decides a result.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.franka import FRANKA
from robo_genesis.sim.arm.kinematics import Pose
from robo_genesis.sim.arm.model import ModelError, RobotModel, model_file

# That of a scene of Genesis, whatever the model file says [m/s²]
GRAVITY = 0.0, 0.0, -9.81


@cache
def bare_robot(
    load: float = 0.0, of: RobotModel = FRANKA
) -> tuple[Any, Any, list[int]]:
    """Return the model without shapes and actuators, and the rest of `with_data`.

    `load` is added to the mass of the hand [kg]; its centre of mass and inertia remain.
    The data are made once, because that takes as long as a hundred states. Every use
    sets all of `qpos` and `qvel` that it reads.
    """
    import mujoco

    model, *found = with_data(compiled(bare_spec(of), of), of)
    if load:
        model.body(of.hand).mass += load
        mujoco.mj_setConst(model, found[0])
    return model, *found


def bare_spec(of: RobotModel) -> Any:
    """Return the specification of the model without actuators, and with the shapes that weigh.

    Raises:
        ModelError: the base moves freely, or MuJoCo cannot read the file.
    """
    import mujoco

    if of.free_base:
        raise ModelError(
            f"{of.file} has a base that moves freely. Poses and masses in MuJoCo are those of "
            "arms with a fixed base."
        )
    try:
        spec = mujoco.MjSpec.from_file(model_file(of.file))
    except (ValueError, mujoco.FatalError) as error:
        raise _unreadable(of, error) from error
    from_shapes = (
        spec.compiler.inertiafromgeom
        == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    )
    # tendons may lead round shapes without a mesh, which stay
    light = [
        g
        for g in spec.geoms
        if g.meshname and g.parent.explicitinertial and not from_shapes
    ]
    kept = {g.meshname for g in spec.geoms if g not in light}
    shapes = [*light, *(mesh for mesh in spec.meshes if mesh.name not in kept)]
    # sensors and pairs refer to actuators and shapes
    for part in (*spec.sensors, *spec.pairs, *spec.actuators, *spec.keys, *shapes):
        spec.delete(part)
    spec.compiler.fusestatic = False  # fused links would lose their names
    spec.option.gravity = GRAVITY
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    return spec


def compiled(spec: Any, of: RobotModel) -> Any:
    """Return the compiled specification of a model, or raise ModelError if it cannot be."""
    try:
        return spec.compile()
    except ValueError as error:
        raise _unreadable(of, error) from error


def _unreadable(of: RobotModel, error: Exception) -> ModelError:
    return ModelError(
        f"MuJoCo cannot read {of.file}: {error}. Valid is an MJCF or a URDF; a xacro file has to "
        "become a URDF first. Each link that a joint moves needs mass and inertia, in a URDF as "
        "<inertial>."
    )


def with_data(model: Any, of: RobotModel) -> tuple[Any, Any, list[int]]:
    """Return a compiled model, its data, and the numbers of the robot's joints.

    Each joint has one DOF, so its number is also its index in qpos and qvel.

    Raises:
        ModelError: the robot's joints are not those of the file, or not all have one
            DOF.
    """
    import mujoco

    names = [model.joint(k).name for k in range(model.njnt)]
    links = [model.body(k).name for k in range(model.nbody)]
    if (
        sorted(names) != sorted(of.joints)
        or not model.nq == model.nv == model.njnt
        or of.hand not in ("", *links)
    ):
        raise ModelError(
            f"{of.file} has the joints {', '.join(names) or '(none)'}, and the links "
            f"{', '.join(links)}; its RobotModel names {', '.join(of.joints)}, and the hand "
            f"{of.hand!r}. Name each joint in the file and in `joints`. Valid kinds are hinge and "
            "slide. A xacro file has to become a URDF first."
        )
    joints = [model.joint(name).id for name in of.joints]
    return model, mujoco.MjData(model), joints


def link_poses(q: FloatArray, links: Sequence[str], of: RobotModel = FRANKA) -> Pose:
    """Return positions (n, l, 3) [m] and orientations (n, l, 4) of links at `q` (n, d)."""
    import mujoco

    model, data, joints = bare_robot(of=of)
    bodies = [model.body(name).id for name in links]
    poses = []
    for positions in q:
        data.qpos[joints] = positions
        mujoco.mj_kinematics(model, data)
        poses.append((data.xpos[bodies], data.xquat[bodies]))
    return Pose(*map(np.array, zip(*poses, strict=True)))


def jacobian(q: FloatArray, of: RobotModel = FRANKA) -> FloatArray:
    """Return the Jacobian (6, d) of the hand's origin at `q` (d,), as `kinematics.jacobian`."""
    import mujoco

    model, data, joints = bare_robot(of=of)
    data.qpos[joints] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    rows = np.zeros((6, model.nv))
    mujoco.mj_jacBody(model, data, rows[:3], rows[3:], model.body(of.hand).id)
    return rows[:, joints]


def at_rest(
    q: FloatArray, load: float = 0.0, of: RobotModel = FRANKA
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return inertia, gravity and damping of each joint at posture `q` (d,), without integrator.

    Args:
        q: (d,) positions [rad or m].
        load: mass at the hand's centre of mass, beside its own [kg].
        of: the robot.

    Returns:
        The diagonal (d,) of the mass matrix [kg·m² or kg], the effort (d,) that holds
        the posture [N·m or N], and the passive damping (d,) of the model [N·m·s/rad or
        N·s/m].
    """
    import mujoco

    model, data, joints = bare_robot(load, of)
    data.qpos[joints], data.qvel[:] = q, 0.0
    mujoco.mj_forward(model, data)
    diagonal = data.M[model.M_rowadr + model.M_rownnz - 1]
    return diagonal[joints], data.qfrc_bias[joints], model.dof_damping[joints]


def gravity_effort(
    q: FloatArray, load: float = 0.0, of: RobotModel = FRANKA
) -> FloatArray:
    """Return the effort (d,) [N·m or N] of `at_rest`."""
    return at_rest(q, load, of)[1]
