"""The visual meshes of the engine, each in the frame of its link."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray

from .arm.joints import to_numpy
from .arm.kinematics import rotate

FILE = "shape.npz"

WORLD = "world"  # The link of fixed parts; their frame is that of the record, z up

FLOOR_RGB = (205, 205, 205)


@dataclass(frozen=True, slots=True)
class Hinge:
    """The joint that turns a link; `line` is a point and the direction of its axis.

    `line` (2, 3) is in the frame of the link; the direction has length 1.
    """

    joint: str
    line: FloatArray


@dataclass(frozen=True, slots=True)
class Part:
    """The triangles of one link that have one colour.

    `vertices` (v, 3) [m] in the link's frame; `faces` (f, 3) count vertices; `rgb` 0 to
    255. `hinge` is None for a link that no single joint turns.
    """

    link: str
    rgb: tuple[int, int, int]
    vertices: FloatArray
    faces: np.ndarray
    hinge: Hinge | None = None


def read_shape(entity: Any, names: Sequence[str] | None = None) -> list[Part]:
    """Return the visual geometry of a built entity, one part for each colour of each link.

    Args:
        entity: a robot, or a single body such as a box.
        names: of its links in the record, if they differ from those of the engine.
    """
    import trimesh  # loads slowly

    names = [link.name for link in entity.links] if names is None else names
    parts = []
    for name, link in zip(names, entity.links, strict=True):
        by_colour: dict[tuple[int, int, int], list[Any]] = {}
        for geom in link.vgeoms:
            mesh = geom.get_trimesh()
            red, green, blue = (int(value) for value in mesh.visual.main_color[:3])
            placed = rotate(geom.init_quat, mesh.vertices) + geom.init_pos
            by_colour.setdefault((red, green, blue), []).append(
                (placed, np.array(mesh.faces))
            )
        hinge = hinge_of(link)
        for rgb, meshes in by_colour.items():
            vertices, faces = trimesh.util.append_faces(*zip(*meshes, strict=True))
            single = vertices.astype(np.float32), faces.astype(np.int32)
            parts.append(Part(name, rgb, *single, hinge))
    return parts


def hinge_of(link: Any) -> Hinge | None:
    """Return the joint that turns a link of the engine, None if it has another kind."""
    for joint in link.joints:
        described = getattr(joint, "desc", joint)  # so in newer engines
        axes = described.dofs_motion_ang
        if joint.n_dofs == 1 and np.any(axes):
            return Hinge(joint.name, np.array([joint.pos, axes[0]]))
    return None


def fixed_parts(entity: Any) -> list[Part]:
    """Return the geometry of a built entity that does not move, at its place in the world.

    Of a batch it is the place in the first environment.
    """
    place = to_numpy(entity.get_pos()).reshape(-1, 3)[0]
    quat = to_numpy(entity.get_quat()).reshape(-1, 4)[0]
    return [
        replace(
            part,
            link=WORLD,
            vertices=(rotate(quat, part.vertices) + place).astype(np.float32),
            hinge=None,
        )
        for part in read_shape(entity)
    ]


def floor(width: float) -> Part:
    """Return a square of the plane z = 0 around the origin, seen from above.

    The plane of the engine is infinite, and a viewer fits its camera to the shape.

    Args:
        width: of the square [m].
    """
    half = width / 2
    corners = [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return Part(WORLD, FLOOR_RGB, np.array(corners, np.float32), faces)


def slab(size: Sequence[float], top: float) -> Part:
    """Return a fixed box.

    Args:
        size: length, width and thickness [m].
        top: height of the upper face [m].
    """
    import trimesh  # loads slowly

    mesh = trimesh.creation.box(size).apply_translation((0, 0, top - size[2] / 2))
    apart = mesh.triangles.reshape(-1, 3)  # faces share no corners
    indices = np.arange(len(apart), dtype=np.int32).reshape(-1, 3)
    return Part(WORLD, FLOOR_RGB, apart.astype(np.float32), indices)


def ball(centre: Sequence[float], radius: float, rgb: tuple[int, int, int]) -> Part:
    """Return a fixed sphere, such as a marker at a target.

    Args:
        centre: (3,) [m].
        radius: [m].
        rgb: colour, 0 to 255.
    """
    import trimesh  # loads slowly

    mesh = trimesh.creation.icosphere(3, radius)
    vertices = np.asarray(mesh.vertices + np.asarray(centre), dtype=np.float32)
    return Part(WORLD, rgb, vertices, np.array(mesh.faces, dtype=np.int32))


def write_shape(folder: Path, parts: Sequence[Part]) -> Path:
    """Write the parts to a file in `folder`, which is made if it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    meshes = {f"vertices_m_{k}": part.vertices for k, part in enumerate(parts)}
    meshes |= {f"faces_{k}": part.faces for k, part in enumerate(parts)}
    meshes |= {f"hinge_{k}": p.hinge.line for k, p in enumerate(parts) if p.hinge}
    facts: dict[str, Any] = {
        "link": [part.link for part in parts],
        "rgb": [part.rgb for part in parts],
        "joint": [part.hinge.joint if part.hinge else "" for part in parts],
    }
    np.savez_compressed(folder / FILE, allow_pickle=False, **facts, **meshes)
    return folder / FILE


def load_shape(file: Path) -> list[Part]:
    """Return the parts that `write_shape` wrote."""
    parts = []
    with np.load(file, allow_pickle=False) as stored:
        facts = (stored[name].tolist() for name in ("link", "rgb", "joint"))
        for k, (link, (red, green, blue), joint) in enumerate(zip(*facts, strict=True)):
            hinge = Hinge(joint, stored[f"hinge_{k}"]) if joint else None
            mesh = stored[f"vertices_m_{k}"], stored[f"faces_{k}"]
            parts.append(Part(link, (red, green, blue), *mesh, hinge))
    return parts
