"""Free rigid bodies: read their states, record a run, drop a cube from rest."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import SEED, FloatArray, Stepped
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.session import require_built

from .free_fall import GRAVITY

# The engine's counts of a scene with a ground and one free body; all but `entities` are
# those of the body.
MODEL_COUNTS = {
    "entities": 2,
    "links": 1,
    "geoms": 1,
    "joints": 1,
    "dofs": 6,
    "qpos": 7,
}


@dataclass(frozen=True, slots=True)
class Drop(Stepped):
    """All settings of one drop of a cube from rest.

    `size` is the cube's edge [m], `density` [kg/m³], `height` that of its centre at the
    start [m], `gravity` the magnitude of the acceleration downwards [m/s²], `steps` the
    number of outer steps.
    """

    size: float
    density: float
    height: float
    steps: int
    gravity: float = GRAVITY
    seed: int = SEED

    @property
    def mass(self) -> float:
        """Mass of the solid cube [kg]."""
        return self.density * self.size**3


def new_scene(
    gs: Any,
    case: Any,
    rigid: Mapping[str, Any] | None = None,
    *,
    first_only: bool = False,
    **simulated: Any,
) -> Any:
    """Return a scene with the `dt` and `substeps` of a case, without viewer and speed in the log.

    Args:
        gs: the engine after `gs.init`.
        case: the settings.
        rigid: arguments of `gs.options.RigidOptions`, None for the defaults.
        first_only: whether cameras see the first environment alone: a frame of 64 of
            them, one in the other, takes seconds.
        simulated: further arguments of `gs.options.SimOptions`.
    """
    options = gs.options
    return gs.Scene(
        sim_options=options.SimOptions(dt=case.dt, substeps=case.substeps, **simulated),
        rigid_options=options.RigidOptions(**rigid) if rigid else None,
        vis_options=options.VisOptions(rendered_envs_idx=[0]) if first_only else None,
        profiling_options=options.ProfilingOptions(show_FPS=False),
        show_viewer=False,
    )


def run_drop(scene: Any, box: Any, case: Drop) -> BodyTrace:
    """Reset the scene, step, and record every state.

    Raises:
        CaseError: the scene is not built, or has another time step.
    """
    require_built(scene, case)
    scene.reset()
    states = record_states(scene.step, case.steps, lambda: read_body(box))
    return BodyTrace(times(case), *stacked(states))


def record_states(
    step: Callable[[], object], steps: int, read: Callable[[], Any]
) -> list[Any]:
    """Read the state, then step and read again, `steps` times; return the steps + 1 states.

    Args:
        step: advances the simulation by one outer step.
        steps: number of outer steps.
        read: returns the state now.
    """
    states = [read()]
    for _ in range(steps):
        step()
        states.append(read())
    return states


def stacked(states: Sequence[tuple[FloatArray, ...]]) -> tuple[FloatArray, ...]:
    """Return each array of a state for all states, with the states along a new first axis."""
    return tuple(np.stack(column) for column in zip(*states, strict=True))


def times(case: Any) -> FloatArray:
    """Return the times k · dt of the states of a case, (steps+1,) [s]."""
    return np.arange(case.steps + 1) * case.dt


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


def read_body(body: Any) -> tuple[FloatArray, ...]:
    """Return position (l, 3), orientation (l, 4), velocity and angular velocity (l, 3), now."""
    return (
        to_numpy(body.get_links_pos()),
        to_numpy(body.get_links_quat()),
        to_numpy(body.get_links_vel()),
        to_numpy(body.get_links_ang()),
    )
