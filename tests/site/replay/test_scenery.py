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
from robo_genesis.sim.visual_shape import WORLD, Hinge, Part, floor, slab
from robo_genesis.site.replay import scenery

LINE = np.array([[0.1, 0.2, 0.3], [0.48, -0.6, 0.64]])
"""A point and the direction of the axis of the joint, in the frame of the link that turns."""

START, TARGET = -2.0, -1.75
LINKS = ("base", "upper", "fore", "hand")
POSES_AT_REST = [
    rotation_matrix(angle, [1, 2, k]) @ translation_matrix([0.2 * k, 0.1, 0.3])
    for k, angle in enumerate((0.1, 0.4, 1.2, 2.0))
]


def turned(angle: float) -> list[np.ndarray]:
    """Return the poses of the links after a turn of the joint above `fore` [rad]."""
    fore, turn = POSES_AT_REST[2], rotation_matrix(angle, LINE[1], LINE[0])
    moved = fore @ turn @ np.linalg.inv(fore)
    return [*POSES_AT_REST[:2], *(moved @ pose for pose in POSES_AT_REST[2:])]


def turning() -> Runs:
    """Runs of a joint that turns."""
    q = np.linspace(START, -1.8, 11)
    poses = np.array([turned(angle - START) for angle in q])
    quat = [[quaternion_from_matrix(pose) for pose in state] for state in poses]
    zero = np.zeros((11, 4, 3))
    trace = BodyTrace(
        t=0.01 * np.arange(11),
        link_pos=poses[..., :3, 3].astype(np.float32),
        link_quat=np.array(quat, np.float32),
        link_vel=zero,
        link_ang=zero,
    )
    position = Channel("position", "q", "rad", 4, {"run": q})
    level = Level("target", "position", "target", "", {"run": (TARGET,)}, {"run": "x"})
    replay = Replay(("run",), "joint", "arm")
    return Runs(replay, "joint", {"run": trace}, LINKS, [position], {}, [level])


SHAPES = [replace(box(link), hinge=None) for link in LINKS]
SHAPES[2] = replace(SHAPES[2], hinge=Hinge("joint", LINE))


def test_the_pose_at_the_target_is_that_of_the_joint_alone():
    runs = turning()
    found = scenery.scenery(SHAPES, runs).target
    expected = dict(zip(LINKS, turned(TARGET - START), strict=True))
    assert list(found) == ["fore", "hand"]
    for link, pose in found.items():
        assert pose == pytest.approx(expected[link], abs=1e-5)
    level = replace(runs.levels[0], values={"run": (TARGET,), "other": (0.0,)})
    several = scenery.scenery(SHAPES, replace(runs, levels=[level]))
    assert (several.axis, several.target) == (True, {})


def test_the_rod_lies_on_the_axis_and_no_other_joint_has_one():
    runs = turning()
    rod = scenery.scenery(SHAPES, runs).parts[-1]
    above, fore = POSES_AT_REST[1:3]
    ends = (np.linalg.inv(fore) @ above)[:3, :3] @ rod.vertices.T
    ends = ends.T + (np.linalg.inv(fore) @ above)[:3, 3] - LINE[0]
    off = np.linalg.norm(np.cross(ends, LINE[1]), axis=1)
    assert (rod.link, off.max()) == (
        "upper",
        pytest.approx(scenery.AXIS_RADIUS, abs=1e-5),
    )
    assert not scenery.scenery(SHAPES, replace(runs, subject="other")).axis


def test_an_arm_gets_floor_axis_and_target_and_the_view_of_all_of_it():
    found = scenery.scenery(SHAPES, turning())
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


PLACES = ((-0.5, 0.0), (0.5, 0.25))
SHAPE = [Part("box", (1, 2, 3), np.eye(3), np.array([[0, 1, 2]])), floor(2.0)]


def test_each_case_moves_all_links_and_keeps_its_curve():
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
