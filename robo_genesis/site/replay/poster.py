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

FINER = 2  # Pixels drawn for one of the picture, along each side
WIDTH, HEIGHT = FINER * 960, FINER * round(960 / ASPECT)

LIGHT = np.array([0.35, 0.8, 0.5])  # Direction to the light in the viewer's frame, y up
NEAREST = 0.05  # Distance to the camera from which on parts are drawn [m]

# Share of a surface's colour that is seen where it faces away from the light.
DARKEST = 0.35


def picture(model: bytes, camera: Camera) -> bytes:
    """Return the start of a model's replay as WebP; behind the model it is transparent."""
    scene = trimesh.load_scene(BytesIO(model), file_type="glb")
    nodes = [surface(scene, node, camera) for node in scene.graph.nodes_geometry]
    corners, colours = map(np.concatenate, zip(*nodes, strict=True))
    opaque = colours[:, 0, 3] == 1
    near, image = drawn(corners[opaque], colours[opaque])
    nearer, clear = drawn(corners[~opaque], colours[~opaque])
    share = clear[..., 3:] * (nearer > near)[..., None]
    clear[..., 3] = 1
    image = clear * share + image * (1 - share)
    linear, opacity = np.split(image, [3], axis=2)
    linear = linear / np.maximum(opacity, 1e-9)
    curve = 1.055 * linear ** (1 / 2.4) - 0.055
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, curve)
    pixels = np.round(255 * np.dstack([srgb, opacity]).clip(0, 1)).astype(np.uint8)
    content = BytesIO()
    small = Image.fromarray(pixels).reduce(FINER)
    small.save(content, "WEBP", quality=70, method=6)
    return content.getvalue()


def surface(
    scene: trimesh.Scene, node: str, camera: Camera
) -> tuple[FloatArray, FloatArray]:
    """Return the triangles of a node in front of the camera.

    Returns:
        Corners (n, 3, 3): pixels from the left, pixels from the top, inverse distance
        [1/m]. Linear colours of the corners with opacity (n, 3, 4).
    """
    matrix, name = scene.graph[node]
    mesh, back = scene.geometry[name], camera.axes[2]
    normals = mesh.vertex_normals @ np.linalg.inv(matrix[:3, :3])  # shadows are flat
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    facing = normals @ LIGHT / np.linalg.norm(LIGHT)
    light = DARKEST + (1 - DARKEST) * (1 + facing) / 2
    places, faces, light = slice_faces_plane(
        trimesh.transform_points(mesh.vertices, matrix),
        mesh.faces,
        plane_normal=-back,
        plane_origin=camera.centre + back * (camera.distance - NEAREST),
        uv=np.column_stack([light, np.ones_like(light)]),  # which the cut interpolates
    )
    right, up, toward = camera.axes @ (places - camera.centre).T
    near = 1 / (camera.distance - toward)
    scale = HEIGHT / 2 / np.tan(FIELD / 2) * near
    seen = [WIDTH / 2 + scale * right, HEIGHT / 2 - scale * up, near]
    colours = light[:, [0, 0, 0, 1]] * mesh.visual.material.baseColorFactor / 255
    return np.column_stack(seen)[faces], colours[faces]


def drawn(corners: FloatArray, colours: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Draw triangles from their visible side.

    Args:
        corners: as `surface` returns them, (n, 3, 3).
        colours: of the corners, (n, 3, 4).

    Returns:
        Inverse distance (h, w) and colour (h, w, 4) of the nearest triangle, 0 where
        there is none.
    """
    near, image = np.zeros((HEIGHT, WIDTH)), np.zeros((HEIGHT, WIDTH, 4))
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    pixels = np.dstack([x, y, np.ones_like(x)])
    edges = corners.copy()
    edges[..., 2] = 1
    visible = np.linalg.det(edges) < -1e-6  # y points down
    weights = np.linalg.inv(edges[visible])
    for corner, colour, of in zip(
        corners[visible], colours[visible], weights, strict=True
    ):
        low = np.floor(corner[:, :2].min(axis=0)).clip(0).astype(int)
        high = np.ceil(corner[:, :2].max(axis=0)).clip(0).astype(int)
        part = np.s_[low[1] : high[1], low[0] : high[0]]
        share = pixels[part] @ of
        distance = share @ corner[:, 2]
        shown = (share >= 0).all(axis=2) & (distance > near[part])
        near[part][shown] = distance[shown]
        image[part][shown] = share[shown] @ colour
    return near, image
