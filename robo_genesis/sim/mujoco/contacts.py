"""Contact cases in MuJoCo with the contact parameters of Genesis, for comparison."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, ContactTrace
from robo_genesis.sim.arm.kinematics import rotate
from robo_genesis.sim.bodies.contacts import SURFACE_SIZE, TOP, ContactCase
from robo_genesis.sim.bodies.rigid_bodies import record_states, stacked, times

VERSION = version("mujoco")

# Default of Genesis for contacts, unless two solver steps are longer [s].
DEFAULT_TIME_CONSTANT = 0.01

OWN_TIME_CONSTANT = 0.02  # MuJoCo's default [s]

# The arrays of a state, in MuJoCo's order.
MOTION = ("link_pos", "link_quat", "link_vel", "link_ang")

# Impedance of a contact as a function of depth, the default of both engines.
IMPEDANCE = (0.9, 0.95, 0.001, 0.5, 2.0)


def time_constant(h: float, requested: float | None = None) -> float:
    """Return the time constant of a contact in Genesis at solver step `h` [s].

    Args:
        h: the solver step [s].
        requested: `constraint_timeconst` [s], None for the default.
    """
    return max(DEFAULT_TIME_CONSTANT if requested is None else requested, 2 * h)


def impedance(depth: float) -> float:
    """Return the impedance d of a contact at a depth [m]."""
    least, most, width, middle, power = IMPEDANCE
    x = min(depth / width, 1.0)
    low, high = (
        x**power / middle ** (power - 1),
        (1 - x) ** power / (1 - middle) ** (power - 1),
    )
    return float(least + (most - least) * (low if x < middle else 1 - high))


def load(case: ContactCase, own_defaults: bool = False) -> Any:
    """Compile the surface and one free body with the case's step, friction, cone and spring.

    Args:
        case: of a cube or a ball.
        own_defaults: use the default time constant of MuJoCo instead of that of
            Genesis.
    """
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.timestep = case.h
    spec.option.gravity = case.fall
    spec.option.cone = getattr(mujoco.mjtCone, f"mjCONE_{case.cone.upper()}")
    spec.option.impratio = case.impratio or 1.0
    spec.option.noslip_iterations = case.noslip
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    seconds = (
        OWN_TIME_CONSTANT if own_defaults else time_constant(case.h, case.time_constant)
    )
    contact = {"solref": case.spring or (seconds, 1.0), "solimp": IMPEDANCE}
    box, ball = mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_SPHERE
    spec.worldbody.add_geom(
        type=box,
        size=np.array(SURFACE_SIZE) / 2,
        pos=(0, 0, TOP - SURFACE_SIZE[2] / 2),
        friction=(case.surface_friction, 0, 0),
        **contact,
    )
    body = spec.worldbody.add_body(pos=case.start)
    body.add_freejoint()
    body.add_geom(
        type=box if case.shape == "cube" else ball,
        size=(case.size / 2,) * 3,
        density=case.density,
        friction=(case.friction, 0, 0),
        **contact,
    )
    return spec.compile()


def run_case(case: ContactCase, own_defaults: bool = False) -> ContactTrace:
    """Run a case as `contacts.run_world` does, computed in float64, stored in float32.

    The contacts are those of the beginning of the latest solver step, as in Genesis.

    Args:
        case: of a cube or a ball.
        own_defaults: as in `load`.
    """
    import mujoco

    model = load(case, own_defaults)
    data = mujoco.MjData(model)
    settle = round(case.settle / case.h)
    if settle:
        mujoco.mj_step(model, data, nstep=settle)
    data.qvel[0] += case.speed
    states = record_states(
        lambda: mujoco.mj_step(model, data, nstep=case.substeps),
        case.steps,
        lambda: _state(data),
    )
    return ContactTrace(times(case), *stacked(states))


def after_one_step(
    model: Any, states: Sequence[FloatArray], substeps: int
) -> FloatArray:
    """Return time, positions and velocities (n, 1 + nq + nv) one outer step after states.

    Args:
        model: compiled.
        states: parts (n, …) of the states in MuJoCo's order, without the time.
        substeps: solver steps of an outer step.
    """
    import mujoco
    from mujoco import rollout

    begin = np.hstack([np.zeros((len(states[0]), 1)), *states])
    ends, _ = rollout.rollout(model, [mujoco.MjData(model)], begin, nstep=substeps)
    return np.asarray(ends)[:, -1]


def each_step(
    trace: BodyTrace, case: ContactCase, own_defaults: bool = False
) -> dict[str, FloatArray]:
    """Return what follows from each state of a run but the last in one outer step, by array.

    The arguments are as of `run_case`.
    """
    states = {name: getattr(trace, name)[:-1, 0].astype(np.float64) for name in MOTION}
    position, quat, velocity, spin = states.values()
    spin = rotate(quat * [1, -1, -1, -1], spin)  # MuJoCo has it in the body's axes
    begin = (position, quat, velocity, spin)
    ends = after_one_step(load(case, own_defaults), begin, case.substeps)
    _, position, quat, velocity, spin = np.split(ends, (1, 4, 8, 11), axis=1)
    return dict(
        zip(MOTION, (position, quat, velocity, rotate(quat, spin)), strict=True)
    )


def _state(data: Any) -> tuple[np.ndarray, ...]:
    """Return position, orientation, velocity, angular velocity in the world's axes, contacts."""
    quat = data.qpos[3:7]
    angular_velocity = rotate(
        quat, data.qvel[None, 3:6]
    )  # MuJoCo has it in the body's axes
    deepest = max((-contact.dist for contact in data.contact), default=0.0)
    state = (data.qpos[None, :3], quat[None], data.qvel[None, :3], angular_velocity)
    return (
        *(np.array(values, np.float32) for values in state),
        np.array([data.ncon], np.int32),
        np.array([max(deepest, 0.0)], np.float32),
    )
