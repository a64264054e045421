"""What L08's lab does with a student's functions: their expert, and their counts beside ours."""

from typing import Any

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.core.exercises import Written, brief
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, listed, scaled_value
from robo_genesis.core.trace import Episodes
from robo_genesis.sim.arm import ladder, picking
from robo_genesis.sim.arm.kinematics import hand_pose
from robo_genesis.sim.arm.picking import CLOSE, DONE, OPEN, PickCase
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.table import World

from . import metrics, spec

MEASURES = False


def waypoints(grasp_pose: Written, case: PickCase) -> list[FloatArray]:
    """Return the waypoints of a case by a student's function, as `PickCase.waypoints`."""

    def asked(place: Any, z: float) -> FloatArray:
        places = np.broadcast_to(place, case.beliefs.shape)
        return np.array([grasp_pose(np.append(at, z), case.size[2]) for at in places])

    at, over = asked(case.beliefs, 0.0), asked(case.bowl_at, 0.0)
    down = asked(case.bowl_at, case.drop)
    rise = np.array([0, 0, case.rise])
    return [at[:, 0], at[:, 1], at[:, 1] + rise, over[:, 1] + rise, down[:, 1]]


def machine(ended: Written) -> type[picking.Expert]:
    """Return a phase machine whose phases end by a student's function."""

    class Own(picking.Expert):
        def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
            goal, of_fingers = (
                self.goals[self.phase, self.rows],
                np.isin(self.phase, (CLOSE, OPEN)),
            )
            found = np.asarray(ended(q, qd, goal, of_fingers, self.since))
            if found.dtype != bool or found.shape != self.phase.shape:
                raise TypeError(
                    f"{ended.__name__} returned {brief(found)}, valid are {len(self.phase)} truth "
                    "values, one for each environment. Its own test has to pass first."
                )
            return found

    return Own


def run(
    world: World, joints: Any, case: PickCase, grasp_pose: Written, ended: Written
) -> Episodes:
    """Let a student's expert work in all environments of a scene, and return its episodes."""
    points = waypoints(grasp_pose, case)
    return picking.run(world, joints, case, machine(ended), points)[0]


def levels(rungs: Written, trace: Episodes, case: PickCase) -> np.ndarray:
    """Return by a student's ladder how many rungs each episode passes."""
    lowest, rim = (
        ladder.lowest(trace, case)[-1],
        np.array([*case.bowl_at, bowl.HEIGHT]),
    )
    arrays = (trace.phase, trace.force, trace.object_pos, trace.touches)
    given = [(*(of[:, k] for of in arrays), lowest[k], rim) for k in range(len(lowest))]
    return np.array([rungs(*each) for each in given])


def counted(rungs: Written, trace: Episodes, case: PickCase) -> str:
    """Return how many episodes reach each rung, by the student's ladder and by the course's."""
    mine, course = levels(rungs, trace, case), metrics.reached(trace, case)
    lines = [f"{'rung':10} {'yours':>6} {'course':>7}"]
    for k, name in enumerate(metrics.RUNGS):
        lines.append(f"{name:10} {(mine > k).sum():>6} {(course > k).sum():>7}")
    if (mine != course).any():
        lines.append(
            f"The ladders differ in the episodes {np.flatnonzero(mine != course)}."
        )
    return "\n".join(
        [*lines, f"All phases are done in {(trace.phase[-1] == DONE).sum()} episodes."]
    )


def rate(rungs: Written, wilson: Written, trace: Episodes, case: PickCase) -> str:
    """Return the rate of success with its interval, by the student and by the course."""
    lines, course = [], metrics.reached(trace, case)
    for level, interval in (
        (levels(rungs, trace, case), wilson),
        (course, statistics.wilson),
    ):
        k, n = int(np.sum(level == len(metrics.RUNGS))), len(course)
        lines.append(f"{k} of {n}: {percent(interval(k, n))}")
    return "yours   {}\ncourse  {}".format(*lines)


def percent(interval: tuple[float, float]) -> str:
    """Return an interval of a rate in percent."""
    return " to ".join(f"{100 * end:.1f}" for end in interval) + " %"


def slide(creep: Written, trace: Episodes, case: PickCase) -> str:
    """Return the median speed of the slide in the move, by the student and by the course."""
    held = metrics.reached(trace, case) > metrics.RUNGS.index("carried")
    inner, hand = metrics.inside_move(trace) & held, hand_pose(trace.q).position[..., 2]
    if not inner.any():
        return "No episode is carried, so there is no slide to measure."
    rows = [(inner[:, k], k) for k in np.flatnonzero(inner.sum(axis=0) > 1)]
    found = [
        creep(hand[at, k], trace.object_pos[at, k, 2], trace.t[at]) for at, k in rows
    ]
    of = scaled_value(float(np.median(found)), "mm/s")
    return f"yours   {of}\ncourse  {scaled_value(metrics.grip(trace, held)[1], 'mm/s')}"


def conclusions(run: Experiment) -> str:
    """Return the sentences about the recorded episodes."""
    m, level = run.metrics["exact"], metrics.reached(run.traces["exact"], spec.EXACT)
    n, good = len(level), int(m.resting)
    first = ((rung, (level == k).sum()) for k, rung in enumerate(metrics.RUNGS))
    lost = [f"{count} at “{rung}”" for rung, count in first if count]
    return bullets(
        [
            f"{good} of {n} episodes reach the last rung. The interval of the rate is "
            f"{percent(statistics.wilson(good, n))}.",
            f"Episodes fail first: {listed(lost)}." if lost else "No episode fails.",
            f"All phases are done in {m.finished:.0f} episodes. At some "
            "time the object is lifted in "
            f"{m.raised_once:.0f}.",
            f"In the move a finger presses with {m.press:.1f} N, and the object slides down by "
            f"{scaled_value(m.creep, 'mm/s')} (medians)."
            if m.carried
            else "No episode is carried, so force and slide are not measured.",
        ]
    )
