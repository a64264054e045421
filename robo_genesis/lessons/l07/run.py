"""What a table scene of L07 does: it rests, and the robot tries to lift its object."""

from typing import Any

from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import lifting
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.arm.reaching import ONE_START
from robo_genesis.sim.bodies.table import SceneCase, World


def lifts(case: Any) -> bool:
    """Return whether a case is a lift, which has the steps of all its phases."""
    return bool(case.steps == lifting.ENDS["hold"])


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


def lift(world: World, joints: JointMap, case: SceneCase) -> tuple[Trace, dict[str, int]]:
    """Lift the object from the place of a lift; return run and counts of `contact_counter`."""
    points = lifting.waypoints(case.place, case.size[2])
    answers = lifting.ask(world.robot, joints, case.q_start, ONE_START, points)
    command = case.commanding(lifting.lift_command(case.q_start, answers))
    counts, after = lifting.contact_counter(world.robot, world.body)
    bodies = (world.body, world.ball)

    def begin() -> None:
        world.body.set_pos(case.centre)

    return run_case(world.scene, world.robot, joints, command, bodies, begin, after), counts
