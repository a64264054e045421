"""A bowl as a mesh, and the ways in which the engine makes collision geometry of it."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

RIM, FOOT, HEIGHT, WALL = 0.075, 0.035, 0.05, 0.004
"""Outer radii at the rim and at the foot, height, and thickness of the wall [m]."""

SECTIONS, LEVELS = 24, 5  # Of the mesh: facets around the axis, points of a profile

PLATE, WALLS = 0.006, 8  # Thickness of the boxes of another bowl [m], number of its walls

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

HERE = (0.0, 0.0, 0.0)


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

    outer, inner = profiles()
    angles = np.pi / SECTIONS * (1 + 2 * np.arange(SECTIONS + 1))

    def piece(points: list[FloatArray], around: FloatArray) -> Any:
        rings = [(r * np.cos(a), r * np.sin(a), z) for r, z in points for a in around]
        return trimesh.convex.convex_hull(np.array(rings))

    wall = [
        piece([outer[j], outer[j + 1], inner[j], inner[j + 1]], angles[k : k + 2])
        for k in range(SECTIONS)
        for j in range(LEVELS - 1)
    ]
    return [piece([outer[0], inner[0]], angles[:-1]), *wall]


def box_model(density: float, fixed: bool) -> str:
    """Return an MJCF model of a bowl of boxes: a plate, and upright walls around it.

    Args:
        density: [kg/m³].
        fixed: whether it has no joint.
    """
    half, apart = PLATE / 2, RIM - PLATE / 2
    wide, plate = RIM * np.tan(np.pi / WALLS), RIM * np.cos(np.pi / WALLS)
    boxes = [((plate, plate, half), (0, 0, half), 0.0)]
    for angle in 2 * np.pi * np.arange(WALLS) / WALLS:
        place = (apart * np.cos(angle), apart * np.sin(angle), HEIGHT / 2)
        boxes.append(((half, wide, HEIGHT / 2), place, angle))

    def numbers(values: Any) -> str:
        return " ".join(f"{value:.6f}" for value in values)

    geoms = "".join(
        f'<geom type="box" size="{numbers(size)}" pos="{numbers(pos)}" euler="0 0 {angle:.6f}" '
        f'density="{density:g}"/>'
        for size, pos, angle in boxes
    )
    joint = "" if fixed else "<freejoint/>"
    return (
        '<mujoco model="bowl"><compiler angle="radian"/><worldbody>'
        f'<body name="bowl">{joint}{geoms}</body></worldbody></mujoco>'
    )


def add(
    gs: Any,
    scene: Any,
    choice: str = "default",
    pos: tuple[float, float, float] = HERE,
    fixed: bool = True,
    surface: Any = None,
    **material: float,
) -> Any:
    """Add a bowl to a scene and return its entity.

    Args:
        gs: the engine after `gs.init`.
        scene: before it is built.
        choice: a key of `CHOICES`.
        pos: of the centre of its foot [m].
        fixed: whether it cannot move.
        surface: its look, None for the engine's.
        material: arguments of `gs.materials.Rigid`; `rho` is by default `DENSITY`.
    """
    given = {"rho": DENSITY} | material
    common = {"pos": pos, "fixed": fixed}
    if choice == "boxes":
        morph = gs.morphs.MJCF(file=box_model(given["rho"], fixed), pos=pos)
    else:
        options: dict[str, Any] = {
            "one_hull": {"decompose_object_error_threshold": np.inf},
            "fine": {"coacd_options": gs.options.CoacdOptions(threshold=FINE)},
        }.get(choice, {})
        files = tuple(pieces() if choice == "pieces" else [mesh()])
        places = {"poss": (HERE,) * len(files), "eulers": (HERE,) * len(files)}
        morph = gs.morphs.MeshSet(files=files, **places, **common, **options)
    return scene.add_entity(morph, material=gs.materials.Rigid(**given), surface=surface)
