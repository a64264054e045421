"""A table with a robot, one object, a bowl and a ball: its settings, and the scene built of them.

The base of the robot is at the world's origin, on the table, so z = 0 is its surface.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.franka import FRANKA_MJCF
from robo_genesis.sim.arm.joint_control import Controlled

from . import bowl
from .rigid_bodies import new_scene

# Size of the table's top [m], and its centre (x, y).
TABLE = ((1.2, 0.8, 0.05), (0.45, 0.0))

SHELF = (0.16, 0.14, 0.02)  # Size of a shelf [m]

FLOOR = -0.75  # Height of the floor [m]

# The camera in the frame of the hand, z backwards: it looks along the fingers [m].
ON_HAND = ((0.0, -1, 0, 0.05), (-1, 0, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1))

BALL_HEIGHT = 0.07  # Centre of the ball at its start [m]

# Centre x and y, length and width of an upright rectangle [m].
Footprint = tuple[float, float, float, float]


def gap(one: Footprint, other: Footprint) -> float:
    """Return the distance of two footprints [m], negative where they overlap."""
    apart = np.abs(np.subtract(one[:2], other[:2])) - np.add(one[2:], other[2:]) / 2
    return float(np.hypot(*apart) if (apart > 0).all() else apart.max())


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCase(Controlled):
    """A table scene with one object, a bowl and a ball above it; the robot holds its start.

    `shape` is "cylinder" or "box", `size` its length, width and height [m]. `place` is
    the middle of its lower face on its support, which is a shelf if it is not at z = 0.
    It starts `gap` [m] above the support; gravity does not act on it if it is
    `weightless`. `density` [kg/m³]; `friction` is that of the object, and with `pads`
    that of the robot is set as well. `cone` is "pyramidal" or "elliptic"; gravity does
    not act on the robot if it is `compensated`. `bowl` is a choice of collision
    geometry, `bowl_at` (x, y) its place; a ball of `ball_radius` [m] falls into it, none if that
    is 0. `fov` is that of the camera in the world [degree].
    """

    shape: str
    size: tuple[float, float, float]
    place: tuple[float, float, float]
    gap: float = 0.0
    weightless: bool = False
    density: float = 400.0
    friction: float = 0.8
    pads: float | None = None
    cone: str = "pyramidal"
    compensated: bool = False
    bowl: str = "default"
    bowl_at: tuple[float, float] = (0.55, 0.22)
    ball_radius: float = 0.008
    fov: float = 42.0

    @property
    def volume(self) -> float:
        """Volume of the object [m³]."""
        return float(np.prod(self.size)) * (
            np.pi / 4 if self.shape == "cylinder" else 1.0
        )

    @property
    def centre(self) -> FloatArray:
        """Centre (3,) of the object at its start [m]."""
        x, y, z = self.place
        return np.array([x, y, z + self.gap + self.size[2] / 2])

    @property
    def boxes(self) -> dict[str, FloatArray]:
        """Lowest and highest corner (2, 3) of object, bowl, table and shelf, as meant [m]."""
        x, y, z = self.place
        wide = 2 * bowl.RIM * np.cos(np.pi / bowl.SECTIONS)
        found = {
            "object": ((x, y, z + self.gap), self.size),
            "bowl": ((*self.bowl_at, 0.0), (wide, wide, bowl.HEIGHT)),
            "table": ((*TABLE[1], -TABLE[0][2]), TABLE[0]),
        }
        if z:
            found["shelf"] = ((x, y, z - SHELF[2]), SHELF)
        return {
            name: np.add(low, [(-a / 2, -b / 2, 0), (a / 2, b / 2, c)])
            for name, (low, (a, b, c)) in found.items()
        }

    @property
    def shapes(self) -> tuple[Any, ...]:
        """What a built scene keeps of what scenes of a page differ in; the rest can be changed."""
        own = self.shape, self.size, self.weightless, self.bowl, self.fov
        return *own, self.place[2] != 0

    def corners(self, centre: FloatArray) -> FloatArray:
        """Return corners (n, 3) of the upright object, 64 for each circle of a cylinder [m]."""
        around = np.linspace(0, 2 * np.pi, 64, endpoint=False)
        plan = np.column_stack([np.cos(around), np.sin(around)])
        if self.shape == "box":
            plan = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)])
        levels = [np.insert(plan.astype(float), 2, side, axis=1) for side in (-1, 1)]
        return np.asarray(centre) + np.vstack(levels) * np.array(self.size) / 2


class World(NamedTuple):
    """A built scene: its robot, object, ball or None, cameras by name, and what does not move."""

    scene: Any
    robot: Any
    body: Any
    ball: Any
    fixed: Sequence[Any]
    cameras: dict[str, Any]

    @property
    def parts(self) -> dict[str, Any]:
        """Entities by the names of `SceneCase.boxes`."""
        table, *others, basin = self.fixed
        shelf = {"shelf": others[4]} if len(others) > 4 else {}
        return {"object": self.body, "bowl": basin, "table": table} | shelf


def arrange(world: World, case: SceneCase) -> None:
    """Put object, bowl, ball and shelf where a case has them, in a scene of equal `shapes`."""
    parts = world.parts
    parts["object"].set_pos(case.centre)
    parts["bowl"].set_pos((*case.bowl_at, 0.0))
    world.ball.set_pos((*case.bowl_at, BALL_HEIGHT))
    if "shelf" in parts:
        parts["shelf"].set_pos(case.boxes["shelf"].mean(axis=0))


def build(
    gs: Any,
    case: SceneCase,
    view: dict[str, Any] | None = None,
    wrist: dict[str, Any] | None = None,
    film: dict[str, Any] | None = None,
    n_envs: int = 0,
    **options: Any,
) -> World:
    """Declare a table scene and build it.

    Args:
        gs: the engine after `gs.init`.
        case: the settings.
        view: arguments of the camera in the world, None without one.
        wrist: arguments of the camera on the hand, None without one.
        film: arguments of a second camera in the world, None without one.
        n_envs: number of environments, 0 for a scene without.
        options: further ones of `gs.options.RigidOptions`.
    """
    if case.cone == "elliptic":
        options["friction_cone"] = gs.friction_cone.elliptic
    scene = new_scene(gs, case, options, first_only=n_envs > 0)

    def block(
        size: Sequence[float],
        x: float,
        y: float,
        top: float,
        shade: float = 0.6,
        **morph: Any,
    ) -> Any:
        """Add a fixed box by its top."""
        pos = (x, y, top - size[2] / 2)
        return scene.add_entity(
            gs.morphs.Box(size=tuple(size), pos=pos, fixed=True, **morph),
            material=gs.materials.Rigid(friction=0.8),
            surface=gs.surfaces.Default(color=(shade, shade, shade - 0.05, 1.0)),
        )

    scene.add_entity(gs.morphs.Plane(pos=(0, 0, FLOOR)))
    (length, width, thick), (x, y) = TABLE
    corners = [
        (x + s * (length / 2 - 0.04), y + t * (width / 2 - 0.04))
        for s in (-1, 1)
        for t in (-1, 1)
    ]
    fixed = [block(TABLE[0], x, y, 0.0)]
    # Nothing reaches the legs, and each would cost time in every step.
    leg = (0.05, 0.05, -FLOOR - thick)
    fixed += [block(leg, *at, -thick, 0.5, collision=False) for at in corners]
    if case.place[2]:
        fixed.append(block(SHELF, *case.place, 0.5))
    robot = scene.add_entity(
        gs.morphs.MJCF(file=FRANKA_MJCF),
        material=gs.materials.Rigid(
            friction=case.pads, gravity_compensation=float(case.compensated)
        ),
    )
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
            rho=case.density,
            friction=case.friction,
            gravity_compensation=float(case.weightless),
        ),
        surface=gs.surfaces.Default(color=(0.10, 0.50, 0.80, 1.0)),
    )
    green = gs.surfaces.Default(color=(0.30, 0.60, 0.30, 1.0))
    basin = bowl.add(
        gs, scene, case.bowl, (*case.bowl_at, 0.0), surface=green, friction=0.8
    )
    ball = None
    if case.ball_radius:
        ball = scene.add_entity(
            gs.morphs.Sphere(radius=case.ball_radius, pos=(*case.bowl_at, BALL_HEIGHT)),
            material=gs.materials.Rigid(rho=1000.0),
            surface=gs.surfaces.Default(color=(0.90, 0.50, 0.10, 1.0)),
        )
    given = {"wrist": wrist} | {
        name: of and of | {"fov": case.fov}
        for name, of in (("world", view), ("film", film))
    }
    cameras = {name: scene.add_camera(**of) for name, of in given.items() if of}
    scene.build(n_envs=n_envs)
    if wrist:
        cameras["wrist"].attach(robot.get_link("hand"), np.array(ON_HAND))
    return World(scene, robot, body, ball, [*fixed, basin], cameras)
