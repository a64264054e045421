"""Gravity effort and effective inertia of each joint in a posture at rest."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

from .joints import JointMap, require_whole, to_numpy


def let_go(scene: Any, robot: Any, joints: JointMap, q: FloatArray) -> list[int]:
    """Assign posture `q` (d,) [rad or m] at rest and take one step without any effort.

    The engine's getters of forces and masses return values of the latest step, so
    without a step they would belong to an earlier posture. Returns the local DOFs, in
    the order of the map.

    Raises:
        ModelError: the robot has further DOFs, such as those of a free base: these
            would move.
    """
    require_whole(robot, joints)
    dofs = joints.dofs
    scene.reset()
    robot.set_dofs_position(np.array(q, dtype=np.float64), dofs, zero_velocity=True)
    robot.control_dofs_force(np.zeros(len(dofs)), dofs)
    scene.step()
    return dofs


def gravity_effort(
    scene: Any, robot: Any, joints: JointMap, q: FloatArray
) -> FloatArray:
    """Return the effort (d,) [N·m or N] that would hold posture `q` (d,) against gravity.

    Without effort `get_dofs_force` returns gravity and the passive damping at the
    velocity before the latest substep; the damping is subtracted. The result does not
    depend on the gains, so it can be compared with KP × error.
    """
    dofs = let_go(scene, robot, joints, q)
    fallen = (
        to_numpy(robot.get_dofs_velocity(dofs)) * (scene.substeps - 1) / scene.substeps
    )
    return -to_numpy(robot.get_dofs_force(dofs)) - passive_damping(robot, dofs) * fallen


def effective_inertia(
    scene: Any, robot: Any, joints: JointMap, q: FloatArray
) -> FloatArray:
    """Return the inertia of each joint at posture `q` (d,) while the other joints do not move.

    This is the diagonal (d,) of the mass matrix [kg·m² or kg] without the term that the
    implicit integrator of the engine adds: substep · passive damping here, without a
    position command.
    """
    dofs = let_go(scene, robot, joints, q)
    added = scene.dt / scene.substeps * passive_damping(robot, dofs)
    return mass_diagonal(robot, dofs) - added


def mass_diagonal(robot: Any, dofs: list[int]) -> FloatArray:
    """Return the diagonal (d,) of `get_mass_mat` as the latest step used it [kg·m² or kg]."""
    return to_numpy(robot.get_mass_mat()).astype(np.float64).diagonal()[dofs]


def passive_damping(robot: Any, dofs: list[int]) -> FloatArray:
    """Return the joint damping (d,) of the model [N·m·s/rad or N·s/m], without gains."""
    return to_numpy(robot.get_dofs_damping(dofs)).astype(np.float64)
