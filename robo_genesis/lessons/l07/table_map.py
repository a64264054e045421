"""A map of the table: what the object of scene A would pass at each of its cells.

The solver's answers for pregrasp and grasp are assigned, not commanded. What the
cameras see is computed from the recorded views, without a picture for each cell.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, at_most, equal
from robo_genesis.core.experiment import Experiment, Run, case_inputs, counts
from robo_genesis.core.scene import DT, FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics, lifting
from robo_genesis.sim.arm.engine_kinematics import IkSettings
from robo_genesis.sim.arm.joint_control import ControlCase, assign_postures
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.bodies import table
from robo_genesis.sim.camera.record import view_of

from . import rungs, spec

# Centres of the cells [m].
X, Y = np.arange(2, 11) / 10, np.arange(-3, 4) * 0.12

# Counts of each cell: of its two postures those that the solver accepts, without
# contact of the robot with table or itself, and of these those without contact
# with the bowl.
COUNTED = ("reached", "free")


@dataclass(frozen=True, slots=True, kw_only=True)
class MapCase:
    """Two questions to the solver for each of m places (x, y) of an object [m]."""

    places: FloatArray
    settings: IkSettings
    dt: float = DT

    @property
    def steps(self) -> int:
        """Number of questions, 2 m."""
        return 2 * len(self.places)

    @property
    def targets(self) -> FloatArray:
        """Positions of the hand (2 m, 3), by turns for pregrasp and grasp [m]."""
        ends = [
            lifting.waypoints((*at, 0.0), spec.GOOD.size[2])[:2] for at in self.places
        ]
        return np.concatenate(ends)

    @property
    def start(self) -> ControlCase:
        """The settings from which the answers are assigned."""
        return replace(spec.GOOD.commanding(spec.GOOD.q_start), steps=self.steps)


CASE = MapCase(places=np.array([(x, y) for y in Y for x in X]), settings=spec.ONE_START)
CELLS = range(len(CASE.places))
NOTE = "answers of the solver assigned to the state, no step taken; its time is nominal, and the "
NOTE += "object is where its cell is"
RUNS = {"table": Run(CASE, False, NOTE)}


def parameters() -> dict[str, Any]:
    """Return the inputs of the map."""
    return {"table_map": case_inputs({"table": CASE})}


def record(page: Any, world: table.World, joints: JointMap) -> None:
    """Give a page the answers for all cells and their counts, in the world of scene A."""
    page.readings |= {f"table_{name}": {} for name in COUNTED}
    postures: list[FloatArray] = []
    *others, _ = world.fixed
    for cell in CELLS:
        points = CASE.targets[2 * cell : 2 * cell + 2]
        answers = lifting.ask(
            world.robot, joints, spec.GOOD.q_start, CASE.settings, points
        )
        postures += [answer.q for answer in answers]
        within = CASE.settings.tolerances
        left = [a.q for a in answers if kinematics.accepted(a.q, a.error, *within)]
        for name, fixed in zip(COUNTED, (others, world.fixed), strict=True):
            left = [
                q for q in left if not lifting.touches(world.robot, joints, fixed, q)
            ]
            page.readings[f"table_{name}"][str(cell)] = len(left)
    trace = assign_postures(
        world.scene, world.robot, joints, CASE.start, np.stack(postures)
    )
    page.traces["table"] = with_bodies(trace)
    page.readings["map"] = totals(page.experiment)


def with_bodies(trace: Trace) -> Trace:
    """Return a run with the object in each answer's cell, and the ball at its start."""
    states = trace.steps + 1
    bodies = np.tile(
        [spec.GOOD.centre, (*spec.GOOD.bowl_at, table.BALL_HEIGHT)], (states, 1, 1)
    )
    bodies[1:, 0, :2] = np.repeat(CASE.places, 2, axis=0)
    quat = np.tile(np.array([1, 0, 0, 0], np.float32), (states, 2, 1))
    pos = np.concatenate([trace.link_pos, bodies.astype(np.float32)], axis=1)
    return replace(
        trace, link_pos=pos, link_quat=np.concatenate([trace.link_quat, quat], axis=1)
    )


def residuals(trace: Trace) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return of each answer the residuals [m] and [rad] and the height of the fingertips [m]."""
    hand = kinematics.measured_hand(trace, slice(1, None))
    error = kinematics.pose_error(kinematics.Pose(CASE.targets, spec.DOWN), hand)
    return *kinematics.distances(error), kinematics.fingertip(hand)[:, 2]


def outlines(found: Experiment, camera: str) -> FloatArray:
    """Return the area of the object's outline in each cell, in a view at home (m,) [pixel].

    It is 0 where not all of the outline is inside the picture.
    """
    view = view_of(replace(found, rendered=False), camera)  # without its pictures
    centres = np.column_stack([CASE.places, np.full(len(CELLS), spec.GOOD.centre[2])])
    return np.array(
        [rungs.outline(spec.GOOD.corners(at), view, inside=True) for at in centres]
    )


# What each verdict says.
WORDS = {
    "reachable": "the hand reaches it",
    **{
        name: f"in the picture of the camera {place}"
        for name, place in rungs.CAMERAS.items()
    },
    "graspable": "free of the bowl and the edge",
}

READINGS = {f"table_{name}": counts(map(str, CELLS)) for name in COUNTED} | {
    "map": counts(WORDS)
}


def verdicts(found: Experiment) -> dict[str, np.ndarray]:
    """Return which cells (m,) pass which test, by the names of `WORDS`."""
    answers = (
        [found.readings[f"table_{name}"][str(k)] for k in CELLS] for name in COUNTED
    )
    reached, free = (np.array(good) == 2 for good in answers)
    least = [spec.LIMITS[name][0] for name in ("pregrasp", "grasp")]
    reached &= (residuals(found.traces["table"])[2].reshape(-1, 2) >= least).all(axis=1)
    cases = [replace(spec.GOOD, place=(x, y, 0.0)) for x, y in CASE.places]
    margins = [min(table.gap(*of) for of in rungs.pairs(case.boxes)) for case in cases]
    free &= reached & (np.array(margins) >= spec.LIMITS["margin"][0])
    seen = {
        name: outlines(found, name) >= spec.LIMITS["pixels"][0]
        for name in rungs.CAMERAS
    }
    return {"reachable": reached, **seen, "graspable": free}


def totals(found: Experiment) -> dict[str, int]:
    """Return how many of the cells that the hand reaches pass each test."""
    good = verdicts(found)
    return {name: int((of & good["reachable"]).sum()) for name, of in good.items()}


def map_follows(found: Experiment) -> Findings:
    """Where the map says that the hand reaches a place, both recorded poses of the hand
    are within the solver's tolerances, up to 2 µm and 2 µrad. The object's outline is
    inside the picture of the camera beside the table, with at least 200 pixels, in each
    cell that the hand reaches.
    """
    counted = totals(found)
    for name, count in counted.items():
        yield equal(f"map.{name}", found.readings["map"][name], count)
    yield equal("seen", counted["world"], counted["reachable"])
    reached = verdicts(found)["reachable"]
    left = residuals(found.traces["table"])[:2]
    for name, of, most in zip(
        ("m", "rad"), left, CASE.settings.tolerances, strict=True
    ):
        yield at_most(f"residual_{name}", of[np.repeat(reached, 2)].max(), most + 2e-6)
