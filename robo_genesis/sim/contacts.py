"""The experiments that students read: bodies on a surface, let go or pushed, and recorded."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.free_fall import GRAVITY
from robo_genesis.core.scene import DT, SUBSTEPS, FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.joints import to_numpy
from robo_genesis.sim.rigid_bodies import read_body

SURFACE_SIZE = (2.0, 0.8, 0.05)
"""Length, width and thickness of the fixed box that everything lands on [m]."""

TOP = 0.725
"""Height of its upper face [m]."""

VALID: Mapping[str, tuple[str | None, ...]] = {
    "shape": ("cube", "ball"),
    "cone": ("pyramidal", "elliptic"),
    "resolution": (None, "convex", "signorini"),
}

SHARED = (
    "surface_friction", "duration", "settle", "dt", "substeps", "cone", "resolution", "impratio",
    "gravity",
)  # fmt: skip
"""What cases that share one scene must agree in."""

SETTINGS = ("friction", "surface_friction", "substeps")
"""What no array shows of a run, and is read back from the scene that made it."""

LANDING, SLIDE, BOUNCE = "landing", "slide", "bounce"

State = tuple[FloatArray, FloatArray, FloatArray, FloatArray, np.ndarray, FloatArray]


class ContactError(ValueError):
    """A run that must not be made; the message says what was found, and what is valid."""


@dataclass(frozen=True, slots=True)
class ContactCase:
    """Everything that decides one run of a body above or on the surface.

    `start` is the place of its centre [m]; `size` the edge of a cube or the diameter of a ball [m];
    `density` [kg/m³]; `friction` its own coefficient, `surface_friction` that of the surface.
    After `settle` seconds of steps it gets `speed` along x [m/s], and `duration` seconds are
    recorded. `cone` is the engine's shape of friction, `resolution` how it weighs a contact's push
    and friction against each other, `impratio` how much stiffer friction is than the push; the
    last two are None for what the engine chooses with the cone. `spring` are time constant [s] and
    damping ratio of the contact, None for the engine's own. `gravity` is a magnitude [m/s²].
    """

    start: tuple[float, float, float]
    duration: float
    friction: float = 0.5
    surface_friction: float = 0.8
    speed: float = 0.0
    settle: float = 0.0
    shape: str = "cube"
    size: float = 0.08
    density: float = 500.0
    dt: float = DT
    substeps: int = SUBSTEPS
    cone: str = "pyramidal"
    resolution: str | None = None
    impratio: float | None = None
    spring: tuple[float, float] | None = None
    gravity: float = GRAVITY

    def __post_init__(self) -> None:
        for name, valid in VALID.items():
            if (given := getattr(self, name)) not in valid:
                known = " or ".join(map(repr, valid))
                raise ContactError(f"The {name} {given!r} was given, valid is {known}.")
        for name, seconds in (("duration", self.duration), ("settle", self.settle)):
            if abs(round(seconds / self.dt) * self.dt - seconds) > 1e-9:
                raise ContactError(
                    f"{name} is {seconds} s, no whole number of outer steps of {self.dt} s. "
                    "Cases are compared over equal simulated time: choose one that divides it."
                )

    @property
    def h(self) -> float:
        """Length of one solver step [s]."""
        return self.dt / self.substeps

    @property
    def steps(self) -> int:
        """Outer steps that are recorded."""
        return round(self.duration / self.dt)

    @property
    def mass(self) -> float:
        """What the body weighs if it is solid [kg]."""
        volume = self.size**3 * (1.0 if self.shape == "cube" else np.pi / 6)
        return float(self.density * volume)

    @property
    def inertia(self) -> float:
        """Its moment of inertia about any axis through the centre [kg·m²]."""
        return self.mass * self.size**2 * (1 / 6 if self.shape == "cube" else 1 / 10)

    @property
    def rest_height(self) -> float:
        """Height of the centre when it lies on the surface and does not sink in [m]."""
        return TOP + self.size / 2

    @property
    def kind(self) -> str:
        """What is asked of it: how it lands, slides or bounces."""
        if self.spring:
            return BOUNCE
        return SLIDE if self.speed else LANDING


@dataclass(frozen=True, slots=True)
class World:
    """A built scene: the surface, one body for each case, and a camera if one was asked for."""

    scene: Any
    surface: Any
    bodies: Mapping[str, Any]
    cases: Mapping[str, ContactCase]
    camera: Any = None


def build_world(
    gs: Any, cases: Mapping[str, ContactCase], view: Mapping[str, Any] | None = None
) -> World:
    """Declare a scene with the surface and a body for each case, and build it.

    Args:
        gs: the engine, started.
        cases: by name; in one scene they share surface, time and step.
        view: of a camera, None for none.

    Raises:
        ContactError: there are no cases, or they do not agree in what a scene has once.
    """
    common = shared_case(cases)
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(
            dt=common.dt, substeps=common.substeps, gravity=(0.0, 0.0, -common.gravity)
        ),
        rigid_options=gs.options.RigidOptions(**friction_options(gs, common)),
        profiling_options=gs.options.ProfilingOptions(show_FPS=False),  # no speed in the log
        show_viewer=False,
    )
    surface = scene.add_entity(
        morph=gs.morphs.Box(
            size=SURFACE_SIZE, pos=(0.0, 0.0, TOP - SURFACE_SIZE[2] / 2), fixed=True
        ),
        material=gs.materials.Rigid(friction=common.surface_friction),
        surface=gs.surfaces.Default(color=(0.62, 0.60, 0.56, 1.0)),
    )
    colours = ((0.90, 0.50, 0.10, 1.0), (0.16, 0.45, 0.70, 1.0))
    bodies = {
        name: scene.add_entity(
            morph=(
                gs.morphs.Box(size=(case.size,) * 3, pos=case.start)
                if case.shape == "cube"
                else gs.morphs.Sphere(radius=case.size / 2, pos=case.start)
            ),
            material=gs.materials.Rigid(rho=case.density, friction=case.friction),
            surface=gs.surfaces.Default(color=colours[place % len(colours)]),
        )
        for place, (name, case) in enumerate(cases.items())
    }
    camera = scene.add_camera(**view) if view else None
    scene.build()
    for name, case in cases.items():
        if case.spring:
            for geom in (*surface.geoms, *bodies[name].geoms):
                geom.set_sol_params((*case.spring, *contact_constants(scene, geom)[2:]))
    return World(scene, surface, bodies, dict(cases), camera)


def friction_options(gs: Any, case: ContactCase) -> dict[str, Any]:
    """Return a case's model of friction as options of the engine; what is None stays its own."""
    resolution = gs.contact_resolution[case.resolution] if case.resolution else None
    return {
        "friction_cone": gs.friction_cone[case.cone],
        "contact_resolution": resolution,
        "impratio": case.impratio,
    }


def contact_constants(scene: Any, geom: Any) -> FloatArray:
    """Return the solver's seven numbers of a geom's contacts; the first is the time constant [s].

    Damping ratio and impedance follow. What a contact uses is no shorter than two solver steps.
    """
    return to_numpy(scene.rigid_solver.get_sol_params(geoms_idx=[geom.idx]))[0]


def time_constant(world: World) -> float:
    """Return the time constant that the solver has of the surface's contacts [s]."""
    return float(contact_constants(world.scene, world.surface.geoms[0])[0])


def read_settings(world: World) -> dict[str, dict[str, float]]:
    """Return what the built scene has of `SETTINGS`, by case."""
    solver, substeps = world.scene.rigid_solver, float(world.scene.substeps)

    def friction(body: Any) -> float:
        return float(to_numpy(solver.get_geoms_friction([body.geoms[0].idx]))[0])

    surface = friction(world.surface)
    return {
        "friction": {name: friction(body) for name, body in world.bodies.items()},
        "surface_friction": dict.fromkeys(world.bodies, surface),
        "substeps": dict.fromkeys(world.bodies, substeps),
    }


def record_world(
    world: World,
    traces: dict[str, ContactTrace],
    settings: dict[str, dict[str, float]],
) -> None:
    """Run a world, and add its traces and what was read of its settings to those of others."""
    traces |= run_world(world)
    for name, found in read_settings(world).items():
        settings.setdefault(name, {}).update(found)


def run_world(world: World) -> dict[str, ContactTrace]:
    """Bring the scene back to its start, settle, push, step; record every state of each body."""
    common = shared_case(world.cases)
    world.scene.reset()
    for _ in range(round(common.settle / common.dt)):
        world.scene.step()
    for name, case in world.cases.items():
        if case.speed:
            world.bodies[name].set_dofs_velocity(np.array([case.speed, 0, 0, 0, 0, 0]))
    states = [read_world(world)]
    for _ in range(common.steps):
        world.scene.step()
        states.append(read_world(world))
    t = np.arange(common.steps + 1) * common.dt
    return {
        name: ContactTrace(t, *(np.stack(c) for c in zip(*(s[name] for s in states), strict=True)))
        for name in world.cases
    }


def read_world(world: World) -> dict[str, State]:
    """Return each body's place, orientation, velocity, angular velocity now, and its contacts.

    Contacts are counted, and the deepest measured; the engine found them when it last looked.
    """
    states = {}
    for name, body in world.bodies.items():
        depths = to_numpy(body.get_contacts(with_entity=world.surface)["penetration"])
        count = np.array([len(depths)], np.int32)
        deepest = np.array([depths.max(initial=0.0)], np.float32)
        states[name] = (*read_body(body), count, deepest)
    return states


def shared_case(cases: Mapping[str, ContactCase]) -> ContactCase:
    """Return the first case, for what all of them share.

    Raises:
        ContactError: there are none, or they differ in what one scene has once.
    """
    if not cases:
        raise ContactError("No cases were given; a scene takes at least one.")
    first = next(iter(cases.values()))
    for name, case in cases.items():
        for field in SHARED:
            if getattr(case, field) != getattr(first, field):
                raise ContactError(
                    f"{name} asks for {field}={getattr(case, field)}, another case of the scene "
                    f"for {getattr(first, field)}. Give it a scene of its own."
                )
    return first
