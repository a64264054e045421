"""Boxes that two pads hold, in MuJoCo, with pads and contact parameters of Genesis."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.kinematics import rotate
from robo_genesis.sim.bodies.grippers import PAD, SIZE, HeldCase, pads
from robo_genesis.sim.bodies.rigid_bodies import record_states, stacked, times
from robo_genesis.sim.bodies.soft_contact import impratio

# Directions in which the left and the right pad press
AXES = np.array([[1.0, 0, 0], [-1, 0, 0]])


def load(case: HeldCase) -> Any:
    """Compile the pads of `grippers.pads` and the box, with a constant force on each pad."""
    import mujoco

    press = "".join(
        f'<general joint="{j}" gainprm="0" biastype="affine" biasprm="{case.force} 0 0"/>'
        for j in "lr"
    )
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
    <option timestep="{case.h}" gravity="0 0 {-case.gravity}" cone="{case.cone}"
     impratio="{impratio(case)}" noslip_iterations="{case.noslip}"
     iterations="{case.iterations or 100}" integrator="implicitfast"/>
    <worldbody><body pos="0 {case.place} 0">{pads(case)}</body>
    <body name="box" pos="0 {case.place} 0"><freejoint/>
    <geom type="box" size="{SIZE / 2} {SIZE / 2} {SIZE / 2}" mass="{case.mass}"
     friction="{case.friction} 0 0" solref="{case.time_constant} 1"/></body></worldbody>
    <actuator>{press}</actuator></mujoco>""")


def run_case(case: HeldCase) -> BodyTrace:
    """Run a case as `grippers.record_world` does, computed in float64, stored in float32."""
    import mujoco

    model = load(case)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(case.settle / case.h))
    states = record_states(
        lambda: mujoco.mj_step(model, data, nstep=case.substeps),
        case.steps,
        lambda: _links(case, data),
    )
    return BodyTrace(times(case), *stacked(states))


def _links(case: HeldCase, data: Any) -> tuple[FloatArray, ...]:
    """Return position, orientation, velocity and angular velocity of `LINKS`, (3, 3 or 4)."""
    quat, still = data.qpos[5:9], np.zeros((2, 3))
    home = np.array([0, case.place, 0]) - (SIZE / 2 + PAD[0]) * AXES
    parts = (
        (data.qpos[2:5], home + data.qpos[:2, None] * AXES),
        (quat, np.tile([1.0, 0, 0, 0], (2, 1))),
        (data.qvel[2:5], data.qvel[:2, None] * AXES),
        (rotate(quat, data.qvel[5:8]), still),
    )
    return tuple(np.vstack(part).astype(np.float32) for part in parts)
