"""Balls that fall into a bowl, and what the engine makes of its mesh for contacts."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, inputs, json_value
from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import FloatArray, Stepped
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.bowl import CHOICES, HEIGHT, WALL
from robo_genesis.sim.bodies.free_fall import GRAVITY
from robo_genesis.sim.bodies.rigid_bodies import (
    new_scene,
    record_states,
    stacked,
    times,
)

T = 0.01  # Time constant of the engine's contacts at solver steps of up to 5 ms [s]

BALLS = tuple(f"ball_{k}" for k in range(1, 13))


@dataclass(frozen=True, slots=True)
class BowlCase(Stepped):
    """Balls that fall into a fixed bowl on the floor, in layers of four.

    `choice` is a key of `CHOICES`, `radius` that of the balls [m], `shift` their start
    along x [m], `drop` the height of the lowest ones above the rim [m], `seed` that of
    CoACD.
    """

    choice: str = "default"
    radius: float = 0.008
    shift: float = 0.0
    seed: int = 0
    drop: float = 0.02
    steps: int = 200

    @property
    def starts(self) -> FloatArray:
        """The centre of each ball at the start, (12, 3) [m]."""
        layer, place = np.divmod(np.arange(len(BALLS)), 4)
        angle = np.pi / 2 * place + 0.3 * layer
        z = HEIGHT + self.drop + self.radius + (2 * self.radius + 0.002) * layer
        return np.stack(
            [0.022 * np.cos(angle) + self.shift, 0.022 * np.sin(angle), z], axis=1
        )

    @property
    def depth(self) -> float:
        """How deep the lowest balls sink into the bowl's floor at fine steps, v T / e [m]."""
        speed = np.sqrt(2 * GRAVITY * (HEIGHT + self.drop - WALL))
        return speed * max(T, 2 * self.h) / np.e


BIG = {f"in_{choice}": BowlCase(choice) for choice in CHOICES}

# The same with other steps, another start, and the hulls of another seed.
ATTACKS = {
    "in_default_h10000us": BowlCase(substeps=1),
    "in_default_h2500us": BowlCase(substeps=4),
    "in_default_shifted": BowlCase(shift=0.03),
    "in_default_seed1": BowlCase(seed=1),
}

# Balls as thick as the wall, from above the rim, and from a start inside the bowl.
SMALL = {
    "small_in_default_h1000us": BowlCase("default", 0.002, substeps=10, steps=150),
    "small_in_pieces_h1000us": BowlCase("pieces", 0.002, substeps=10, steps=150),
    "small_from_inside_h1000us": BowlCase(
        "default", 0.002, substeps=10, drop=-0.036, steps=150
    ),
}

CASES = BIG | ATTACKS | SMALL

# What distinguishes runs further, in words.
CHANGED = {
    "in_default_shifted": ", start 30 mm aside",
    "in_default_seed1": ", seed 1",
    "small_from_inside_h1000us": ", from inside",
}

CUT = ("one_hull", "default")

# Places x on the line y = 0, and heights, where `CUT` collision geometry is sampled
# [m].
ACROSS, UP = np.arange(-72, 73, 3) / 1000, np.arange(101) / 2000

# The engine's values of the geometry.
READINGS = {
    "bowl_geoms": Readings(dict.fromkeys(CHOICES, "1")),
    "bowl_volume": Readings(dict.fromkeys([*CHOICES, "visual"], "cm³")),
    "bowl_mass": Readings(dict.fromkeys(CHOICES, "kg")),
    **dict.fromkeys(
        [f"top_{choice}" for choice in CUT],
        Readings({f"x_{1e3 * x:+.0f}mm": "m" for x in ACROSS}),
    ),
}

# Another processor may get other hulls from CoACD, and each contact makes rounding
# grow: balls may come to lie anywhere. Counts of the balls inside must agree, and all
# claims.
TOLERANCES = {
    "bowl_geoms": (12.0, 0.0),
    "cm³": (0.05, 0.15),
    "bowl_mass": (1e-6, 0.15),
    "lowest": (HEIGHT, 0.0),
    "inside": (0.0, 0.0),
    "in_foot": (12.0, 0.0),
    **dict.fromkeys([f"top_{of}" for of in CUT], (HEIGHT, 0.0)),
    **dict.fromkeys(CASES, (10.0, 0.0)),
}


@dataclass(frozen=True, slots=True)
class BowlMetrics(CaseMetrics):
    """Where the balls are at the end: inside, if below the rim and within its outer radius.

    A ball has sunk in if its centre is below the upper face of the bowl's foot.
    """

    inside: float = metric("%", "balls inside", "link_pos_m")
    lowest: float | None = metric("m", "lowest bottom of a ball inside", "link_pos_m")
    in_foot: float = metric("1", "balls inside that sank in", "link_pos_m")


def bowl_metrics(trace: BodyTrace, case: BowlCase) -> BowlMetrics:
    """Measure the end of a run."""
    x, y, z = trace.link_pos[-1].astype(np.float64).T
    z = z[(np.hypot(x, y) < bowl.RIM) & (z < HEIGHT)]
    lowest = z.min() - case.radius if len(z) else None
    return BowlMetrics(100 * len(z) / len(BALLS), lowest, float((z < WALL).sum()))


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    of_bowl = {
        "profiles_m": bowl.profiles(),
        "sections": bowl.SECTIONS,
        "density": bowl.DENSITY,
    }
    return inputs(CASES) | json_value(of_bowl | {"x_m": ACROSS, "z_m": UP})


def run_case(gs: Any, case: BowlCase) -> BodyTrace:
    """Let balls fall into a bowl."""
    scene = new_scene(gs, case)
    scene.add_entity(gs.morphs.Plane())
    bowl.add(gs, scene, case.choice, seed=case.seed)
    balls = [
        gs.morphs.Sphere(radius=case.radius, pos=tuple(start)) for start in case.starts
    ]
    links = [scene.add_entity(ball).link_start for ball in balls]
    scene.build()
    of = scene.rigid_solver
    getters = of.get_links_pos, of.get_links_quat, of.get_links_vel, of.get_links_ang

    states = record_states(
        scene.step, case.steps, lambda: tuple(to_numpy(get(links)) for get in getters)
    )
    return BodyTrace(times(case), *stacked(states))


def read_geometry(gs: Any) -> dict[str, dict[str, float]]:
    """Return `READINGS`, from free bowls side by side."""
    scene = new_scene(gs, BIG["in_default"])
    scene.add_entity(gs.morphs.Plane())
    bowls = {
        of: bowl.add(gs, scene, of, (0.0, 0.3 * place, 0.0), fixed=False)
        for place, of in enumerate(CHOICES)
    }
    shapes = {
        of: [geom.get_trimesh() for geom in one.geoms] for of, one in bowls.items()
    }
    seen = {"visual": [geom.get_trimesh() for geom in bowls["default"].vgeoms]}
    scene.build()
    found = {
        "bowl_geoms": {of: float(len(meshes)) for of, meshes in shapes.items()},
        "bowl_volume": {of: volume(meshes) for of, meshes in (shapes | seen).items()},
        "bowl_mass": {of: float(one.get_mass()) for of, one in bowls.items()},
    }
    grid = np.stack(np.broadcast_arrays(ACROSS[:, None], 0.0, UP), axis=-1)
    for of in CUT:
        tops = np.where(outside(shapes[of], grid) < 1e-6, UP, 0.0).max(axis=1).tolist()
        found[f"top_{of}"] = dict(zip(READINGS[f"top_{of}"].units, tops, strict=True))
    return found


def volume(meshes: list[Any]) -> float:
    """Return the sum of the volumes of meshes [cm³]; where two overlap, both count."""
    return float(1e6 * sum(one.volume for one in meshes))


def outside(hulls: list[Any], points: FloatArray) -> FloatArray:
    """Return how far points (…, 3) are outside the nearest convex mesh, negative inside (…) [m]."""
    beyond = []
    for hull in hulls:
        normals = hull.face_normals
        offsets = (normals * hull.triangles[:, 0]).sum(axis=1)
        beyond.append((points @ normals.T - offsets).max(axis=-1))
    return np.min(beyond, axis=0)
