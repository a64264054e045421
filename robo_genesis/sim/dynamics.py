"""What the engine says about a posture at rest: gravity's effort and each joint's inertia."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.joints import JointMap, to_numpy


def let_go(scene: Any, robot: Any, joints: JointMap, q: FloatArray) -> list[int]:
    """Assign posture `q` (d,) [rad or m] at rest and take one step without any effort.

    What the engine's getters report about forces and masses stems from its latest step; without
    one it would be another posture's. Returns the local DOFs, in the map's order.
    """
    dofs: list[int] = joints.dofs_idx_local.tolist()
    scene.reset()
    robot.set_dofs_position(np.array(q, dtype=np.float64), dofs, zero_velocity=True)
    robot.control_dofs_force(np.zeros(len(dofs)), dofs)
    scene.step()
    return dofs


def gravity_effort(scene: Any, robot: Any, joints: JointMap, q: FloatArray) -> FloatArray:
    """Return the effort (d,) [N·m or N] that would hold posture `q` (d,) against gravity.

    Without effort `get_dofs_force` reports gravity's pull and the passive damping at the speed with
    which the latest substep began; the damping is taken off. No gain enters, so the result can be
    held against KP × error.
    """
    dofs = let_go(scene, robot, joints, q)
    fallen = to_numpy(robot.get_dofs_velocity(dofs)) * (scene.substeps - 1) / scene.substeps
    return -to_numpy(robot.get_dofs_force(dofs)) - passive_damping(robot, dofs) * fallen


def effective_inertia(scene: Any, robot: Any, joints: JointMap, q: FloatArray) -> FloatArray:
    """Return the inertia that each joint's motor has to move at posture `q` (d,), the others held.

    That is the diagonal (d,) of the mass matrix [kg·m² or kg], freed of the term that the engine's
    implicit integrator adds: substep · passive damping here, where no position is commanded.
    """
    dofs = let_go(scene, robot, joints, q)
    return mass_diagonal(robot, dofs) - substep(scene) * passive_damping(robot, dofs)


def mass_diagonal(robot: Any, dofs: list[int]) -> FloatArray:
    """Return the diagonal (d,) of `get_mass_mat` as the latest step used it [kg·m² or kg]."""
    return np.asarray(to_numpy(robot.get_mass_mat()).astype(np.float64).diagonal()[dofs])


def passive_damping(robot: Any, dofs: list[int]) -> FloatArray:
    """Return the model's own joint damping (d,) [N·m·s/rad or N·s/m]: no gain is in it."""
    return to_numpy(robot.get_dofs_damping(dofs)).astype(np.float64)


def substep(scene: Any) -> float:
    """Return the length of one solver step [s]."""
    return float(scene.dt / scene.substeps)
