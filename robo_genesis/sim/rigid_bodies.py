"""The experiment that students read: let a free body go, step, record."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.free_fall import GRAVITY
from robo_genesis.core.scene import DT, SEED, SUBSTEPS, FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.joints import to_numpy

START_TOLERANCE = 1e-6
"""Room for float32 when the start is read back [m]."""


class DropError(ValueError):
    """A drop that must not be run; the message says what was found, and what is valid."""


@dataclass(frozen=True, slots=True)
class Drop:
    """Everything that decides one drop of a cube from rest.

    `size` is the cube's edge [m], `density` [kg/m³], `height` that of its centre at the start [m],
    `gravity` the magnitude of the acceleration downwards [m/s²]; `dt` [s]; `steps` counts outer
    steps.
    """

    size: float
    density: float
    height: float
    steps: int
    dt: float = DT
    substeps: int = SUBSTEPS
    gravity: float = GRAVITY
    seed: int = SEED

    @property
    def h(self) -> float:
        """Length of one solver step [s]."""
        return self.dt / self.substeps

    @property
    def mass(self) -> float:
        """What the cube weighs if it is solid [kg]."""
        return self.density * self.size**3

    @property
    def clearance(self) -> float:
        """Distance from the cube's underside to the ground at the start [m]."""
        return self.height - self.size / 2


def run_drop(scene: Any, box: Any, case: Drop) -> BodyTrace:
    """Bring the scene back to its start, let go, step, and record every state.

    Raises:
        DropError: the scene is not built yet or has another time step, or the box is not at rest
            at the height that the case asks for.
    """
    if not scene.is_built:
        raise DropError("The scene is not built: call scene.build() before anything is dropped.")
    if (scene.dt, scene.substeps) != (case.dt, case.substeps):
        raise DropError(
            f"The scene was built with dt={scene.dt}, substeps={scene.substeps}; the case asks for "
            f"dt={case.dt}, substeps={case.substeps}. Restart and build the scene for this case."
        )
    scene.reset()
    states = [read_body(box)]
    _check_start(states[0], case)
    for _ in range(case.steps):
        scene.step()
        states.append(read_body(box))
    link_pos, link_quat, link_vel, link_ang = (
        np.stack(column) for column in zip(*states, strict=True)
    )
    t = np.arange(case.steps + 1) * case.dt
    return BodyTrace(t, link_pos, link_quat, link_vel, link_ang)


def read_model(scene: Any, body: Any) -> dict[str, int]:
    """Return the engine's counts: entities of the scene; links, geoms and more of the body."""
    return {
        "entities": len(scene.entities),
        "links": body.n_links,
        "geoms": body.n_geoms,
        "joints": body.n_joints,
        "dofs": body.n_dofs,
        "qpos": body.n_qs,
    }


def read_body(body: Any) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return position (l, 3), orientation (l, 4), velocity and angular velocity (l, 3), now."""
    return (
        to_numpy(body.get_links_pos()),
        to_numpy(body.get_links_quat()),
        to_numpy(body.get_links_vel()),
        to_numpy(body.get_links_ang()),
    )


def _check_start(state: tuple[FloatArray, ...], case: Drop) -> None:
    position, _, velocity, turning = state
    height = float(position[0, 2])
    if abs(height - case.height) > START_TOLERANCE or velocity.any() or turning.any():
        raise DropError(
            f"The box starts at a height of {height:g} m with velocity {velocity[0].tolist()} m/s; "
            f"the case asks for {case.height:g} m, at rest. Place it so before scene.build()."
        )
