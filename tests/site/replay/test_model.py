"""The GLB of a run is valid, with the keys of the record and the shape of the model."""

from dataclasses import replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pygltflib
import pytest
import trimesh
from gltf import report
from trimesh.transformations import rotation_matrix, translation_matrix

from robo_genesis.lessons import find_replay
from robo_genesis.sim import visual_shape
from robo_genesis.sim.visual_shape import Part
from robo_genesis.site.replay import model as replay_model
from robo_genesis.site.replay.scenery import Camera, Scenery

LINKS = ("link0", "link4", "hand")  # of the synthetic traces

BOX = trimesh.creation.box((0.1, 0.2, 0.3))


def part(link, rgb, mesh):
    return Part(link, rgb, mesh.vertices.astype(np.float32), mesh.faces)


@pytest.fixture(scope="module")
def shape() -> list[Part]:
    """A ball of many triangles and a box of few on the first link, a box on each other."""
    ball = part("link0", (255, 255, 255), trimesh.creation.icosphere(subdivisions=4))
    return [ball, *(part(link, (64, 0, 0), BOX) for link in LINKS)]


@pytest.fixture(scope="module")
def turning(traces):
    """The synthetic cases with links that turn, one through a sign flip of its quaternion."""
    angle = np.linspace(0, 2, 121)
    quat = np.zeros((121, len(LINKS), 4), np.float32)
    quat[..., 0], quat[..., 3] = np.cos(angle)[:, None], np.sin(angle)[:, None]
    quat[60:, 1] *= -1
    return {
        "G1": replace(traces["G1"], link_quat=quat),
        "G2": traces["G2"],
        "G3": traces["G3"],
    }


POSE = translation_matrix([1, 2, 3]) @ rotation_matrix(0.5, [1, 0, 0])


def drawn(parts, traces, **around) -> bytes:
    scenery = Scenery(parts, Camera(np.zeros(3), 1.0), **around)
    return replay_model.glb(scenery, LINKS, traces, find_replay("l04").credit)


@pytest.fixture(scope="module")
def glb(shape, turning) -> bytes:
    """A model with a floor, a copy of the hand at its target, and a view that follows the hand."""
    parts = [*shape, visual_shape.floor(2.0)]
    return drawn(parts, turning, target={"hand": POSE}, followed=2)


@pytest.fixture(scope="module")
def model(glb) -> pygltflib.GLTF2:
    return pygltflib.GLTF2.load_from_bytes(glb)


def moved(model):
    """The names of the nodes that animations move."""
    return {
        model.nodes[c.target.node].name
        for one in model.animations
        for c in one.channels
    }


def values(model, accessor):
    """Read an accessor of floats as (n, k)."""
    found = model.accessors[accessor]
    view = model.bufferViews[found.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[found.type]
    data = model.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    return np.frombuffer(data, np.float32).reshape(-1, width)


def keys(model, case, link, path):
    """Return (times, values) of one channel of the animation of a case."""
    animation = next(a for a in model.animations if a.name == case)
    channel = next(
        c
        for c in animation.channels
        if model.nodes[c.target.node].name == link and c.target.path == path
    )
    sampler = animation.samplers[channel.sampler]
    assert sampler.interpolation == "LINEAR"
    return values(model, sampler.input)[:, 0], values(model, sampler.output)


def test_each_part_is_drawn_with_its_shadow_and_its_copy_at_the_target(model):
    drawn = [node.mesh for node in model.nodes if node.mesh is not None]
    # Five parts with the floor, the shadows of four, one copy.
    assert sorted(drawn) == [*range(10)] == [*range(len(model.meshes))]


def test_the_validator_finds_nothing(glb, tmp_path):
    found = report(glb, tmp_path)
    assert (found["issues"]["numErrors"], found["issues"]["numWarnings"]) == (0, 0)
    assert found["info"]["animationCount"] == 3
    assert found["info"]["totalTriangleCount"] > 0
    assert (
        report(glb.replace(b'"VEC3"', b'"VEC2"'), tmp_path)["issues"]["numErrors"] > 0
    )


def test_each_key_is_a_sample_and_a_sign_flip_turns_nothing_the_long_way(
    model, turning
):
    flipped = turning["G1"].link_quat[:, 1]
    assert (flipped[1:] * flipped[:-1]).sum(axis=1).min() < 0
    for (case, trace), (k, link) in product(turning.items(), enumerate(LINKS)):
        times, places = keys(model, case, link, "translation")
        assert np.array_equal(times, trace.t.astype(np.float32))
        assert np.array_equal(places, trace.link_pos[:, k])
        _, turns = keys(model, case, link, "rotation")
        xyzw = trace.link_quat[:, k][:, [1, 2, 3, 0]]
        assert np.abs((turns * xyzw).sum(axis=1)) == pytest.approx(1, abs=1e-6)
        assert (turns[1:] * turns[:-1]).sum(axis=1).min() > 0.99


def test_many_triangles_become_few_near_the_surface_and_few_stay(shape):
    ball = replay_model.simplified(shape[0])
    assert len(ball.faces) < 0.1 * len(shape[0].faces)
    assert np.linalg.norm(ball.vertices, axis=1) == pytest.approx(1, abs=0.02)
    assert len(replay_model.simplified(shape[1]).faces) == len(shape[1].faces)


def test_a_shape_comes_back_from_its_file(shape, tmp_path):
    hinge = visual_shape.Hinge("joint4", np.eye(3)[:2])
    shape = [shape[0], replace(shape[1], hinge=hinge)]
    file = visual_shape.write_shape(tmp_path / "new", shape)
    for part, back in zip(shape, visual_shape.load_shape(file), strict=True):
        assert (back.link, back.rgb) == (part.link, part.rgb)
        assert np.array_equal(back.vertices, part.vertices)
        assert np.array_equal(back.faces, part.faces)
    assert back.hinge.joint == "joint4"
    assert np.array_equal(back.hinge.line, hinge.line)


def body(name, *geoms):
    """One link of an entity of the engine; a geometry is (mesh, position, quaternion)."""
    vgeoms = [
        SimpleNamespace(
            get_trimesh=lambda mesh=mesh: mesh,
            init_pos=np.array(pos),
            init_quat=np.array(quat),
        )
        for mesh, pos, quat in geoms
    ]
    axis = np.array([[0.0, 0, 1]])
    joint = SimpleNamespace(name="j", n_dofs=1, pos=[1, 2, 3], dofs_motion_ang=axis)
    links = [SimpleNamespace(name=name, vgeoms=vgeoms, joints=[joint])]
    return SimpleNamespace(links=links)


def test_meshes_are_placed_in_their_link_and_joined_by_colour():
    red, blue = (
        trimesh.Trimesh(
            [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2]], vertex_colors=rgb
        )
        for rgb in ([255, 0, 0, 255], [0, 0, 255, 255])
    )
    upright, half = [1.0, 0, 0, 0], 0.5**0.5
    turned = (red, [0, 0, 5], [half, 0, 0, half])  # a quarter turn about z
    arm = body("arm", (red, [0, 0, 0], upright), (blue, [0, 0, 0], upright), turned)
    first, second = visual_shape.read_shape(arm)
    assert (first.rgb, second.rgb) == ((255, 0, 0), (0, 0, 255))
    assert (first.hinge.joint, first.hinge.line.tolist()) == (
        "j",
        [[1, 2, 3], [0, 0, 1]],
    )
    assert first.faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert first.vertices[3:] == pytest.approx(
        np.array([[0, 1, 5], [-1, 0, 5], [0, 0, 6]])
    )


def test_links_of_a_body_can_have_other_names():
    box = body("box_baselink", (BOX, [0, 0, 0], [1.0, 0, 0, 0]))
    (read,) = visual_shape.read_shape(box)
    assert (read.link, len(read.faces)) == ("box_baselink", 12)
    assert visual_shape.read_shape(box, ["left"])[0].link == "left"


def test_copies_of_links_stand_translucent_at_their_target(model):
    node = {node.name: node for node in model.nodes}
    assert pytest.approx(POSE) == np.reshape(node["target_hand"].matrix, (4, 4)).T
    assert [model.nodes[k].name for k in node["target"].children] == ["target_hand"]
    assert model.nodes.index(node["target"]) in model.nodes[0].children
    own, copy = (
        model.meshes[model.nodes[node[name].children[0]].mesh].primitives[0]
        for name in ("hand", "target_hand")
    )
    assert vars(copy.attributes) == vars(
        own.attributes
    )  # the same vertices, stored once
    opaque, clear = (model.materials[one.material] for one in (own, copy))
    assert (opaque.alphaMode, clear.alphaMode) == ("OPAQUE", "BLEND")
    assert clear.pbrMetallicRoughness.baseColorFactor[3] == replay_model.GHOST[3] < 1


def test_the_world_moves_against_a_followed_link_and_else_not(model, shape, turning):
    for case, trace in turning.items():
        _, places = keys(model, case, visual_shape.WORLD, "translation")
        x, y, _ = trace.link_pos[:, 2].T
        assert np.array_equal(places, np.column_stack([-x, 0 * x, y]))
    assert np.float32(model.nodes[0].translation).tolist() == places[0].tolist()
    shadows = {f"shadow_{link}" for link in LINKS}
    assert moved(model) == {visual_shape.WORLD, *LINKS, *shadows}
    plain = pygltflib.GLTF2.load_from_bytes(drawn(shape, turning))
    assert moved(plain) == {*LINKS, *shadows}
    near = pygltflib.GLTF2.load_from_bytes(drawn(shape, turning, near=2))
    for case, trace in turning.items():
        end = replay_model.CLOSE_UP
        _, places = keys(near, case + end, visual_shape.WORLD, "translation")
        x, y, z = trace.link_pos[:, 2].T
        assert np.array_equal(places, np.column_stack([-x, -z, y]))
