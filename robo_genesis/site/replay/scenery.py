"""What a replay shows around the recorded links: a floor, the axis, the target, and its camera.

Several runs can be in one view: the links of each at a place of its own, and all move
    at once.

All of it follows from the record and the shape; nothing here needs the engine.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np
import trimesh
from trimesh.transformations import quaternion_matrix, rotation_matrix

from robo_genesis.core import palette
from robo_genesis.core.channels import Run, Runs
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.visual_shape import WORLD, Hinge, Part, floor
from robo_genesis.site.figures.case_labels import MARKS

# Width of the tiles of the floor [m]; they show its distance and the motion above it
TILE = 0.1

TILE_RGB = (190, 190, 190)
RAISED = 5e-4  # Height of the tiles above the floor that they are drawn on [m]

# Colour, radius and length of the rod along a joint's axis [m].
AXIS_RGB, AXIS_RADIUS, AXIS_LENGTH = (240, 190, 0), 0.006, 0.4

# Direction from the view's centre to the camera: about the vertical and from it [rad].
THETA, PHI = np.radians(30), np.radians(78)

# Vertical angle of view [rad]: the viewer's own for pictures that are wider than high.
FIELD = np.radians(30)

ASPECT = 4 / 3  # Width of the picture by its height, as in `replay.css`

ROOM = 1.2  # Size of the picture by that of the motion in it


@dataclass(frozen=True, slots=True)
class Camera:
    """Centre of the view (3,) and distance to it [m], in the frame of the viewer, y up."""

    centre: FloatArray
    distance: float

    @property
    def orbit(self) -> str:
        """The direction and the distance in the viewer's notation."""
        theta, phi = np.degrees([THETA, PHI])
        return f"{theta:.0f}deg {phi:.0f}deg {self.distance:.4f}m"

    @property
    def target(self) -> str:
        """The centre in the viewer's notation."""
        return " ".join(f"{value:.4f}m" for value in self.centre)

    def angle(self, width: float) -> str:
        """Return the vertical angle of view of a picture this wide [m], as the viewer writes it."""
        return f"{2 * np.degrees(np.arctan(width / ASPECT / 2 / self.distance)):.2f}deg"

    @property
    def axes(self) -> FloatArray:
        """The camera's right, up and back (3, 3), unit vectors in its rows."""
        back = [np.sin(PHI) * np.sin(THETA), np.cos(PHI), np.sin(PHI) * np.cos(THETA)]
        right = [np.cos(THETA), 0.0, -np.sin(THETA)]
        return np.array([right, np.cross(back, right), back])


@dataclass(frozen=True, slots=True)
class Scenery:
    """The parts to draw with the camera; `axis` says whether one of them is the axis of a joint.

    `target` is by link its pose (4, 4) where the joint is at its target and the others
    at their start. The view follows the link number `followed` horizontally; None if it
    does not move. A close-up has the link number `near` in its centre; None for no
    close-up. `ground` is the height on which shadows fall [m].
    """

    parts: Sequence[Part]
    camera: Camera
    axis: bool = False
    target: Mapping[str, FloatArray] = field(default_factory=dict)
    followed: int | None = None
    near: int | None = None
    ground: float = 0.0


def scenery(shape: Sequence[Part], runs: Runs) -> Scenery:
    """Return what the replay of some runs shows.

    Raises:
        ValueError: two links have one name.
    """
    followed = find_followed(runs)
    *_, tiles = floors = floor_of(shape)
    parts, ground = [*shape, *floors], float(tiles.vertices[:, 2].max())
    moving = swept(shape, runs, followed)
    shadows = moving * [1, 1, 0] + [0, 0, ground]
    camera = fitted(np.concatenate([moving, shadows]))
    for part in shape:
        if part.hinge and part.hinge.joint == runs.subject:
            turned = list(runs.links).index(part.link)
            target = target_poses(runs, turned, part.hinge)
            parts.append(rod(runs, turned, part.hinge))
            return Scenery(parts, camera, axis=True, target=target, ground=ground)
    return Scenery(parts, camera, followed=followed, ground=ground)


def find_followed(runs: Runs) -> int | None:
    """Return the number of the only link if it leaves its tile of the floor, else None."""
    places = np.concatenate(
        [trace.link_pos[:, 0, :2] for trace in runs.traces.values()]
    )
    return 0 if len(runs.links) == 1 and np.ptp(places, axis=0).max() > TILE else None


def target_poses(runs: Runs, turned: int, hinge: Hinge) -> dict[str, FloatArray]:
    """Return the poses of the turned links at the target, empty if the runs have several targets.

    A rigid link below the joint turns about its axis, so its pose at the start decides
    the result. The links are in the order of their chain.

    Args:
        runs: whose first channel is the position of the joint.
        turned: number of the first link that the joint turns.
        hinge: the joint.
    """
    position = runs.channels[0]
    targets = {v for level in runs.levels_of(position) for v in level.values.values()}
    starts = {float(values[0]) for values in position.values.values()}
    if len(targets) != 1 or len(starts) != 1:
        return {}
    ((target,),), (start,) = targets, starts
    place, (point, axis) = poses(runs.first, turned)[0], hinge.line
    world_axis, world_point = place[:3, :3] @ axis, (place @ [*point, 1.0])[:3]
    turn = rotation_matrix(target - start, world_axis, world_point)
    below = range(turned, len(runs.links))
    return {runs.links[k]: turn @ poses(runs.first, k)[0] for k in below}


def rod(runs: Runs, turned: int, hinge: Hinge) -> Part:
    """Return a rod along the axis of a joint, as a part of the link above it."""
    point, axis = hinge.line
    half = axis * AXIS_LENGTH / 2
    mesh = trimesh.creation.cylinder(
        AXIS_RADIUS, segment=[point - half, point + half], sections=16
    )
    above, below = (poses(runs.first, k)[0] for k in (turned - 1, turned))
    mesh.apply_transform(np.linalg.solve(above, below))
    return Part(runs.links[turned - 1], AXIS_RGB, mesh.vertices, mesh.faces)


def floor_of(shape: Sequence[Part]) -> list[Part]:
    """Return tiles on the widest still parts of a shape, with a floor at z = 0 if it has none.

    A still part that is smaller than a tile, such as a marker, has no tiles.
    """

    def size(part: Part) -> FloatArray:
        """Return length and width (2,) [m]."""
        return np.ptp(part.vertices[:, :2], axis=0)

    wide = [part for part in shape if part.link == WORLD and size(part).min() > TILE]
    if not wide:
        ground = floor(2.0)
        return [ground, tiles_on(ground)]
    widest = max(size(part).prod() for part in wide)
    # The same table at each place of a batch has tiles.
    return [tiles_on(part) for part in wide if size(part).prod() > 0.99 * widest]


def tiles_on(still: Part) -> Part:
    """Return the tiles on the top of a part."""
    low, high = still.vertices.min(axis=0), still.vertices.max(axis=0)
    counts = np.ceil((high - low)[:2] / TILE - 0.5).astype(int)
    dark = np.argwhere(np.indices(counts).sum(axis=0) % 2)  # (n, 2), every other tile
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    corners = low[:2] + TILE * (dark[:, None] + square).reshape(-1, 2)
    vertices = np.column_stack([corners, np.full(len(corners), high[2] + RAISED)])
    halves = np.array([[0, 1, 2], [0, 2, 3]]) + 4 * np.arange(len(dark))[:, None, None]
    return Part(WORLD, TILE_RGB, vertices, halves.reshape(-1, 3))


def swept(shape: Sequence[Part], runs: Runs, followed: int | None) -> FloatArray:
    """Return the corners (n, 3) of the boxes around links at all samples of all runs [m].

    Positions are horizontally relative to the followed link.
    """
    found = []
    for trace, k in product(runs.traces.values(), range(len(runs.links))):
        own = [part.vertices for part in shape if part.link == runs.links[k]]
        if own:
            vertices = np.concatenate(own)
            box = trimesh.bounds.corners([vertices.min(axis=0), vertices.max(axis=0)])
            corners = np.column_stack([box, np.ones(8)])
            places = (corners @ poses(trace, k).transpose(0, 2, 1))[..., :3]
            if followed is not None:
                places[..., :2] -= trace.link_pos[:, None, followed, :2]
            found.append(places.reshape(-1, 3))
    return np.concatenate(found)


def fitted(points: FloatArray) -> Camera:
    """Return the camera with points (n, 3) of the record in its picture."""
    axes = Camera(np.zeros(3), 1.0).axes
    seen = points[:, [0, 2, 1]] * [1, 1, -1] @ axes.T  # right, up, back
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    right, up, back = (seen - middle).T
    reach = ROOM * np.maximum(np.abs(right) / ASPECT, np.abs(up)) / np.tan(FIELD / 2)
    return Camera(middle @ axes, float((back + reach).max()))


def poses(trace: Run, link: int) -> FloatArray:
    """Return the poses (n+1, 4, 4) of a link."""
    found: FloatArray = quaternion_matrix(trace.link_quat[:, link])
    found[:, :3, 3] = trace.link_pos[:, link]
    return found


def moved(t: FloatArray, pos: FloatArray, quat: FloatArray) -> BodyTrace:
    """Return a run of links with these times (n+1,) and poses (n+1, l, …), its speeds left out."""
    unread = np.zeros_like(pos)
    return BodyTrace(t, pos, quat, unread, unread)


def side_by_side(runs: Runs, shape: Sequence[Part]) -> tuple[Runs, list[Part]]:
    """Return runs whose traces all have the links of all runs, and the shape of these links.

    A case then decides which curves are drawn bold, and not what moves.

    Args:
        runs: the runs, each with the links of one robot; their replay has a place for
            each.
        shape: of the robot; parts of the world remain where they are, unless the replay
            repeats them.
    """
    cases, traces = list(runs.traces), runs.traces.values()
    places = np.pad(runs.replay.places, ((0, 0), (0, 1)))  # (cases, 3) [m]
    pos = np.concatenate([trace.link_pos for trace in traces], axis=1)
    quat = np.concatenate([trace.link_quat for trace in traces], axis=1)
    all_links = moved(runs.t, pos + np.repeat(places, len(runs.links), axis=0), quat)
    links = [f"{case}: {link}" for case in cases for link in runs.links]
    marks = palette.marks_of(cases, MARKS)

    def of_case(part: Part, case: str) -> Part:
        """Return a part of one run; the link that its curve follows has the curve's colour."""
        red, green, blue = bytes.fromhex(palette.MARKS[marks[case]].light[1:])
        rgb = (red, green, blue) if part.link == runs.replay.follows else part.rgb
        return replace(part, link=f"{case}: {part.link}", rgb=rgb, hinge=None)

    moving = [part for part in shape if part.link != WORLD]
    parts = [of_case(part, case) for case in cases for part in moving]
    still = [part for part in shape if part.link == WORLD]
    if runs.replay.repeats:
        still = [
            replace(part, vertices=part.vertices + place.astype(np.float32))
            for place in places
            for part in still
        ]
    together = dict.fromkeys(cases, all_links)
    return replace(runs, traces=together, links=links), [*parts, *still]
