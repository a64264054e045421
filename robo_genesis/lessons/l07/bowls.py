"""A bowl as a mesh, and what the engine makes of it for contacts: balls fall into it."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, inputs, json_value
from robo_genesis.core.metrics import CaseMetrics, metric
from robo_genesis.core.scene import DT, SUBSTEPS, FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.bodies.free_fall import GRAVITY
from robo_genesis.sim.bodies.rigid_bodies import record_states, stacked, times

RIM, FOOT, HEIGHT, WALL = 0.075, 0.035, 0.05, 0.004
"""Outer radii at the rim and at the foot, height, and thickness of the wall [m]."""

SECTIONS, LEVELS = 24, 5  # Of the mesh: facets around the axis, points of a profile

WALLS, PLATE = 8, 0.006  # Of the bowl of boxes: number of walls, thickness of all boxes [m]

DENSITY = 400.0  # Of the bowl [kg/m³]

CHOICES = {
    "one_hull": "one convex hull",
    "default": "default decomposition",
    "fine": "finer decomposition",
    "pieces": "convex pieces",
    "boxes": "boxes",
}
"""Ways to make collision geometry, with words for them."""

FINE = 0.05  # CoACD's threshold for the finer decomposition; the engine's default is 0.1

T = 0.01  # Time constant of the engine's contacts at solver steps of up to 5 ms [s]

BALLS = tuple(f"ball_{k}" for k in range(1, 13))


@dataclass(frozen=True, slots=True)
class BowlCase:
    """Balls that fall into a fixed bowl on the floor, in layers of four.

    `choice` is a key of `CHOICES`, `radius` that of the balls [m], `shift` their start along x [m],
    `drop` the height of the lowest ones above the rim [m], `seed` that of CoACD.
    """

    choice: str = "default"
    radius: float = 0.008
    substeps: int = SUBSTEPS
    shift: float = 0.0
    seed: int = 0
    drop: float = 0.02
    steps: int = 200
    dt: float = DT

    @property
    def h(self) -> float:
        """Length of one solver step [s]."""
        return self.dt / self.substeps

    @property
    def starts(self) -> FloatArray:
        """The centre of each ball at the start, (12, 3) [m]."""
        layer, place = np.divmod(np.arange(len(BALLS)), 4)
        angle = np.pi / 2 * place + 0.3 * layer
        z = HEIGHT + self.drop + self.radius + (2 * self.radius + 0.002) * layer
        return np.stack([0.022 * np.cos(angle) + self.shift, 0.022 * np.sin(angle), z], axis=1)

    @property
    def floor(self) -> float:
        """Height of the upper face of the bowl's foot [m]."""
        return PLATE if self.choice == "boxes" else WALL

    @property
    def depth(self) -> float:
        """How deep the lowest balls sink into this face at fine steps, v T / e [m]."""
        speed = float(np.sqrt(2 * GRAVITY * (HEIGHT + self.drop - self.floor)))
        return speed * max(T, 2 * self.h) / np.e


BIG = {f"in_{choice}": BowlCase(choice) for choice in CHOICES}
ATTACKS = {
    "in_default_h10000us": BowlCase(substeps=1),
    "in_default_h2500us": BowlCase(substeps=4),
    "in_default_shifted": BowlCase(shift=0.03),
    "in_default_seed1": BowlCase(seed=1),
}
"""The same with other steps, another start, and the hulls of another seed."""

SMALL = {
    "small_in_default": BowlCase("default", 0.002, steps=150),
    "small_in_pieces": BowlCase("pieces", 0.002, steps=150),
    "small_in_default_h1000us": BowlCase("default", 0.002, 10, steps=150),
    "small_in_pieces_h1000us": BowlCase("pieces", 0.002, 10, steps=150),
    "small_from_inside_h1000us": BowlCase("default", 0.002, 10, drop=-0.036, steps=150),
}
"""Balls as thick as the wall, with two solver steps, and from a start inside the bowl."""

CASES = BIG | ATTACKS | SMALL

DECOMPOSED, CUT = ("default", "fine"), ("one_hull", "default", "fine")

ACROSS, UP = np.arange(-72, 73, 3) / 1000, np.arange(101) / 2000
"""Places x on the line y = 0, and heights, where `CUT` collision geometry is sampled [m]."""

READINGS = {
    "bowl_geoms": Readings(dict.fromkeys(CHOICES, "1")),
    "collision_volume": Readings(dict.fromkeys(CHOICES, "cm³")),
    "visual_volume": Readings(dict.fromkeys(CHOICES, "cm³")),
    "bowl_mass": Readings(dict.fromkeys([*CHOICES, "corrected"], "kg")),
    "uncovered": Readings(dict.fromkeys(DECOMPOSED, "m")),
    **{f"top_{of}": Readings({f"x_{1e3 * x:+.0f}mm": "m" for x in ACROSS}) for of in CUT},
    **{
        what: Readings(dict.fromkeys(CHOICES, "s"), "performance", dict.fromkeys(CHOICES, limits))
        for what, limits in {"build": (0.0, 3600.0), "step": (1e-5, 10.0)}.items()
    },
}
"""The engine's values: of the geometry, and the time of a build and of one outer step."""

# Another processor may get other hulls from CoACD, and each contact makes rounding grow: balls may
# come to lie anywhere. Counts of the balls inside must agree, and all claims.
TOLERANCES = {
    "bowl_geoms": (12.0, 0.0), "cm³": (0.05, 0.15), "bowl_mass": (1e-6, 0.15),
    "uncovered": (1e-4, 0.0),
    "lowest": (HEIGHT, 0.0), "inside": (0.0, 0.0),
    **dict.fromkeys([f"top_{of}" for of in CUT], (HEIGHT, 0.0)),
    **dict.fromkeys(CASES, (10.0, 0.0)),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class BowlMetrics(CaseMetrics):
    """Where the balls are at the end: inside, if below the rim and within its outer radius."""

    inside: float = metric("%", "balls inside", "link_pos_m")
    lowest: float | None = metric("m", "lowest bottom of a ball inside", "link_pos_m")


def bowl_metrics(trace: BodyTrace, case: BowlCase) -> BowlMetrics:
    """Measure the end of a run."""
    z = heights_inside(trace)
    lowest = float(z.min()) - case.radius if len(z) else None
    return BowlMetrics(100 * len(z) / len(BALLS), lowest)


def heights_inside(trace: BodyTrace) -> FloatArray:
    """Return the heights of the centres of the balls that end inside the bowl, (k,) [m]."""
    x, y, z = trace.link_pos[-1].astype(np.float64).T
    return z[(np.hypot(x, y) < RIM) & (z < HEIGHT)]


def parameters() -> dict[str, Any]:
    """Return every configured input as JSON values, for the evidence key."""
    given = {"profiles_m": profiles(), "sections": SECTIONS, "boxes": (WALLS, PLATE)}
    read = {"density": DENSITY, "fine": FINE, "x_m": ACROSS, "z_m": UP}
    return inputs(CASES) | json_value(given | read)


def profiles() -> tuple[FloatArray, FloatArray]:
    """Return the outer and the inner half profile, each (`LEVELS`, 2), as radius and height [m]."""
    share = np.linspace(0, 1, LEVELS)
    radius = FOOT + (RIM - FOOT) * np.sqrt(share)
    inner = np.stack([radius - WALL, WALL + (HEIGHT - WALL) * share], axis=1)
    return np.stack([radius, HEIGHT * share], axis=1), inner


def mesh() -> Any:
    """Return the bowl as a closed `trimesh.Trimesh`: its axis is z, its foot is at z = 0.

    The plane y = 0 cuts two facets in the middle.
    """
    import trimesh  # loads slowly

    outer, inner = profiles()
    line = np.vstack([[0, 0], outer, inner[::-1], [0, WALL]])
    bowl = trimesh.creation.revolve(line, sections=SECTIONS)
    bowl.merge_vertices()
    bowl.apply_transform(trimesh.transformations.rotation_matrix(np.pi / SECTIONS, (0, 0, 1)))
    return bowl


def pieces() -> list[Any]:
    """Return convex meshes that fill the bowl without overlap: its foot, and parts of its wall."""
    import trimesh  # loads slowly

    angles = np.pi / SECTIONS * (1 + 2 * np.arange(SECTIONS + 1))
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = [
        [np.column_stack([r * around, np.full(len(around), z)]) for r, z in of] for of in profiles()
    ]
    parts = [[side[0] for side in rings]]
    for j in range(LEVELS - 1):
        wall = [*rings[0][j : j + 2], *rings[1][j : j + 2]]
        parts += [[ring[k : k + 2] for ring in wall] for k in range(SECTIONS)]
    return [trimesh.convex.convex_hull(np.vstack(part)) for part in parts]


def box_model(fixed: bool) -> str:
    """Return an MJCF model of a bowl of boxes: a plate, and upright walls around it."""
    half, plate, wide = PLATE / 2, RIM * np.cos(np.pi / WALLS), RIM * np.tan(np.pi / WALLS)
    boxes = f'<geom size="{plate} {plate} {half}" pos="0 0 {half}"/>'
    for angle in 2 * np.pi * np.arange(WALLS) / WALLS:
        place = f"{(RIM - half) * np.cos(angle)} {(RIM - half) * np.sin(angle)} {HEIGHT / 2}"
        size = f"{half} {wide} {HEIGHT / 2}"
        boxes += f'<geom size="{size}" pos="{place}" euler="0 0 {angle}"/>'
    given = f'<default><geom type="box" density="{DENSITY}"/></default>'
    body = f'<body name="bowl">{"" if fixed else "<freejoint/>"}{boxes}</body>'
    units = '<compiler angle="radian"/>'
    return f'<mujoco model="bowl">{units}{given}<worldbody>{body}</worldbody></mujoco>'


def add(
    gs: Any, scene: Any, choice: str = "default", pos: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: bool = True, surface: Any = None, seed: int = 0, **material: float,
) -> Any:  # fmt: skip
    """Add a bowl to a scene and return its entity.

    Args:
        gs: the engine after `gs.init`.
        scene: before it is built.
        choice: a key of `CHOICES`.
        pos: of the centre of its foot [m].
        fixed: whether it cannot move.
        surface: its look, None for the engine's.
        seed: of CoACD, which decomposes the mesh.
        material: arguments of `gs.materials.Rigid`; `rho` is by default `DENSITY`.
    """
    if choice == "boxes":
        morph = gs.morphs.MJCF(file=box_model(fixed), pos=pos)
    else:
        files = tuple(pieces() if choice == "pieces" else [mesh()])
        options: dict[str, Any] = dict.fromkeys(("poss", "eulers"), ((0.0, 0.0, 0.0),) * len(files))
        if choice == "one_hull":
            options["decompose_object_error_threshold"] = np.inf
        threshold = {"threshold": FINE} if choice == "fine" else {}
        options["coacd_options"] = gs.options.CoacdOptions(seed=seed, **threshold)
        morph = gs.morphs.MeshSet(files=files, pos=pos, fixed=fixed, **options)
    made_of = gs.materials.Rigid(**{"rho": DENSITY} | material)
    return scene.add_entity(morph, material=made_of, surface=surface)


def new_scene(gs: Any, case: BowlCase) -> Any:
    """Return a scene with the floor."""
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=case.dt, substeps=case.substeps),
        profiling_options=gs.options.ProfilingOptions(show_FPS=False),  # no speed in the log
        show_viewer=False,
    )
    scene.add_entity(gs.morphs.Plane())
    return scene


def run_case(gs: Any, case: BowlCase) -> tuple[BodyTrace, float, float]:
    """Let balls fall into a bowl; return trace, time of the build and median time of a step [s]."""
    begin, scene = time.perf_counter(), new_scene(gs, case)
    add(gs, scene, case.choice, seed=case.seed)
    balls = [gs.morphs.Sphere(radius=case.radius, pos=tuple(start)) for start in case.starts]
    links = [scene.add_entity(ball).link_start for ball in balls]
    scene.build()
    build, of, taken = time.perf_counter() - begin, scene.rigid_solver, []
    getters = of.get_links_pos, of.get_links_quat, of.get_links_vel, of.get_links_ang

    def step() -> None:
        start = time.perf_counter()
        scene.step()
        taken.append(time.perf_counter() - start)

    states = record_states(step, case.steps, lambda: tuple(to_numpy(get(links)) for get in getters))
    return BodyTrace(times(case), *stacked(states)), build, float(np.median(taken))


def read_geometry(gs: Any) -> dict[str, dict[str, float]]:
    """Return `READINGS` without the times, from free bowls side by side."""
    scene, bowls = new_scene(gs, BIG["in_default"]), {}
    for place, of in enumerate(CHOICES):
        bowls[of] = add(gs, scene, of, (0.0, 0.3 * place, 0.0), fixed=False)
    shapes = {of: [geom.get_trimesh() for geom in bowl.geoms] for of, bowl in bowls.items()}
    seen = {of: volume([geom.get_trimesh() for geom in bowls[of].vgeoms]) for of in CHOICES}
    solid = {of: volume(meshes) for of, meshes in shapes.items()}
    right = DENSITY * seen["default"] / solid["default"]
    bowls["corrected"] = add(gs, scene, "default", (0.3, 0.0, 0.0), fixed=False, rho=right)
    scene.build()
    points = np.vstack([[*one.vertices, one.vertices.mean(axis=0)] for one in pieces()])
    found = {
        "bowl_geoms": {of: float(len(meshes)) for of, meshes in shapes.items()},
        "collision_volume": solid,
        "visual_volume": seen,
        "bowl_mass": {of: float(bowl.get_mass()) for of, bowl in bowls.items()},
        "uncovered": {of: float(max(outside(shapes[of], points).max(), 0)) for of in DECOMPOSED},
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

    def beyond(hull: Any) -> FloatArray:
        normals = hull.face_normals
        return np.asarray((points @ normals.T - (normals * hull.triangles[:, 0]).sum(1)).max(-1))

    return np.asarray(np.min([beyond(hull) for hull in hulls], axis=0))
