"""Bodies that land, slide and bounce on a surface: build the scene, run it, record the contacts."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, NamedTuple, TypeVar

import numpy as np

from robo_genesis.core.scene import FloatArray, Stepped
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.session import CaseError

from .free_fall import GRAVITY
from .rigid_bodies import new_scene, read_body, record_states, stacked, times
from .soft_contact import Load

# Length, width and thickness of the fixed box under the bodies [m].
SURFACE_SIZE = (2.0, 0.8, 0.05)

TOP = 0.725  # Height of its upper face [m]

# Settings that no array of a run shows; they are read back from the scene.
SETTINGS = ("friction", "surface_friction", "substeps")

Case = TypeVar("Case", bound="ContactRun")


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactRun(Stepped):
    """How long a scene runs, with which steps and which model of its contacts.

    After `settle` seconds, `duration` seconds are recorded. `cone` is the shape of the
    friction cone, `resolution` the engine's scheme for normal force and friction,
    `impratio` the ratio of frictional to normal impedance; for None the engine chooses
    the last two by the cone. `time_constant` is that of all contacts of the scene [s];
    the engine uses at least two solver steps. `noslip` is the number of iterations of
    the post-processing of that name. `gravity` is a magnitude [m/s²]. Cases in one
    scene have all of this in common, and the settings of `shared`.
    """

    shared: ClassVar[tuple[str, ...]] = ()
    duration: float
    settle: float = 0.0
    cone: Literal["pyramidal", "elliptic"] = "pyramidal"
    resolution: Literal["convex", "signorini"] | None = None
    impratio: float | None = None
    time_constant: float | None = None
    noslip: int = 0
    gravity: float = GRAVITY

    @property
    def steps(self) -> int:
        """Outer steps that are recorded."""
        return round(self.duration / self.dt)


@dataclass(frozen=True, slots=True)
class ContactCase(ContactRun):
    """All settings of one run of a body above or on the surface.

    `start` is the position of its centre [m]; `size` the edge of a cube or the diameter
    of a ball [m]; `density` [kg/m³]; `friction` its own coefficient, `surface_friction`
    that of the surface. Once settled, it gets `speed` along x [m/s]. `spring` are time
    constant [s] and damping ratio of the contacts of this body and the surface, None
    for the engine's defaults. A surface that is tilted by `tilt` [rad] is gravity that
    leans, towards x turned by `yaw` [rad] about z.
    """

    shared = ("surface_friction", "tilt", "yaw")
    start: tuple[float, float, float]
    friction: float = 0.5
    surface_friction: float = 0.8
    speed: float = 0.0
    shape: Literal["cube", "ball"] = "cube"
    size: float = 0.08
    density: float = 500.0
    spring: tuple[float, float] | None = None
    tilt: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        for name in ("duration", "settle"):
            seconds = getattr(self, name)
            if abs(round(seconds / self.dt) * self.dt - seconds) > 1e-9:
                raise CaseError(
                    f"{name} is {seconds} s, no whole number of outer steps of {self.dt} s. "
                    "Cases are compared over equal simulated time. Choose a dt that divides it."
                )

    @property
    def mass(self) -> float:
        """Mass of the solid body [kg]."""
        volume = self.size**3 * (1.0 if self.shape == "cube" else np.pi / 6)
        return self.density * volume

    @property
    def inertia(self) -> float:
        """Moment of inertia about any axis through the centre [kg·m²]."""
        return self.mass * self.size**2 * (1 / 6 if self.shape == "cube" else 1 / 10)

    @property
    def load(self) -> Load:
        """Load of each of four equal contacts of the body at rest."""
        weight = self.mass * self.gravity / 4
        normal, along = weight * np.cos(self.tilt), weight * np.sin(self.tilt)
        return Load(normal, along, 1 / self.mass)

    @property
    def fall(self) -> FloatArray:
        """Acceleration of a body without contacts, in the axes of the surface (3,) [m/s²]."""
        along = np.sin(self.tilt)
        leaning = along * np.cos(self.yaw), along * np.sin(self.yaw), -np.cos(self.tilt)
        return self.gravity * np.array(leaning)

    @property
    def rest_height(self) -> float:
        """Height of the centre of a body on the surface without penetration [m]."""
        return TOP + self.size / 2

    def clearance(self, z: FloatArray, quat: FloatArray) -> FloatArray:
        """Return the height of the body's lowest point above the surface, (n,) [m].

        Args:
            z: heights of its centre (n,) [m].
            quat: its orientations (n, 4), from which the lowest corner of a cube
                follows.
        """
        if self.shape == "ball":
            return z - self.size / 2 - TOP
        w, x, y, q = quat.T
        up = np.stack([2 * (x * q - w * y), 2 * (y * q + w * x), 1 - 2 * (x**2 + y**2)])
        return z - self.size / 2 * np.abs(up).sum(axis=0) - TOP


class World(NamedTuple):
    """A built scene with the surface, one body for each case, and a camera or None."""

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
        gs: the engine after `gs.init`.
        cases: by name; cases in one scene have the settings of `shared` in common.
        view: settings of the camera, None for no camera.

    Raises:
        CaseError: cases differ in such a setting.
    """
    common = shared_case(cases)
    scene = new_scene(gs, common, rigid_options(gs, common), gravity=tuple(common.fall))
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
    return World(scene, surface, bodies, cases, camera)


def rigid_options(gs: Any, case: ContactRun) -> dict[str, Any]:
    """Return friction model and time constant of a case as options; None is the default."""
    resolution = gs.contact_resolution[case.resolution] if case.resolution else None
    seconds = {"constraint_timeconst": case.time_constant} if case.time_constant else {}
    return {
        "friction_cone": gs.friction_cone[case.cone],
        "contact_resolution": resolution,
        "impratio": case.impratio,
        "noslip_iterations": case.noslip,
        **seconds,
    }


def contact_constants(scene: Any, geom: Any) -> FloatArray:
    """Return the seven contact parameters of a geom; the first is the time constant [s].

    Damping ratio and impedance follow. The solver uses at least two solver steps as
    time constant.
    """
    return to_numpy(scene.rigid_solver.get_sol_params(geoms_idx=[geom.idx]))[0]


def time_constant(world: World) -> float:
    """Return the time constant of the contacts of the surface [s]."""
    return float(contact_constants(world.scene, world.surface.geoms[0])[0])


def friction(scene: Any, body: Any) -> float:
    """Return the largest friction coefficient of the geoms of a body."""
    geoms = [geom.idx for geom in body.geoms]
    return float(to_numpy(scene.rigid_solver.get_geoms_friction(geoms)).max())


def record_world(
    world: World, traces: dict[str, ContactTrace], settings: dict[str, dict[str, float]]
) -> None:
    """Run a world; add its traces and its `SETTINGS`, which are read back, to those of others."""
    traces |= run_world(world)
    ground = friction(world.scene, world.surface)
    for name, body in world.bodies.items():
        found = friction(world.scene, body), ground, float(world.scene.substeps)
        for setting, value in zip(SETTINGS, found, strict=True):
            settings.setdefault(setting, {})[name] = value


def run_world(world: World) -> dict[str, ContactTrace]:
    """Reset the scene, settle, set the speeds, step; record every state of each body."""
    common = shared_case(world.cases)
    world.scene.reset()
    for _ in range(round(common.settle / common.dt)):
        world.scene.step()
    for name, case in world.cases.items():
        if case.speed:
            velocity = np.array([case.speed, 0, 0, 0, 0, 0])
            world.bodies[name].set_dofs_velocity(velocity)
    steps = common.steps
    states = record_states(world.scene.step, steps, lambda: read_world(world))
    return {
        name: ContactTrace(times(case), *stacked([state[name] for state in states]))
        for name, case in world.cases.items()
    }


def read_world(world: World) -> dict[str, tuple[np.ndarray, ...]]:
    """Return position, orientation, velocities, contact count and penetration of each body, now.

    The contacts are those of the beginning of the latest solver step.
    """
    states = {}
    for name, body in world.bodies.items():
        depths = to_numpy(body.get_contacts(with_entity=world.surface)["penetration"])
        count = np.array([len(depths)], np.int32)
        deepest = np.array([depths.max(initial=0.0)], np.float32)
        states[name] = (*read_body(body), count, deepest)
    return states


def shared_case(cases: Mapping[str, Case]) -> Case:
    """Return the first case, which has what cases in one scene have in common.

    Raises:
        CaseError: they differ in such a setting.
    """
    first = next(iter(cases.values()))
    for name, case in cases.items():
        for field in (*(of.name for of in fields(ContactRun)), *first.shared):
            if getattr(case, field) != getattr(first, field):
                raise CaseError(
                    f"{name} asks for {field}={getattr(case, field)}, another case of the scene "
                    f"for {getattr(first, field)}. Build a separate scene for it."
                )
    return first
