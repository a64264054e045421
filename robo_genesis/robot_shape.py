"""What the robot looks like: the engine's own visual meshes, in the frames of their links."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from robo_genesis.scene_config import FloatArray

FILE = "shape.npz"


@dataclass(frozen=True, slots=True)
class Part:
    """The triangles of one link that have one colour.

    `vertices` (v, 3) [m] in the link's frame; `faces` (f, 3) count vertices; `rgb` 0 to 255.
    """

    link: str
    rgb: tuple[int, int, int]
    vertices: FloatArray
    faces: np.ndarray


def read_shape(robot: Any) -> list[Part]:
    """Return the visual geometry of a built robot, one part for each colour of each link."""
    parts = []
    for link in robot.links:
        by_colour: dict[tuple[int, int, int], list[tuple[FloatArray, np.ndarray]]] = {}
        for geom in link.vgeoms:
            mesh = geom.get_trimesh()
            red, green, blue = (int(value) for value in mesh.visual.main_color[:3])
            placed = rotate(geom.init_quat, mesh.vertices) + geom.init_pos
            by_colour.setdefault((red, green, blue), []).append((placed, np.array(mesh.faces)))
        parts += [Part(link.name, rgb, *joined(meshes)) for rgb, meshes in by_colour.items()]
    return parts


def rotate(quat: FloatArray, points: FloatArray) -> FloatArray:
    """Return points (n, 3) rotated by a unit quaternion (w, x, y, z)."""
    w, axis = quat[0], np.asarray(quat[1:])
    crossed = 2 * np.cross(axis, points)
    return points + w * crossed + np.cross(axis, crossed)


def joined(meshes: Sequence[tuple[FloatArray, np.ndarray]]) -> tuple[FloatArray, np.ndarray]:
    """Return (vertices, faces) of several meshes as one."""
    first = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    faces = [faces + begin for (_, faces), begin in zip(meshes, first[:-1], strict=True)]
    vertices = np.concatenate([vertices for vertices, _ in meshes])
    return vertices.astype(np.float32), np.concatenate(faces).astype(np.int32)


def write_shape(folder: Path, parts: Sequence[Part]) -> Path:
    """Write the parts to a file in `folder`, which is made where it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    vertices, faces = joined([(part.vertices, part.faces) for part in parts])
    np.savez_compressed(
        folder / FILE,
        link=[part.link for part in parts],
        rgb=np.array([part.rgb for part in parts], np.uint8),
        sizes=[(len(part.vertices), len(part.faces)) for part in parts],
        vertices_m=vertices,
        faces=faces,
    )
    return folder / FILE


def load_shape(file: Path) -> list[Part]:
    """Return the parts that `write_shape` wrote."""
    with np.load(file, allow_pickle=False) as stored:
        links, colours, vertices, faces = (
            stored[k] for k in ("link", "rgb", "vertices_m", "faces")
        )
        ends = np.cumsum(stored["sizes"], axis=0)
    parts, begin = [], (0, 0)
    for link, (red, green, blue), end in zip(links.tolist(), colours.tolist(), ends, strict=True):
        own = vertices[begin[0] : end[0]], faces[begin[1] : end[1]] - begin[0]
        parts.append(Part(link, (red, green, blue), *own))
        begin = end
    return parts
