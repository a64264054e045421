"""Recorded runs as a GLB: the shape of the links, moved by the recorded link poses.

Each link is a node, placed in the world and moved by one animation per case, whose keys
are the samples of the record. One more node holds the parts that do not move, another
one translucent copies of links at their target. A third one holds the shadows: copies
of the links that move as these do, pressed onto the ground as by light from straight
above. If the view follows a link, the world moves against it; so it does in the second
animation of each case, for a close-up. Nothing is compressed: the page would have to
load a decoder.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pygltflib as gltf
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from robo_genesis.core.channels import Run
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.visual_shape import WORLD, Part

from .scenery import Scenery

# Share of the triangles of a large part that is kept: with the small parts, about
# 12,000 of the Franka's 135,000 triangles.
KEPT = 0.05

# Number of triangles up to which a part stays unchanged, such as the engine's sphere,
# and the fewest of another part: rings would break and lamps vanish.
UNCHANGED, FEWEST = 1280, 400

CREASE = np.radians(
    40
)  # Angle between triangles above which an edge is drawn sharp [rad]

# The nodes of the parts that belong to no link, of the copies at the target, and of
# shadows.
STILL, TARGET, SHADOWS = "still", "target", "shadows"

CLOSE_UP = ", close-up"  # How the names of these animations end, as in `stage.js`

# Colour of the copies: red, green, blue 0 to 255, and opacity. The script fades them
# near the target, where surfaces in one place would flicker.
GHOST = (60, 110, 220, 0.4)

# Colour of shadows, their height by that of their links, and the gap to the ground
# below [m].
SHADOW, FLAT, ABOVE = (105, 105, 105), 1e-4, 1e-3

# Rotation of the root node, `WORLD`, from the record's frame into glTF's; links are
# below it.
Z_UP_TO_Y_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]


class Keys:
    """The keys of a model's animations in its binary chunk; equal arrays are stored once."""

    def __init__(self, model: gltf.GLTF2) -> None:
        self.model, self.data = model, bytearray(model.binary_blob())
        self.known = dict[tuple[tuple[int, ...], bytes], int]()

    def add(self, values: FloatArray, **bounds: list[float]) -> int:
        """Store an array (n,) or (n, k) as float32, and return the number of its accessor.

        glTF demands the `bounds` `min` and `max` of times.
        """
        values = np.ascontiguousarray(values, dtype=np.float32)
        packed, model = values.tobytes(), self.model
        if (values.shape, packed) not in self.known:
            self.known[values.shape, packed] = len(model.accessors)
            accessor = gltf.Accessor(
                bufferView=len(model.bufferViews),
                componentType=gltf.FLOAT,
                count=len(values),
                type=f"VEC{values.shape[1]}" if values.ndim == 2 else "SCALAR",
                **bounds,
            )
            model.accessors.append(accessor)
            size = {"byteOffset": len(self.data), "byteLength": len(packed)}
            model.bufferViews.append(gltf.BufferView(buffer=0, **size))
            self.data += packed
        return self.known[values.shape, packed]


def glb(
    scenery: Scenery,
    links: Sequence[str],
    traces: Mapping[str, Run],
    credit: str | None = None,
) -> bytes:
    """Return the model with one animation a case.

    Args:
        scenery: what to draw; parts of `WORLD` do not move.
        links: names of the links, in the order of the record.
        traces: the record by case.
        credit: copyright of the shape, None where it needs no notice.
    """
    first, followed = next(iter(traces.values())), scenery.followed
    drawn = scene_of(scenery, links).export(file_type="glb", include_normals=True)
    model = gltf.GLTF2.load_from_bytes(drawn)
    model.asset.copyright = credit
    for material in model.materials:
        material.alphaCutoff = None  # which belongs to a mode that no material has
    model.nodes[0].rotation = Z_UP_TO_Y_UP
    numbers = {node.name: k for k, node in enumerate(model.nodes)}
    if followed is not None:
        model.nodes[0].translation = opposite(first, followed)[0].tolist()
    moved = [(numbers[link], numbers[f"shadow_{link}"]) for link in links]
    for k, pair in enumerate(moved):
        for node in pair:
            model.nodes[node].translation = first.link_pos[0, k].tolist()
            model.nodes[node].rotation = rotations(first.link_quat[:1, k])[0].tolist()
    keys = Keys(model)
    for name, trace in traces.items():
        world = None if followed is None else opposite(trace, followed)
        model.animations.append(_animation(keys, name, trace, moved, world))
        if scenery.near is not None:
            world = opposite(trace, scenery.near, heights=True)
            near = _animation(keys, name + CLOSE_UP, trace, moved, world)
            model.animations.append(near)
    model.buffers[0].byteLength = len(keys.data)
    model.set_binary_blob(bytes(keys.data))
    return b"".join(model.save_to_bytes())


def scene_of(scenery: Scenery, links: Sequence[str]) -> trimesh.Scene:
    """Return what is drawn as a tree of named nodes, links and shadows not yet placed."""
    scene = trimesh.Scene(base_frame="scene")
    simple = [(part, simplified(part)) for part in scenery.parts]

    def add(
        name: str,
        parent: str = WORLD,
        link: str = "",
        pose: FloatArray | None = None,
        colour: Sequence[float] = (),
    ) -> None:
        """Add a node, and below it the parts of a link, in this colour or their own."""
        scene.graph.update(name, parent, matrix=pose)
        for part, mesh in simple:
            if part.link == link:
                look = TextureVisuals(material=_material(colour or part.rgb))
                shown = trimesh.Trimesh(
                    mesh.vertices, mesh.faces, process=False, visual=look
                )
                part_name = f"{name}_{len(scene.geometry)}"  # another one for each part
                scene.add_geometry(shown, part_name, parent_node_name=name)

    add(WORLD, "scene")
    for link in links:
        add(link, link=link)
    add(STILL, link=WORLD)
    if scenery.target:
        add(TARGET)
    for link, pose in scenery.target.items():
        add(f"{TARGET}_{link}", TARGET, link, pose, GHOST)
    flat = np.diag([1.0, 1.0, FLAT, 1.0])
    flat[2, 3] = scenery.ground + ABOVE
    add(SHADOWS, pose=flat)
    for link in links:
        add(f"shadow_{link}", SHADOWS, link, colour=SHADOW)
    return scene


def simplified(part: Part) -> trimesh.Trimesh:
    """Return a part with few triangles, its vertices split at sharp edges."""
    mesh = trimesh.Trimesh(part.vertices, part.faces, process=False)
    mesh.merge_vertices(merge_norm=True)
    if len(mesh.faces) > UNCHANGED:
        target = max(round(KEPT * len(mesh.faces)), FEWEST)
        mesh = mesh.simplify_quadric_decimation(face_count=target)
    mesh.update_faces(mesh.nondegenerate_faces())
    return trimesh.graph.smooth_shade(mesh, angle=CREASE)


def _material(colour: Sequence[float]) -> PBRMaterial:
    """Return the material of a colour: red, green, blue 0 to 255, and opacity."""
    opacity = next(iter(colour[3:]), 1.0)
    return PBRMaterial(
        baseColorFactor=[*linear(np.array(colour[:3]) / 255), opacity],
        metallicFactor=0.0,
        roughnessFactor=0.6,
        alphaMode="BLEND" if opacity < 1 else "OPAQUE",
    )


def linear(srgb: FloatArray) -> FloatArray:
    """Return sRGB values 0 to 1 as linear light, the unit of glTF's factors."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _animation(
    keys: Keys,
    name: str,
    trace: Run,
    moved: Sequence[tuple[int, ...]],
    world: FloatArray | None,
) -> gltf.Animation:
    """Return the animation of a case: every link's position and orientation at every sample.

    `moved` are the numbers of each link's nodes; `world` has the places (n, 3) of the
    root node, None if it does not move.
    """
    animation = gltf.Animation(name=name, channels=[], samplers=[])
    last = np.float32(trace.t[-1]).item()
    times = keys.add(trace.t, min=[0.0], max=[last])

    def move(path: str, values: FloatArray, *nodes: int) -> None:
        """Move nodes along one path: `translation` (n, 3) [m] or `rotation` (n, 4)."""
        sampler = len(animation.samplers)
        for node in nodes:
            target = gltf.AnimationChannelTarget(node=node, path=path)
            channel = gltf.AnimationChannel(sampler=sampler, target=target)
            animation.channels.append(channel)
        output = keys.add(values)
        animation.samplers.append(
            gltf.AnimationSampler(input=times, output=output, interpolation="LINEAR")
        )

    for k, nodes in enumerate(moved):
        move("translation", trace.link_pos[:, k], *nodes)
        move("rotation", rotations(trace.link_quat[:, k]), *nodes)
    if world is not None:
        move("translation", world, 0)
    return animation


def opposite(trace: Run, link: int, heights: bool = False) -> FloatArray:
    """Return the places (n, 3) of the world that keep a link in the view's centre.

    It stays there horizontally, and with `heights` at the origin.
    """
    x, y, z = trace.link_pos[:, link].T
    return np.column_stack([-x, -heights * z, y])


def rotations(wxyz: FloatArray) -> FloatArray:
    """Return unit quaternions (n, 4) as (x, y, z, w) without sign flips between samples.

    q and −q are one orientation. Between two samples of opposite sign, a viewer would
    interpolate a turn in the wrong direction.
    """
    unit = wxyz.astype(float)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    flips = np.where((unit[1:] * unit[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    signs = np.cumprod([1.0, *flips])
    return (unit * signs[:, None])[:, [1, 2, 3, 0]]
