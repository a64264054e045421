"""Recorded runs as a GLB: the shape of the links, moved by the recorded link poses.

Each link is a node, placed in the world and moved by one animation per case, whose keys
are the samples of the record. One more node holds the parts that do not move, another
one translucent copies of links at their target. A third one holds the shadows: copies
of the links that move as these do, pressed onto the ground as by light from straight
above. If the view follows a link, the world moves against it. Nothing is compressed:
the page would have to load a decoder.
"""

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import pygltflib as gltf
import trimesh

from robo_genesis.core.channels import Run
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.visual_shape import WORLD, Part
from robo_genesis.site.replay.scenery import Scenery

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

# Colour of the copies: red, green, blue 0 to 255, and opacity. The script fades them
# near the target, where surfaces in one place would flicker.
GHOST = (60, 110, 220, 0.4)

# Colour of shadows, their height by that of their links, and the gap to the ground
# below [m].
SHADOW, FLAT, ABOVE = (105, 105, 105), 1e-4, 1e-3

# Rotation of the root node, `WORLD`, from the record's frame into glTF's; links are
# below it.
Z_UP_TO_Y_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]


# Parts, each with its simplified mesh.
Simple: TypeAlias = Sequence[tuple[Part, trimesh.Trimesh]]

COMPONENTS = {
    "float32": gltf.FLOAT,
    "uint16": gltf.UNSIGNED_SHORT,
    "uint32": gltf.UNSIGNED_INT,
}


class Binary:
    """The binary chunk of a GLB and its accessors; equal arrays are stored once."""

    def __init__(self, model: gltf.GLTF2) -> None:
        self.model, self.data, self.known = (
            model,
            bytearray(),
            dict[tuple[str, bytes], int](),
        )

    def add(
        self,
        array: np.ndarray,
        kind: str,
        target: int | None = None,
        bounds: bool = False,
    ) -> int:
        """Store an array (n,) or (n, k) and return its accessor; float32 or uint16 or uint32.

        glTF demands `bounds`, the smallest and largest values, of positions and of key
        times.
        """
        packed = array.tobytes()
        if (kind, packed) not in self.known:
            view = gltf.BufferView(
                buffer=0,
                byteOffset=len(self.data),
                byteLength=len(packed),
                target=target,
            )
            accessor = gltf.Accessor(
                bufferView=len(self.model.bufferViews),
                componentType=COMPONENTS[array.dtype.name],
                count=len(array),
                type=kind,
                min=np.atleast_1d(array.min(axis=0)).tolist() if bounds else None,
                max=np.atleast_1d(array.max(axis=0)).tolist() if bounds else None,
            )
            self.data += packed + bytes(-len(packed) % 4)
            self.known[kind, packed] = len(self.model.accessors)
            self.model.bufferViews.append(view)
            self.model.accessors.append(accessor)
        return self.known[kind, packed]


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
    model = gltf.GLTF2(
        asset=gltf.Asset(version="2.0", generator="RoboGenesis", copyright=credit)
    )
    binary = Binary(model)
    model.nodes = [gltf.Node(name=WORLD, rotation=Z_UP_TO_Y_UP)]

    def add(name: str, parent: int = 0, **attributes: Any) -> int:
        """Add a node below another one and return its number."""
        model.nodes[parent].children.append(len(model.nodes))
        model.nodes.append(gltf.Node(name=name, **attributes))
        return len(model.nodes) - 1

    first = next(iter(traces.values()))
    simple = [(part, simplified(part)) for part in scenery.parts]
    for k, link in enumerate(links):
        place = first.link_pos[0, k].astype(float).tolist()
        turn = rotations(first.link_quat[:1, k])[0].astype(float).tolist()
        add(link, translation=place, rotation=turn, mesh=_mesh(binary, link, simple))
    if (still := _mesh(binary, WORLD, simple)) is not None:
        add(STILL, mesh=still)
    copies = add(TARGET) if scenery.target else 0
    for link, pose in scenery.target.items():
        matrix, mesh = pose.T.ravel().tolist(), _mesh(binary, link, simple, GHOST)
        add(f"{TARGET}_{link}", copies, matrix=matrix, mesh=mesh)
    ground = [0.0, 0.0, scenery.ground + ABOVE]
    shadows = add(SHADOWS, translation=ground, scale=[1.0, 1.0, FLAT])
    for link, node in zip(links, model.nodes[1:], strict=False):
        mesh = _mesh(binary, link, simple, SHADOW)
        moved = {"translation": node.translation, "rotation": node.rotation}
        add(f"shadow_{link}", shadows, mesh=mesh, **moved)
    followed = scenery.followed
    if followed is not None:
        model.nodes[0].translation = opposite(first, followed)[0].astype(float).tolist()
    model.animations = [
        _animation(binary, *run, followed, shadows + 1) for run in traces.items()
    ]
    model.scene, model.scenes = 0, [gltf.Scene(nodes=[0])]
    model.buffers = [gltf.Buffer(byteLength=len(binary.data))]
    model.set_binary_blob(bytes(binary.data))
    return b"".join(model.save_to_bytes())


def _mesh(
    binary: Binary, link: str, shape: Simple, colour: Sequence[float] | None = None
) -> int | None:
    """Add a link's mesh and return its number, None where the link has no parts.

    `colour` replaces those of the parts.
    """
    model, primitives = binary.model, []
    for part, mesh in (pair for pair in shape if pair[0].link == link):
        attributes = gltf.Attributes(
            POSITION=binary.add(
                _float32(mesh.vertices), "VEC3", gltf.ARRAY_BUFFER, bounds=True
            ),
            NORMAL=binary.add(_float32(mesh.vertex_normals), "VEC3", gltf.ARRAY_BUFFER),
        )
        faces = np.asarray(mesh.faces).ravel()
        small = np.uint16 if len(mesh.vertices) < 2**16 else np.uint32
        indices = binary.add(faces.astype(small), "SCALAR", gltf.ELEMENT_ARRAY_BUFFER)
        look = {"indices": indices, "material": _material(model, colour or part.rgb)}
        primitives.append(gltf.Primitive(attributes=attributes, **look))
    if not primitives:
        return None
    model.meshes.append(gltf.Mesh(name=link, primitives=primitives))
    return len(model.meshes) - 1


def simplified(part: Part) -> trimesh.Trimesh:
    """Return a part with few triangles, its vertices split at sharp edges."""
    mesh = trimesh.Trimesh(part.vertices, part.faces, process=False)
    mesh.merge_vertices(merge_norm=True)
    if len(mesh.faces) > UNCHANGED:
        target = max(round(KEPT * len(mesh.faces)), FEWEST)
        mesh = mesh.simplify_quadric_decimation(face_count=target)
    mesh.update_faces(mesh.nondegenerate_faces())
    return trimesh.graph.smooth_shade(mesh, angle=CREASE)


def _material(model: gltf.GLTF2, colour: Sequence[float]) -> int:
    """Return the number of the material of a colour: red, green, blue 0 to 255, and opacity."""
    name, opacity = json.dumps(colour), next(iter(colour[3:]), 1.0)
    factor = [*linear(np.array(colour[:3]) / 255).tolist(), opacity]
    look = gltf.PbrMetallicRoughness(
        baseColorFactor=factor, metallicFactor=0.0, roughnessFactor=0.6
    )
    material = gltf.Material(name=name, pbrMetallicRoughness=look, alphaCutoff=None)
    if opacity < 1:
        material.alphaMode = "BLEND"
    if material not in model.materials:
        model.materials.append(material)
    return model.materials.index(material)


def linear(srgb: FloatArray) -> FloatArray:
    """Return sRGB values 0 to 1 as linear light, the unit of glTF's factors."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _animation(
    binary: Binary, name: str, trace: Run, followed: int | None, first_shadow: int
) -> gltf.Animation:
    """Return the animation of a case: every link's position and orientation at every sample.

    The nodes of the links begin at 1, and those of their shadows at `first_shadow`.
    """
    animation = gltf.Animation(name=name, channels=[], samplers=[])
    times = binary.add(_float32(trace.t), "SCALAR", bounds=True)
    tracks = list[tuple[tuple[int, ...], str, FloatArray, str]]()
    for k in range(trace.link_pos.shape[1]):
        both = k + 1, first_shadow + k
        tracks.append((both, "translation", _float32(trace.link_pos[:, k]), "VEC3"))
        tracks.append((both, "rotation", rotations(trace.link_quat[:, k]), "VEC4"))
    if followed is not None:
        tracks.append(((0,), "translation", opposite(trace, followed), "VEC3"))
    for moved, path, values, kind in tracks:
        for node in moved:
            target = gltf.AnimationChannelTarget(node=node, path=path)
            channel = gltf.AnimationChannel(
                sampler=len(animation.samplers), target=target
            )
            animation.channels.append(channel)
        output = binary.add(values, kind)
        sampler = gltf.AnimationSampler(
            input=times, output=output, interpolation="LINEAR"
        )
        animation.samplers.append(sampler)
    return animation


def opposite(trace: Run, link: int) -> FloatArray:
    """Return the places (n, 3) of the world that keep a link horizontally in the view's centre."""
    x, y = trace.link_pos[:, link, :2].T
    return _float32(np.column_stack([-x, np.zeros_like(x), y]))


def rotations(wxyz: FloatArray) -> FloatArray:
    """Return unit quaternions (n, 4) as (x, y, z, w), float32, without sign flips between samples.

    q and −q are one orientation. Between two samples of opposite sign, a viewer would
    interpolate a turn in the wrong direction.
    """
    unit = wxyz.astype(float) / np.linalg.norm(
        wxyz.astype(float), axis=1, keepdims=True
    )
    flips = np.where((unit[1:] * unit[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    signs = np.cumprod([1.0, *flips])
    return _float32((unit * signs[:, None])[:, [1, 2, 3, 0]])


def _float32(values: FloatArray) -> FloatArray:
    return np.ascontiguousarray(values, dtype=np.float32)
