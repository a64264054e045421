"""Boxes that two pads hold, in MuJoCo, with pads and contact parameters of Genesis."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.kinematics import rotate
from robo_genesis.sim.bodies.grippers import PAD, SIZE, HeldCase, pads
from robo_genesis.sim.bodies.rigid_bodies import record_states, stacked, times
from robo_genesis.sim.mujoco.contacts import MOTION, after_one_step

AXES = np.array(
    [[1.0, 0, 0], [-1, 0, 0]]
)  # Directions in which the left and the right pad press


def load(case: HeldCase, as_genesis: bool = False) -> Any:
    """Compile the pads of `grippers.pads` and the box, with a constant force on each pad.

    Args:
        case: settings of the run.
        as_genesis: make the edges of a pyramid as soft as Genesis does. With μ² /
            impratio for each μ² it has 1 + μ² / impratio where MuJoCo has 1 + μ².
    """
    import mujoco

    ratio = ratio_of(case)
    if as_genesis and case.cone == "pyramidal":
        ratio *= (1 + case.friction**2) / (1 + case.friction**2 / ratio)
    press = "".join(
        f'<general joint="{j}" gainprm="0" biastype="affine" biasprm="{case.force} 0 0"/>'
        for j in "lr"
    )
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
    <option timestep="{case.h}" gravity="0 0 {-case.gravity}" cone="{case.cone}" impratio="{ratio}"
     noslip_iterations="{case.noslip}" iterations="{case.iterations or 100}"
     integrator="implicitfast"/>
    <worldbody><body pos="0 {case.place} 0">{pads(case)}</body>
    <body name="box" pos="0 {case.place} 0"><freejoint/>
    <geom type="box" size="{SIZE / 2} {SIZE / 2} {SIZE / 2}" mass="{case.mass}"
     friction="{case.friction} 0 0" solref="{case.time_constant} 1"/></body></worldbody>
    <actuator>{press}</actuator></mujoco>""")


def ratio_of(case: HeldCase) -> float:
    """Return `impratio` of a case; for None it is what Genesis chooses by the cone."""
    return case.impratio or (100.0 if case.cone == "elliptic" else 1.0)


def run_case(case: HeldCase, as_genesis: bool = False) -> BodyTrace:
    """Run a case as `grippers.record_world` does, computed in float64, stored in float32.

    The arguments are as of `load`.
    """
    import mujoco

    model = load(case, as_genesis)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(case.settle / case.h))
    states = record_states(
        lambda: mujoco.mj_step(model, data, nstep=case.substeps),
        case.steps,
        lambda: tuple(
            of[0].astype(np.float32)
            for of in links(case, data.qpos[None], data.qvel[None])
        ),
    )
    return BodyTrace(times(case), *stacked(states))


def each_step(
    trace: BodyTrace, case: HeldCase, as_genesis: bool
) -> dict[str, FloatArray]:
    """Return what follows from each state of a run but the last in one outer step, by array.

    The arguments are as of `load`.
    """
    position, quat, velocity, spin = (
        getattr(trace, name)[:-1].astype(np.float64) for name in MOTION
    )
    along = np.einsum("nlx,lx->nl", position[:, 1:], AXES) + SIZE / 2 + PAD[0]
    speed = np.einsum("nlx,lx->nl", velocity[:, 1:], AXES)
    turning = rotate(
        quat[:, 0] * [1, -1, -1, -1], spin[:, 0]
    )  # MuJoCo has it in the body's axes
    parts = (along, position[:, 0], quat[:, 0], speed, velocity[:, 0], turning)
    ends = after_one_step(load(case, as_genesis), parts, case.substeps)
    _, qpos, qvel, _ = np.split(ends, (1, 10, 18), axis=1)
    return dict(zip(MOTION, links(case, qpos, qvel), strict=True))


def links(case: HeldCase, qpos: FloatArray, qvel: FloatArray) -> tuple[FloatArray, ...]:
    """Return position, orientation, velocity and angular velocity of `LINKS`, (n, 3, 3 or 4)."""
    still, quat = np.zeros((len(qpos), 2, 3)), qpos[:, 5:9]
    home = np.array([0, case.place, 0]) - (SIZE / 2 + PAD[0]) * AXES
    unturned = np.broadcast_to([1.0, 0, 0, 0], (len(qpos), 2, 4))
    parts = (
        (qpos[:, None, 2:5], home + qpos[:, :2, None] * AXES),
        (quat[:, None], unturned),
        (qvel[:, None, 2:5], qvel[:, :2, None] * AXES),
        (rotate(quat, qvel[:, 5:8])[:, None], still),
    )
    return tuple(np.concatenate(of, axis=1) for of in parts)
