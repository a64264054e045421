"""A bowl as a mesh, and the ways to make collision geometry of it."""

from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

# Outer radii at the rim and at the foot, height, and thickness of the wall [m].
RIM, FOOT, HEIGHT, WALL = 0.075, 0.035, 0.05, 0.004

SECTIONS, LEVELS = 24, 5  # Of the mesh: facets around the axis, points of a profile

DENSITY = 400.0  # [kg/m³]

# Ways to make collision geometry, with words for them.
CHOICES = {
    "one_hull": "one convex hull",
    "default": "default decomposition",
    "pieces": "convex pieces",
}


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
    bowl.apply_transform(
        trimesh.transformations.rotation_matrix(np.pi / SECTIONS, (0, 0, 1))
    )
    return bowl


def pieces() -> list[Any]:
    """Return convex meshes that fill the bowl without overlap: its foot, and parts of its wall."""
    import trimesh  # loads slowly

    angles = np.pi / SECTIONS * (1 + 2 * np.arange(SECTIONS + 1))
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = [
        [np.column_stack([r * around, np.full(len(around), z)]) for r, z in of]
        for of in profiles()
    ]
    parts = [[side[0] for side in rings]]
    for j in range(LEVELS - 1):
        wall = [*rings[0][j : j + 2], *rings[1][j : j + 2]]
        parts += [[ring[k : k + 2] for ring in wall] for k in range(SECTIONS)]
    return [trimesh.convex.convex_hull(np.vstack(part)) for part in parts]


def add(
    gs: Any,
    scene: Any,
    choice: str = "default",
    pos: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fixed: bool = True,
    surface: Any = None,
    seed: int = 0,
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
        seed: of CoACD, which decomposes the mesh.
        material: arguments of `gs.materials.Rigid`; `rho` is by default `DENSITY`.
    """
    files = tuple(pieces() if choice == "pieces" else [mesh()])
    options: dict[str, Any] = dict.fromkeys(
        ("poss", "eulers"), ((0.0, 0.0, 0.0),) * len(files)
    )
    if choice == "one_hull":
        options["decompose_object_error_threshold"] = np.inf
    options["coacd_options"] = gs.options.CoacdOptions(seed=seed)
    morph = gs.morphs.MeshSet(files=files, pos=pos, fixed=fixed, **options)
    made_of = gs.materials.Rigid(**{"rho": DENSITY} | material)
    return scene.add_entity(morph, material=made_of, surface=surface)
