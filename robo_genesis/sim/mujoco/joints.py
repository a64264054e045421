"""Control cases in MuJoCo, on the model file that Genesis reads, for comparison."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.joint_control import ControlCase, assemble
from robo_genesis.sim.bodies.rigid_bodies import record_states

from .kinematics import bare_spec, compiled, with_data

VERSION = version("mujoco")


def load(case: ControlCase, timestep: float, integrator: str) -> Any:
    """Compile the robot of a case with one bounded PD actuator per joint and no others.

    Nothing touches anything: no links touch each other in the course's runs.

    An affine actuator's force is gain · ctrl + bias[1] · q + bias[2] · q̇, clipped to
    its range. With (KP, −KP, −KV) and the target as ctrl, it is the PD law of the
    course.

    Raises:
        ModelError: MuJoCo cannot read the model, or its base moves freely.
    """
    import mujoco

    spec = bare_spec(case.model)
    settings = zip(case.model.joints, case.effort_limit, case.kp, case.kv, strict=True)
    for name, limit, kp, kv in settings:
        motor = bool(limit > 0)  # MuJoCo takes no actuator with an empty range
        actuator = spec.add_actuator(
            name=name,
            target=name,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            forcelimited=motor,
            forcerange=[-limit, limit],
        )
        actuator.set_to_position(kp=motor * kp, kv=motor * kv)
    spec.option.timestep = timestep
    spec.option.integrator = getattr(
        mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}"
    )
    return compiled(spec, case.model)


def run_case(
    case: ControlCase,
    links: Sequence[str],
    timestep: float,
    integrator: str = "implicitfast",
) -> Trace:
    """Run a case from rest as `joint_control.run_case` does, in MuJoCo.

    After each outer step the forces are computed again from the new state, so they have
    the same times as those of Genesis: the clipped control force, and the net force
    along each DOF. The run is computed in float64 and stored in float32, like every
    trace of the course.

    Args:
        case: its `substeps` is not used; `timestep` replaces it.
        links: bodies whose poses the trace holds, in this order.
        timestep: length of one solver step [s].
        integrator: "implicitfast" or "Euler".
    """
    import mujoco

    model, data, joints = with_data(load(case, timestep, integrator), case.model)
    bodies = [model.body(name).id for name in links]
    data.qpos[joints], data.ctrl[:] = case.q_start, case.q_target

    def read() -> tuple[FloatArray, ...]:
        mujoco.mj_forward(model, data)  # poses and forces of the state as it is now
        net = (data.qfrc_smooth + data.qfrc_constraint)[joints]
        state = (data.qpos[joints], data.xpos[bodies], data.xquat[bodies])
        return tuple(map(_kept, (*state, data.qvel[joints], data.actuator_force, net)))

    substeps = round(case.dt / timestep)
    readings = record_states(
        lambda: mujoco.mj_step(model, data, nstep=substeps), case.steps, read
    )
    effort_limit = _kept(model.actuator_forcerange[:, 1])
    return assemble(case, readings, [case.q_target] * case.steps, effort_limit)


def _kept(values: FloatArray) -> FloatArray:
    """Return a copy in the precision of the course's traces."""
    return np.array(values, dtype=np.float32)
