"""The map from joint names to entity-local DOFs, with types, units and limits."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

from .franka import FRANKA, MODEL_COUNTS
from .model import ModelError, RobotModel

POSITION_UNIT = {"REVOLUTE": "rad", "PRISMATIC": "m"}
EFFORT_UNIT = {"REVOLUTE": "N·m", "PRISMATIC": "N"}


class JointError(LookupError):
    """A joint does not exist, or is not one scalar DOF."""


@dataclass(frozen=True, slots=True)
class JointMap:
    """One-DOF joints of one entity; entry k of every array belongs to `names[k]`.

    | field | shape | meaning |
    |---|---|---|
    | `dofs_idx_local` | (n,) | DOF index within the entity |
    | `qs_idx_local` | (n,) | index into the entity's generalised position |
    | `lower`, `upper` | (n,) | position limits of the model [rad or m] |
    """

    names: tuple[str, ...]
    types: tuple[str, ...]
    dofs_idx_local: np.ndarray
    qs_idx_local: np.ndarray
    lower: FloatArray
    upper: FloatArray

    @property
    def dofs(self) -> list[int]:
        """`dofs_idx_local` as the calls of the engine take it."""
        return self.dofs_idx_local.tolist()

    @property
    def position_units(self) -> tuple[str, ...]:
        """Unit of each position: rad or m."""
        return tuple(POSITION_UNIT[kind] for kind in self.types)

    @property
    def effort_units(self) -> tuple[str, ...]:
        """Unit of each effort: N·m or N."""
        return tuple(EFFORT_UNIT[kind] for kind in self.types)

    def entry(self, name: str) -> int:
        """Return the index of joint `name` in the arrays of this map.

        Raises:
            JointError: the map has no such joint; the message lists those it has.
        """
        if name not in self.names:
            raise JointError(
                f"Joint {name!r} is not in this map. Available: {', '.join(self.names)}."
            )
        return self.names.index(name)

    def rows(self) -> list[dict[str, Any]]:
        """Return the name-to-DOF table, one dict per joint."""
        return [
            {
                "name": name,
                "type": self.types[k].lower(),
                "local DOF": int(self.dofs_idx_local[k]),
                "local qpos": int(self.qs_idx_local[k]),
                "lower": float(self.lower[k]),
                "upper": float(self.upper[k]),
                "unit": self.position_units[k],
            }
            for k, name in enumerate(self.names)
        ]


def resolve_joints(robot: Any, names: Sequence[str]) -> JointMap:
    """Return the map of the named joints of a built entity.

    Args:
        robot: rigid entity of a built scene.
        names: joints that must own exactly one DOF and one qpos each.

    Returns:
        The map, in the order of `names`.

    Raises:
        JointError: a name is unknown (the message lists the model's names), or its
            joint is not one DOF and one qpos (the message gives both counts).
    """
    joints = [one_dof_joint(robot, name) for name in names]
    dofs_idx_local = np.array([joint.dofs_idx_local[0] for joint in joints])  # (n,)
    qs_idx_local = np.array([joint.qs_idx_local[0] for joint in joints])  # (n,)
    limits = robot.get_dofs_limit(dofs_idx_local.tolist())
    # With `batch_dofs_info` there is one row for each environment, all equal in a new
    # scene. JSON keeps float64.
    lower, upper = (
        to_numpy(bound).astype(np.float64).reshape(-1, len(names))[0]
        for bound in limits
    )
    for array in (dofs_idx_local, qs_idx_local, lower, upper):
        array.setflags(write=False)
    types = tuple(joint.type.name for joint in joints)
    return JointMap(tuple(names), types, dofs_idx_local, qs_idx_local, lower, upper)


def one_dof_joint(robot: Any, name: str) -> Any:
    """Return the joint called `name` after checking that it is one DOF and one qpos."""
    available = [joint.name for joint in robot.joints]
    if name not in available:
        raise JointError(
            f"Joint {name!r} is not in this model. Available: {', '.join(available)}. "
            "Check the spelling, the model file and the engine version; do not guess an index."
        )
    joint = robot.get_joint(name)
    if (joint.n_dofs, joint.n_qs) != (1, 1):
        raise JointError(
            f"Joint {name!r} has {joint.n_dofs} DOFs and {joint.n_qs} qpos; the control arrays "
            "of this course take joints with one of each. Control it through its own DOF slice."
        )
    return joint


def describe(page: Any, robot: Any, of: RobotModel = FRANKA) -> JointMap:
    """Give a page the counts, links and joints of a robot, and return its joints.

    Raises:
        JointError: a joint is missing, or does not have one DOF.
        ModelError: the robot has other DOFs than its model, or, with a fixed base,
            another damping or armature than its file.
    """
    page.readings["model"] = read_counts(robot)
    page.links = [link.name for link in robot.links]
    page.joints = resolve_joints(robot, of.joints)
    require_model(robot, page.joints, of)
    return page.joints


def read_counts(robot: Any) -> dict[str, int]:
    """Return the engine's counts of a robot, by the names of `MODEL_COUNTS`."""
    counted = (robot.n_links, robot.n_joints, robot.n_dofs, robot.n_qs)
    return dict(zip(MODEL_COUNTS, counted, strict=True))


def require_model(robot: Any, joints: JointMap, of: RobotModel) -> None:
    """Raise ModelError unless a robot in the engine is the one of its model."""
    others = {
        j.name: j.type.name
        for j in robot.joints
        if j.n_dofs and j.name not in of.joints
    }
    if [*others.values()] != ["FREE"] * of.free_base:
        raise ModelError(
            f"Beside the joints of its RobotModel, {of.file} moves by {others or 'none'}, expected "
            f"{'one FREE joint' if of.free_base else 'none'}. Name all joints in `joints`. A URDF "
            "has a free base, unless it is added with gs.morphs.URDF(fixed=True); declare a free "
            "base with free_base=True."
        )
    if of.free_base:
        return
    from robo_genesis.sim.mujoco.kinematics import bare_robot

    (model, _, entries), dofs = bare_robot(of=of), joints.dofs
    for name in ("armature", "damping"):
        found = to_numpy(getattr(robot, f"get_dofs_{name}")(dofs)).reshape(
            -1, len(dofs)
        )[0]
        valid = getattr(model, f"dof_{name}")[entries]
        if not np.allclose(found, valid, rtol=1e-5):
            raise ModelError(
                f"The {name} of {', '.join(of.joints)} is {found} in the engine and {valid} in "
                f"{of.file}. Where a file has no armature the engine adds 0.1: write it into the "
                "file, or give the morph default_armature=None."
            )


def require_whole(robot: Any, joints: JointMap) -> None:
    """Raise ModelError unless a map has all DOFs of a robot, so that its base is fixed."""
    if robot.n_dofs != len(joints.names):
        raise ModelError(
            f"The robot has {robot.n_dofs} DOFs, the map {len(joints.names)}, those of "
            f"{', '.join(joints.names)}. Expected is an arm with a fixed base and all of its "
            "joints; a URDF has a free base unless it is added with fixed=True."
        )


def to_numpy(values: Any) -> FloatArray:
    """Return a copy of an engine tensor as a NumPy array of the same shape."""
    if hasattr(values, "detach"):
        values = values.detach().cpu().numpy()
    return np.array(values)
