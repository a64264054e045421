"""One robot in each environment of a batched scene: reset, command and step all or some of them.

Row k of an array belongs to environment k. A scene that was built without environments
has arrays without this axis; here it counts as one row.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.session import require_built

from . import joint_control
from .joint_control import ControlCase
from .joints import JointMap, to_numpy


class Batch:
    """The robot in all environments from a complete reset on, and the record of its states."""

    def __init__(
        self,
        scene: Any,
        robot: Any,
        joints: JointMap,
        cases: Sequence[ControlCase],
        bodies: Sequence[Any] = (),
        begin: Callable[[], None] | None = None,
    ) -> None:
        """Reset every environment to the start of its case; raises as `reset_batch`.

        Traces also have the links of `bodies`, as in `joint_control.run_case`. `begin`
        is called after the reset, as to place them.
        """
        self.scene, self.robot, self.cases, self.bodies = (
            scene,
            robot,
            list(cases),
            bodies,
        )
        self.dofs = joints.dofs
        batch = reset_batch(scene, robot, joints, self.cases)
        if begin:
            begin()
        self.q_start = np.reshape(batch.q_start, (len(self.cases), -1))
        self.target = self.q_start.astype(np.float64)
        self.readings = [self._rows()]
        self.sent: list[FloatArray] = []
        self.begin = np.zeros(len(self.cases), int)
        self.effort_limit = np.broadcast_to(
            to_numpy(robot.get_dofs_force_range(self.dofs)[1]), self.q_start.shape
        )

    def command(self, q_target: FloatArray, envs: Sequence[int] | None = None) -> None:
        """Command positions to all environments, or to some of them; the others keep theirs.

        Args:
            q_target: (k, d), row j for environment `envs[j]` [rad or m].
            envs: numbers of k environments; all, in their order, by default.

        Raises:
            IndexError: an environment does not exist.
        """
        chosen = self._chosen(envs)
        values = np.array(q_target, dtype=np.float64)
        if self.scene.n_envs:
            self.robot.control_dofs_position(values, self.dofs, envs_idx=chosen)
        else:
            self.robot.control_dofs_position(values[0], self.dofs)
        self.target[chosen] = values
        if begins := [k for k in chosen if self.begin[k] == len(self.sent)]:
            self._read_again(begins)

    def step(self, steps: int) -> None:
        """Step all environments, and record each state and the command that led to it."""
        for _ in range(steps):
            self.scene.step()
            self.readings.append(self._rows())
            self.sent.append(self.target.copy())

    def reset_rows(self, envs: Sequence[int]) -> None:
        """Reset some environments to the start of their cases; the others keep their state.

        Gains and ranges of force remain; the command of the chosen environments ends,
        so send a new one before the next step. Their traces begin here.

        Raises:
            IndexError: an environment does not exist.
        """
        chosen = self._chosen(envs)
        self.scene.reset(envs_idx=chosen)
        self.robot.set_dofs_position(
            self.q_start[chosen], self.dofs, envs_idx=chosen, zero_velocity=True
        )
        self.begin[chosen] = len(self.sent)
        self._read_again(chosen)

    def trace(self, row: int) -> Trace:
        """Return the run of one environment since its last reset."""
        first, case = int(self.begin[row]), self.cases[row]
        return joint_control.assemble(
            replace(case, steps=len(self.sent) - first),
            [
                tuple(values[row] for values in reading)
                for reading in self.readings[first:]
            ],
            [target[row] for target in self.sent[first:]],
            self.effort_limit[row],
        )

    def _read_again(self, rows: list[int]) -> None:
        """Replace the latest readings of rows whose trace begins here."""
        for latest, now in zip(self.readings[-1], self._rows(), strict=True):
            latest[rows] = now[rows]

    def _rows(self) -> tuple[FloatArray, ...]:
        """Return what the engine has now, each array with an axis of rows."""
        found = joint_control.read(self.robot, self.dofs, self.bodies)
        return tuple(values if self.scene.n_envs else values[None] for values in found)

    def _chosen(self, envs: Sequence[int] | None) -> list[int]:
        """Return the numbers of environments as a list, of all where none are given.

        The engine itself does not check them; the index of an array is checked.
        """
        known = np.arange(len(self.cases))
        return (known if envs is None else known[list(envs)]).tolist()


def run_batch(
    scene: Any, robot: Any, joints: JointMap, cases: Mapping[str, ControlCase]
) -> dict[str, Trace]:
    """Do as `joint_control.run_case` does, with each case in an environment of its own.

    Args:
        scene: built with `n_envs` = number of cases, and with `batch_dofs_info`,
            without which all environments share one set of gains.
        robot: the scene's robot.
        joints: its map.
        cases: by name, of equal `dt`, `substeps` and `steps`.

    Raises:
        CaseError: as `reset_batch`.

    Returns:
        The trace of each case by name.
    """
    batch = Batch(scene, robot, joints, list(cases.values()))
    batch.command(np.stack([case.q_target for case in cases.values()]))
    batch.step(batch.cases[0].steps)
    return {name: batch.trace(row) for row, name in enumerate(cases)}


def reset_batch(
    scene: Any, robot: Any, joints: JointMap, cases: Sequence[ControlCase]
) -> ControlCase:
    """Do as `joint_control.reset` does in every environment, and read back what was set.

    Raises:
        CaseError: the scene has another time step than a case, a case must not be run,
            or a value reads back differently from the value that was set.

    Returns:
        The cases as one: its arrays are (cases, joints), without environments
            (joints,), as are gains and limits that all cases share.
    """
    for case in cases:
        require_built(scene, case)
        joint_control.validate(case, joints)
    arrays: dict[str, Any] = {
        name: np.stack([getattr(case, name) for case in cases])
        for name in ("q_start", "q_target", "kp", "kv", "effort_limit")
    }
    for name, rows in arrays.items():
        # A scene without `batch_dofs_info` has one set of gains and limits.
        shared = not name.startswith("q_") and (rows == rows[0]).all()
        if shared or not scene.n_envs:
            arrays[name] = rows[0]
    batch = replace(cases[0], **arrays)
    scene.reset()
    joint_control.set_up(robot, joints.dofs, batch)
    return batch


def set_link_mass(
    robot: Any, link: str, masses: FloatArray, envs: Sequence[int] | None = None
) -> FloatArray:
    """Give a link another mass, in all or some environments; return what reads back [kg].

    That is one mass for each environment, or one for all in a scene without
    `batch_links_info`.

    Centre of mass and inertia of the link remain. A reset of the scene keeps the
    masses. A newer engine computes what follows from a mass again when it is written,
    also when the mass is the same: forces may then differ in the last bit. So name no
    environment that keeps its mass.

    Args:
        robot: of a scene; `envs` require `batch_links_info`.
        link: its name.
        masses: (k,) [kg], one for each environment of `envs`; (1,) for all.
        envs: k environments.
    """
    at = [robot.get_link(link).idx_local]
    # Newer versions of the engine have other names.
    new = hasattr(robot, "set_links_mass")
    write = robot.set_links_mass if new else robot.set_links_inertial_mass
    read = robot.get_links_mass if new else robot.get_links_inertial_mass
    values = np.array(masses, dtype=np.float32)
    if envs is None:
        write(values, at)
    else:
        write(values[:, None], at, list(envs))
    return np.ravel(to_numpy(read(at)))
