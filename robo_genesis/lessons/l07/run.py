"""Table scenes of L07: let one rest, look at it, ask for postures, and lift its object.

The base of the robot is at the world's origin, on the table, so z = 0 is its surface.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l07 import bowls
from robo_genesis.sim.arm import lifting
from robo_genesis.sim.arm.engine_kinematics import IkSettings
from robo_genesis.sim.arm.franka import FRANKA_MJCF
from robo_genesis.sim.arm.joint_control import Controlled, run_case
from robo_genesis.sim.arm.joints import JointMap, to_numpy

TABLE = ((1.2, 0.8, 0.05), (0.45, 0.0))
"""Size of the table's top [m], and its centre (x, y)."""

FLOOR = -0.75  # Height of the floor [m]

ON_HAND = ((0.0, -1, 0, 0.05), (-1, 0, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1))
"""The camera in the frame of the hand, z backwards: it looks along the fingers [m]."""

BALL_HEIGHT = 0.07  # Centre of the ball at its start [m]


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCase(Controlled):
    """A table scene with one object, a bowl and a ball above it; the robot holds its start.

    `shape` is "cylinder" or "box", `size` its length, width and height [m]. `place` is the middle
    of its lower face on its support, which is a shelf if it is not at z = 0. It starts `gap` [m]
    above the support; gravity does not act on it if it is `weightless`. `density` [kg/m³];
    `friction` is that of the object, and with `pads` that of the robot is set as well. `bowl`
    is a choice of collision geometry, `bowl_at` (x, y) its place; the ball falls into it from
    `ball_at` (3,) [m]. `fov` is that of the camera in the world [degree].
    """

    shape: str
    size: tuple[float, float, float]
    place: tuple[float, float, float]
    gap: float = 0.0
    weightless: bool = False
    density: float = 400.0
    friction: float = 0.8
    pads: float | None = None
    bowl: str = "default"
    bowl_at: tuple[float, float] = (0.55, 0.22)
    ball_radius: float = 0.008
    fov: float = 42.0

    @property
    def volume(self) -> float:
        """Volume of the object [m³]."""
        return float(np.prod(self.size)) * (np.pi / 4 if self.shape == "cylinder" else 1.0)

    @property
    def centre(self) -> FloatArray:
        """Centre (3,) of the object at its start [m]."""
        x, y, z = self.place
        return np.array([x, y, z + self.gap + self.size[2] / 2])


@dataclass(frozen=True, slots=True, kw_only=True)
class LiftCase(SceneCase):
    """The same scene; the object begins at the `spot` (x, y), and the robot tries to lift it."""

    spot: tuple[float, float] = (0.55, 0.0)
    settings: IkSettings

    @property
    def centre(self) -> FloatArray:
        """Centre (3,) of the object at the spot [m]."""
        return np.array([*self.spot, self.gap + self.size[2] / 2])


@dataclass(frozen=True, slots=True)
class World:
    """A built scene: its robot, object, ball, cameras by name, and all that does not move."""

    scene: Any
    robot: Any
    body: Any
    ball: Any
    bowl: Any
    fixed: Sequence[Any]
    cameras: dict[str, Any]


def build(gs: Any, case: SceneCase, view: dict[str, Any], wrist: dict[str, Any]) -> World:
    """Declare a table scene and build it."""
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=case.dt, substeps=case.substeps),
        profiling_options=gs.options.ProfilingOptions(show_FPS=False),
        show_viewer=False,
    )

    def block(size: Sequence[float], x: float, y: float, top: float, shade: float = 0.6) -> Any:
        """Add a fixed box by its top."""
        return scene.add_entity(
            gs.morphs.Box(size=tuple(size), pos=(x, y, top - size[2] / 2), fixed=True),
            material=gs.materials.Rigid(friction=0.8),
            surface=gs.surfaces.Default(color=(shade, shade, shade - 0.05, 1.0)),
        )

    scene.add_entity(gs.morphs.Plane(pos=(0, 0, FLOOR)))
    (length, width, thick), (x, y) = TABLE
    corners = [
        (x + s * (length / 2 - 0.04), y + t * (width / 2 - 0.04)) for s in (-1, 1) for t in (-1, 1)
    ]
    fixed = [block(TABLE[0], x, y, 0.0)]
    fixed += [block((0.05, 0.05, -FLOOR - thick), *at, -thick, 0.5) for at in corners]
    if case.place[2]:
        fixed.append(block((0.16, 0.14, 0.02), *case.place, 0.5))
    pads = gs.materials.Rigid(friction=case.pads) if case.pads else None
    robot = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF), material=pads)
    morph = (
        gs.morphs.Box(size=case.size, pos=tuple(case.centre))
        if case.shape == "box"
        else gs.morphs.Cylinder(
            radius=case.size[0] / 2, height=case.size[2], pos=tuple(case.centre)
        )
    )
    body = scene.add_entity(
        morph,
        material=gs.materials.Rigid(
            rho=case.density, friction=case.friction, gravity_compensation=float(case.weightless)
        ),
        surface=gs.surfaces.Default(color=(0.10, 0.50, 0.80, 1.0)),
    )
    green = gs.surfaces.Default(color=(0.30, 0.60, 0.30, 1.0))
    bowl = bowls.add(gs, scene, case.bowl, (*case.bowl_at, 0.0), surface=green, friction=0.8)
    ball = scene.add_entity(
        gs.morphs.Sphere(radius=case.ball_radius, pos=(*case.bowl_at, BALL_HEIGHT)),
        material=gs.materials.Rigid(rho=1000.0),
        surface=gs.surfaces.Default(color=(0.90, 0.50, 0.10, 1.0)),
    )
    cameras = {
        "world": scene.add_camera(**view | {"fov": case.fov}),
        "wrist": scene.add_camera(**wrist),
    }
    scene.build()
    cameras["wrist"].attach(robot.get_link("hand"), np.array(ON_HAND))
    return World(scene, robot, body, ball, bowl, [*fixed, bowl], cameras)


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
