"""What a table scene of L07 does: it rests, and the robot tries to lift its object."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import lifting
from robo_genesis.sim.arm.engine_kinematics import IkSettings
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.bodies.table import SceneCase, World


@dataclass(frozen=True, slots=True, kw_only=True)
class LiftCase(SceneCase):
    """The same scene; the object begins at the `spot` (x, y), and the robot tries to lift it."""

    spot: tuple[float, float] = (0.55, 0.0)
    settings: IkSettings

    @property
    def centre(self) -> FloatArray:
        """Centre (3,) of the object at the spot [m]."""
        return np.array([*self.spot, self.gap + self.size[2] / 2])


def rest(world: World, joints: JointMap, case: SceneCase) -> tuple[Trace, float]:
    """Let the scene rest while the robot holds its start.

    Returns:
        The run, and the depth of the object's deepest contact after the first step [m].
    """
    depths: list[float] = []

    def after(step: int) -> None:
        if step == 0:
            depths.append(float(to_numpy(world.body.get_contacts()["penetration"]).max(initial=0)))

    held = case.commanding(case.q_start)
    trace = run_case(world.scene, world.robot, joints, held, (world.body, world.ball), after=after)
    return trace, depths[0]


def lift(world: World, joints: JointMap, case: LiftCase) -> tuple[Trace, dict[str, int]]:
    """Lift the object from the spot; return the run and the counts of `contact_counter`."""
    points = lifting.waypoints((*case.spot, 0.0), case.size[2])
    answers = lifting.ask(world.robot, joints, case.q_start, case.settings, points)
    command = case.commanding(lifting.lift_command(case.q_start, answers))
    counts, after = lifting.contact_counter(world.robot, world.body)
    bodies = (world.body, world.ball)

    def begin() -> None:
        world.body.set_pos(case.centre)

    return run_case(world.scene, world.robot, joints, command, bodies, begin, after), counts
