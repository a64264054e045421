"""The scenery of a replay follows from the record: axis, target, floor and camera."""

from dataclasses import replace

import numpy as np
import pytest
from falling import LINKS as BOXES
from falling import falling
from trimesh.transformations import (
    quaternion_from_matrix,
    rotation_matrix,
    translation_matrix,
)
from without_sphinx import box

from robo_genesis.core.channels import Channel, Level, Replay, Runs
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies import channels as body_channels
from robo_genesis.sim.visual_shape import WORLD, Part, floor, slab
from robo_genesis.site.replay import scenery

AXIS = np.array([0.48, -0.6, 0.64])
POINT = np.array([0.1, 0.2, 0.3])
"""A point of the axis of the joint [m]; as the axis, in the frame of the link above it."""

START, TARGET = -2.0, -1.75
LINKS = ("base", "upper", "fore", "hand")
POSES_AT_REST = [
    rotation_matrix(angle, [1, 2, k]) @ translation_matrix([0.2 * k, 0.1, 0.3])
    for k, angle in enumerate((0.1, 0.4, 1.2, 2.0))
]


def turned(angle: float, sag: float = 0.0) -> list[np.ndarray]:
    """Return the poses of the links after a turn of the joint, and of the base by `sag` [rad]."""
    upper = POSES_AT_REST[1]
    joint = upper @ rotation_matrix(angle, AXIS, POINT) @ np.linalg.inv(upper)
    all_of_it = rotation_matrix(sag, [0, 1, 0])
    above, below = (all_of_it @ pose for pose in POSES_AT_REST[:2]), POSES_AT_REST[2:]
    return [*above, *(all_of_it @ joint @ pose for pose in below)]


def turning(target=TARGET, final=-1.8, unit="rad", off=0.0) -> Runs:
    """Runs of a joint that turns while the base sags; `off` is an error of its record [rad]."""
    q = np.linspace(START, final, 11)
    poses = np.array([turned(angle - START, 0.1 * (angle - START)) for angle in q])
    quat = np.array(
        [[quaternion_from_matrix(pose) for pose in poses_] for poses_ in poses]
    )
    pos, zero = poses[..., :3, 3], np.zeros((11, 4, 3))
    quat *= np.sign(quat[..., :1])
    trace = BodyTrace(
        t=0.01 * np.arange(11),
        link_pos=pos.astype(np.float32),
        link_quat=quat.astype(np.float32),
        link_vel=zero,
        link_ang=zero,
    )
    position = Channel("position", "q", unit, 4, {"run": q + np.linspace(0, off, 11)})
    level = Level("target", "position", "target", "", {"run": (target,)}, {"run": "x"})
    replay = Replay(("run",), "joint", "arm")
    return Runs(replay, "joint", {"run": trace}, LINKS, [position], {}, [level])


def test_the_axis_of_a_joint_is_found_while_other_joints_move():
    found = scenery.find_hinge(turning())
    assert found is not None
    assert (found.parent, found.moved) == (1, (2, 3))
    assert found.axis == pytest.approx(AXIS, abs=1e-5)
    assert np.cross(found.point - POINT, AXIS) == pytest.approx(np.zeros(3), abs=1e-5)


@pytest.mark.parametrize("final", [-1.8, -2.2])
def test_the_pose_at_the_target_is_that_of_the_joint_alone(final):
    runs = turning(final=final)
    found = scenery.target_poses(runs, scenery.find_hinge(runs))
    expected = dict(zip(LINKS, turned(TARGET - START), strict=True))
    assert list(found) == ["fore", "hand"]
    for link, pose in found.items():
        assert pose == pytest.approx(expected[link], abs=1e-5)


@pytest.mark.parametrize("other", [{"unit": "m"}, {"final": START}, {"off": 0.01}])
def test_a_record_that_shows_no_such_turn_has_no_axis(other):
    assert scenery.find_hinge(turning(**other)) is None


def test_runs_with_several_targets_show_none():
    runs = turning()
    level = replace(runs.levels[0], values={"run": (TARGET,), "other": (0.0,)})
    runs = replace(runs, levels=[level])
    assert scenery.target_poses(runs, scenery.find_hinge(runs)) == {}


def test_an_arm_gets_floor_axis_and_target_and_the_view_of_all_of_it():
    shape = [box(link) for link in LINKS]
    found = scenery.scenery(shape, turning())
    assert found.axis
    assert found.followed is None
    assert [part.link for part in found.parts] == [*LINKS, WORLD, WORLD, "upper"]
    links = np.array([pose[:3, 3] for pose in turned(0.1)])
    for point in (*links, *(links * [1, 1, 0])):  # the shadows lie at z = 0
        right, up, back = found.camera.axes @ (
            point[[0, 2, 1]] * [1, 1, -1] - found.camera.centre
        )
        half = (found.camera.distance - back) * np.tan(scenery.FIELD / 2)
        assert max(abs(right) / scenery.ASPECT, abs(up)) < half
    assert found.camera.distance < 4.0


@pytest.mark.parametrize(("drift", "followed"), [(3.0, 0), (0.1, None)])
def test_a_single_body_that_moves_away_is_followed_horizontally(drift, followed):
    trace = falling(1.0, drift=drift)
    arrays = ("link_pos", "link_quat", "link_vel", "link_ang")
    one = replace(trace, **{name: getattr(trace, name)[:, 1:] for name in arrays})
    runs = body_channels.runs({"run": one}, ["box"], Replay(("run",), "box", "box"))
    found = scenery.scenery([box("box")], runs)
    assert (found.followed, found.axis, found.target) == (followed, False, {})
    middle = [
        0,
        (one.link_pos[:, 0, 2].max() + 0.1) / 2,
        0,
    ]  # of the top and the ground
    assert found.camera.centre == pytest.approx(middle, abs=0.05)


def test_tiles_lie_on_the_widest_still_part_and_a_marker_in_the_air_is_no_ground():
    table = slab((1.0, 0.4, 0.05), top=0.7)
    bowl = replace(table, vertices=0.3 * table.vertices + np.float32([0, 0, 0.5]))
    (tiles,) = scenery.floor_of([bowl, table, bowl])
    assert (tiles.link, len(tiles.faces)) == (WORLD, 40)
    low, high = tiles.vertices.min(axis=0), tiles.vertices.max(axis=0)
    assert low == pytest.approx([-0.5, -0.2, 0.7005])
    assert high == pytest.approx([0.5, 0.2, 0.7005])
    marker = box(WORLD, 0.05, at=(0.4, 0, 0.5))
    for still in ([], [marker]):
        ground, tiles = scenery.floor_of(still)
        assert np.ptp(ground.vertices[:, 2]) == 0
        assert tiles.vertices[:, 2].max() == pytest.approx(scenery.RAISED)


def test_the_picture_holds_all_points_and_no_more_room_than_stated():
    points = np.random.default_rng(1).uniform([0, -1, 2], [0.5, 0, 4], (200, 3))
    camera = scenery.fitted(points)
    right, up, back = (
        camera.axes @ (points[:, [0, 2, 1]] * [1, 1, -1] - camera.centre).T
    )
    half = (camera.distance - back) * np.tan(scenery.FIELD / 2)
    share = np.maximum(np.abs(right) / scenery.ASPECT, np.abs(up)) / half
    assert share.max() == pytest.approx(1 / scenery.ROOM)


def test_the_camera_is_given_in_the_notation_of_the_viewer():
    camera = scenery.Camera(np.array([0.1, 0.25, -1.0]), 1.5)
    assert (camera.orbit, camera.target) == (
        "30deg 78deg 1.5000m",
        "0.1000m 0.2500m -1.0000m",
    )
    assert camera.axes @ camera.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(camera.axes) == pytest.approx(1)


PLACES = ((-0.5, 0.0), (0.5, 0.25))
SHAPE = [Part("box", (1, 2, 3), np.eye(3), np.array([[0, 1, 2]])), floor(2.0)]


def test_each_case_moves_all_links_and_keeps_its_curve_and_none_is_without_a_place():
    one = falling(1.0)
    other = replace(one, link_pos=one.link_pos * 2)
    replay = Replay(("one", "other"), "box", "box", places=PLACES)
    runs = body_channels.runs({"one": one, "other": other}, BOXES, replay)
    found, parts = scenery.side_by_side(runs, SHAPE)
    assert found.links == [
        f"{run}: {link}" for run in ("one", "other") for link in BOXES
    ]
    assert [part.link for part in parts] == ["one: box", "other: box", WORLD]
    assert (
        len({part.rgb for part in (*parts[:2], SHAPE[0])}) == 3
    )  # each box as its curve
    for trace in found.traces.values():
        for k, (source, (x, y)) in enumerate(
            zip(runs.traces.values(), PLACES, strict=True)
        ):
            moved = trace.link_pos[:, 2 * k + 1] - source.link_pos[:, 1]
            assert moved == pytest.approx(np.tile([x, y, 0], (len(moved), 1)), abs=1e-6)
    assert found.channels == runs.channels
    again = replace(runs, replay=replace(replay, repeats=True))
    floors = [
        part for part in scenery.side_by_side(again, SHAPE)[1] if part.link == WORLD
    ]
    for part, (x, y) in zip(floors, PLACES, strict=True):
        assert part.vertices - SHAPE[1].vertices == pytest.approx(
            np.tile([x, y, 0], (4, 1))
        )
    around = scenery.scenery(parts, found)
    assert not around.axis
    assert around.followed is None
    with pytest.raises(ValueError, match="1 places given for 2 runs: one, other"):
        scenery.side_by_side(
            replace(runs, replay=replace(runs.replay, places=PLACES[:1])), SHAPE
        )
