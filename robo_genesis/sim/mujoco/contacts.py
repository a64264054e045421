"""Contact cases in MuJoCo with the contact parameters of Genesis, for comparison."""

from importlib.metadata import version
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, ContactTrace
from robo_genesis.sim.arm.kinematics import rotate
from robo_genesis.sim.bodies.contacts import SURFACE_SIZE, TOP, ContactCase
from robo_genesis.sim.bodies.rigid_bodies import record_states, stacked, times
from robo_genesis.sim.bodies.soft_contact import IMPEDANCE, time_constant

VERSION = version("mujoco")

OWN_TIME_CONSTANT = 0.02  # MuJoCo's default [s]

# The arrays of a state, in MuJoCo's order.
MOTION = ("link_pos", "link_quat", "link_vel", "link_ang")


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


def each_step(trace: BodyTrace, case: ContactCase) -> dict[str, FloatArray]:
    """Return what follows from each state of a run but the last in one outer step, by array."""
    import mujoco
    from mujoco import rollout

    model = load(case)
    position, quat, velocity, spin = (
        getattr(trace, name)[:-1, 0].astype(np.float64) for name in MOTION
    )
    spin = rotate(quat * [1, -1, -1, -1], spin)  # MuJoCo has it in the body's axes
    begin = np.hstack([np.zeros((trace.steps, 1)), position, quat, velocity, spin])
    data = [mujoco.MjData(model)]
    ends, _ = rollout.rollout(model, data, begin, nstep=case.substeps)
    _, position, quat, velocity, spin = np.split(ends[:, -1], (1, 4, 8, 11), axis=1)
    after = (position, quat, velocity, rotate(quat, spin))
    return dict(zip(MOTION, after, strict=True))


def _state(data: Any) -> tuple[np.ndarray, ...]:
    """Return position, orientation, velocity, angular velocity in the world's axes, contacts."""
    quat = data.qpos[3:7]
    # MuJoCo has it in the body's axes
    angular_velocity = rotate(quat, data.qvel[None, 3:6])
    deepest = max((-contact.dist for contact in data.contact), default=0.0)
    state = (data.qpos[None, :3], quat[None], data.qvel[None, :3], angular_velocity)
    return (
        *(np.array(values, np.float32) for values in state),
        np.array([data.ncon], np.int32),
        np.array([max(deepest, 0.0)], np.float32),
    )
