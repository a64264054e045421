"""The still picture that a reader sees before a replay starts: its model, drawn without a browser.

The picture has the camera and the first poses of the replay, so the model takes its
place.
"""

from io import BytesIO

import numpy as np
import trimesh
from PIL import Image
from trimesh.intersections import slice_faces_plane

from robo_genesis.core.scene import FloatArray
from robo_genesis.site.replay.scenery import ASPECT, FIELD, Camera

WIDTH, HEIGHT = 960, round(960 / ASPECT)
FINER = 2  # Pixels drawn for one of the picture, along each side

LIGHT = np.array(
    [0.35, 0.8, 0.5]
)  # Direction to the light, in the frame of the viewer, y up

NEAREST = 0.05  # Distance to the camera from which on parts are drawn [m]

# Share of a surface's colour that is seen where it faces away from the light, and
# towards it.
DARKEST, BRIGHTEST = 0.35, 1.0


def picture(model: bytes, camera: Camera) -> bytes:
    """Return the start of a model's replay as WebP; behind the model it is transparent."""
    scene = trimesh.load_scene(BytesIO(model), file_type="glb")
    back = camera.axes[2]
    edge = camera.centre + back * (camera.distance - NEAREST)
    triangles, colours = [], []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        rgba = mesh.visual.material.baseColorFactor / 255
        places = trimesh.transform_points(mesh.vertices, matrix)
        normals = mesh.vertex_normals @ np.linalg.inv(
            matrix[:3, :3]
        )  # a shadow's parts are flat
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        facing = normals @ (LIGHT / np.linalg.norm(LIGHT))
        lit = DARKEST + (BRIGHTEST - DARKEST) * (1 + facing) / 2
        both = np.column_stack(
            [lit, lit]
        )  # as the function interpolates texture coordinates
        places, faces, both = slice_faces_plane(
            places, mesh.faces, -back, edge, uv=both
        )
        shades = np.column_stack([both[:, :1] * rgba[:3], np.full(len(both), rgba[3])])
        triangles.append(seen(places, camera)[faces])
        colours.append(shades[faces])
    corners, rgba = np.concatenate(triangles), np.concatenate(colours)
    opaque = rgba[:, 0, 3] == 1
    near, image = drawn(corners[opaque], rgba[opaque])
    nearer, ghost = drawn(corners[~opaque], rgba[~opaque])
    share = ghost[..., 3:] * (nearer > near)[..., None]
    ghost[..., 3] = 1
    return packed(ghost * share + image * (1 - share))


def seen(points: FloatArray, camera: Camera) -> FloatArray:
    """Return points (n, 3) as pixels from the left, pixels from the top, and inverse distance."""
    right, up, back = camera.axes @ (points - camera.centre).T
    near = 1 / (camera.distance - back)
    scale = FINER * HEIGHT / 2 / np.tan(FIELD / 2) * near
    middle = FINER * np.array([WIDTH, HEIGHT]) / 2
    return np.column_stack([middle[0] + scale * right, middle[1] - scale * up, near])


def drawn(corners: FloatArray, colours: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Draw triangles from their visible side.

    Args:
        corners: as `seen` returns them, (n, 3, 3).
        colours: of the corners, with opacity, (n, 3, 4).

    Returns:
        Inverse distance (h, w) and colour (h, w, 4) of the nearest triangle, 0 where
        there is none.
    """
    size = FINER * HEIGHT, FINER * WIDTH
    near, image = np.zeros(size), np.zeros((*size, 4))
    a, b, c = corners[..., :2].transpose(1, 0, 2)
    (right, down), (across, below) = (b - a).T, (c - a).T
    faces_camera = right * below - down * across < -1e-6  # y points down
    edges = np.concatenate([corners[..., :2], np.ones((*corners.shape[:2], 1))], axis=2)
    visible = (
        corners[faces_camera],
        colours[faces_camera],
        np.linalg.inv(edges[faces_camera]),
    )
    for corner, colour, edge in zip(*visible, strict=True):
        low = np.maximum(np.floor(corner[:, :2].min(axis=0)).astype(int), 0)
        high = np.minimum(
            np.ceil(corner[:, :2].max(axis=0)).astype(int), near.shape[::-1]
        )
        if (low >= high).any():
            continue
        x, y = (np.arange(*ends) + 0.5 for ends in zip(low, high, strict=True))
        weights = [
            x * by_x + y[:, None] * by_y + offset for by_x, by_y, offset in edge.T
        ]
        distance = sum(
            w * value for w, value in zip(weights, corner[:, 2], strict=True)
        )
        part = np.s_[low[1] : high[1], low[0] : high[0]]
        shown = (np.minimum.reduce(weights) >= 0) & (distance > near[part])
        near[part][shown] = distance[shown]
        image[part][shown] = np.column_stack([w[shown] for w in weights]) @ colour
    return near, image


def packed(image: FloatArray) -> bytes:
    """Return linear colours (h, w, 4), multiplied by their opacity, as a smaller WebP."""
    blocks = image.reshape(HEIGHT, FINER, WIDTH, FINER, 4).mean(axis=(1, 3))
    opacity = blocks[..., 3:]
    linear = blocks[..., :3] / np.maximum(opacity, 1e-9)
    srgb = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055
    )
    pixels = 255 * np.clip(np.concatenate([srgb, opacity], axis=2), 0, 1)
    content = BytesIO()
    Image.fromarray(np.round(pixels).astype(np.uint8)).save(
        content, "WEBP", quality=70, method=6
    )
    return content.getvalue()
