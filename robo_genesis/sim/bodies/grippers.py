"""Boxes that two pads hold in the air: build grippers side by side, run them, record the motion."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim import throughput
from robo_genesis.sim.arm.joints import to_numpy

from . import contacts
from .rigid_bodies import new_scene, read_body, record_states, stacked, times
from .soft_contact import Load

# The links of a run: the box and both pads.
LINKS = ("box", "left", "right")

# Edge of the box, and half the edges of a pad [m]
SIZE, PAD = 0.04, (0.005, 0.03, 0.03)

# Mass of a pad [kg], and the armature that Genesis adds to each joint of an MJCF file
PAD_MASS, ARMATURE = 1.0, 0.1

# Contact points of a box, four at each pad.
CONTACTS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldCase(contacts.ContactRun):
    """All settings of one run of a box between two pads, which slide along x.

    `place` is the y of the gripper [m]; its height is 0, where float32 resolves a slow
    motion. `friction` is the coefficient of the box, and the pads have less; `force`
    presses each pad [N], `mass` is that of the box [kg]. `iterations` are those of the
    solver, None for its default.
    """

    shared = ("iterations",)
    duration: float = 0.2
    settle: float = 0.3
    substeps: int = 4
    time_constant: float = 0.01
    place: float = 0.0
    friction: float = 1.0
    force: float = 10.0
    mass: float = 0.1
    iterations: int | None = None

    @property
    def load(self) -> Load:
        """Load of each contact of the box."""
        inverse_mass = 1 / self.mass + 1 / (3 * (PAD_MASS + ARMATURE))
        weight = self.mass * self.gravity
        return Load(2 * self.force / CONTACTS, weight / CONTACTS, inverse_mass, True)


def pads(case: HeldCase) -> str:
    """Return the bodies of two pads in the language of MuJoCo; both engines read them.

    Their geoms are turned, because MuJoCo computes softness otherwise for pads along
    the axes.
    """
    x, (thick, wide, high) = SIZE / 2 + PAD[0], PAD
    pad = """<body name="{}" pos="{} 0 0">
    <joint name="{}" type="slide" axis="{} 0 0" armature="{}"/>
    <geom type="box" size="{} {} {}" euler="90 0 0" mass="{}" friction=".05 0 0"
     solref="{} 1"/></body>"""
    same = (ARMATURE, thick, high, wide, PAD_MASS, case.time_constant)
    left, right = (
        pad.format("left", -x, "l", 1, *same),
        pad.format("right", x, "r", -1, *same),
    )
    return f'<body name="frame">{left}{right}</body>'


class World(NamedTuple):
    """A built scene, and by case its pads and its box."""

    scene: Any
    grippers: Mapping[str, tuple[Any, Any]]
    cases: Mapping[str, HeldCase]


def build_world(gs: Any, cases: Mapping[str, HeldCase]) -> World:
    """Declare a scene with a gripper for each case, and build it; raises as `shared_case`."""
    common = contacts.shared_case(cases)
    further = {"iterations": common.iterations} if common.iterations else {}
    rigid = contacts.rigid_options(gs, common) | further
    scene = new_scene(gs, common, rigid, gravity=(0, 0, -common.gravity))
    grippers = {}
    for name, case in cases.items():
        at, density = (0.0, case.place, 0.0), case.mass / SIZE**3
        file = f"<mujoco><worldbody>{pads(case)}</worldbody></mujoco>"
        box, rigid = gs.morphs.Box(size=(SIZE,) * 3, pos=at), gs.materials.Rigid
        grippers[name] = (
            scene.add_entity(gs.morphs.MJCF(file=file, pos=at)),
            scene.add_entity(box, rigid(rho=density, friction=case.friction)),
        )
    scene.build()
    return World(scene, grippers, cases)


def record_world(
    world: World, traces: dict[str, BodyTrace], readings: dict[str, dict[str, float]]
) -> None:
    """Reset a world, press, settle and step; add its traces and readings to those of others.

    Readings are the friction of each box, the time constant of its contacts, and their
    number.
    """
    common, scene = contacts.shared_case(world.cases), world.scene
    scene.reset()
    for name, (hand, _) in world.grippers.items():
        hand.control_dofs_force(np.full(2, world.cases[name].force, np.float32))
    for _ in range(round(common.settle / common.dt)):
        scene.step()
    states = record_states(
        scene.step,
        common.steps,
        lambda: {n: read(*of) for n, of in world.grippers.items()},
    )
    for name, (_, box) in world.grippers.items():
        traces[name] = BodyTrace(
            times(common), *stacked([state[name] for state in states])
        )
        found = {
            "friction": contacts.friction(scene, box),
            "time_constant": float(contacts.contact_constants(scene, box.geoms[0])[0]),
            "contacts": len(to_numpy(box.get_contacts()["penetration"])),
        }
        for group, value in found.items():
            readings.setdefault(group, {})[name] = value


def turned_path(world: World, name: str, degrees: float) -> float:
    """Return the path of a box in a run with gravity turned in the plane of the pads [m]."""
    g, angle = world.cases[name].gravity, np.radians(degrees)
    world.scene.sim.set_gravity((0.0, g * np.sin(angle), -g * np.cos(angle)))
    traces: dict[str, BodyTrace] = {}
    record_world(world, traces, {})
    world.scene.sim.set_gravity((0.0, 0.0, -g))
    place = traces[name].link_pos[:, 0].astype(np.float64)
    return float(np.linalg.norm(place[-1] - place[0]))


def read(hand: Any, box: Any) -> tuple[FloatArray, ...]:
    """Return position, orientation, velocity and angular velocity of `LINKS`, now."""
    both = zip(read_body(box), read_body(hand), strict=True)
    return tuple(np.concatenate([of_box, of_hand[-2:]]) for of_box, of_hand in both)


def step_times(worlds: Mapping[str, World]) -> dict[str, float]:
    """Return times of an outer step of worlds that hold their boxes, as `throughput.in_turn`."""
    timed = {}
    for name, world in worlds.items():
        hand, _ = next(iter(world.grippers.values()))
        timed[name] = throughput.calls_of(world.scene, hand)
    return throughput.in_turn(
        timed, warm_up=5, steps=10, repeats=5, clock=time.perf_counter
    )
