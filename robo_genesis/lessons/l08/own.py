"""What L08's lab does with a student's functions: their expert, and their counts beside ours."""

from typing import Any

import numpy as np

from robo_genesis.core.exercises import Written, refused
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, listed, scaled_value
from robo_genesis.core.trace import Episodes
from robo_genesis.lessons.l08 import ladder, rates, spec
from robo_genesis.lessons.l08.checks import order_does_not_matter
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.kinematics import ARM, hand_pose
from robo_genesis.sim.arm.picking import CLOSE, DONE, OPEN, PickCase
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.table import World

MEASURES = False


def missing(function: Written, *given: Any) -> bool:
    """Return whether a function is not written yet, and print which one."""
    found = refused(lambda: function(*given))
    if isinstance(found, NotImplementedError):
        print(f"{found}; the course's code is used meanwhile")
        return True
    return False


def waypoints(grasp_pose: Written, case: PickCase) -> list[FloatArray]:
    """Return the waypoints of a case by a student's function, as `PickCase.waypoints`."""
    bowls = np.tile([*case.bowl_at, 0.0], (len(case.beliefs), 1))
    places = np.insert(case.beliefs, 2, 0.0, axis=1), bowls, np.add(bowls, (0, 0, case.drop))
    at, over, down = (np.array([grasp_pose(p, case.size[2]) for p in of]) for of in places)
    rise = np.array([0, 0, case.rise])
    return [at[:, 0], at[:, 1], at[:, 1] + rise, over[:, 1] + rise, down[:, 1]]


def machine(ended: Written) -> type[picking.Expert]:
    """Return a phase machine whose phases end by a student's function."""

    class Own(picking.Expert):
        def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
            goal, of_fingers = self.goals[self.phase, self.rows], np.isin(self.phase, (CLOSE, OPEN))
            return np.asarray(ended(q, qd, goal, of_fingers, self.since))

    return Own


def run(world: World, joints: Any, case: PickCase, grasp_pose: Written, ended: Written) -> Episodes:
    """Let a student's expert work in all environments of a scene, and return its episodes."""
    points = None if missing(grasp_pose, np.zeros(3), 0.1) else waypoints(grasp_pose, case)
    q = np.zeros(ARM + 2)
    of = picking.Expert if missing(ended, q, q, q[:ARM], False, 1) else machine(ended)
    return picking.run(world, joints, case, of, points)[0]


def repeated(mine: Episodes, course: Episodes, case: PickCase) -> str:
    """Return whether a student's expert does the same as the recorded one."""
    same = int((ladder.reached(mine, case) == ladder.reached(course, case)).sum())
    apart = np.linalg.norm(mine.object_pos[-1] - course.object_pos[-1], axis=1).max()
    return (
        f"Your expert reaches the rung of the recorded one in {same} of {len(case.starts)} "
        f"episodes. At the end the objects are at most {scaled_value(float(apart), 'mm')} apart."
    )


def levels(rungs: Written, trace: Episodes, case: PickCase) -> np.ndarray | None:
    """Return by a student's ladder how many rungs each episode passes, None if it is missing."""
    lowest, rim = ladder.lowest(trace, case)[-1], np.array([*case.bowl_at, bowl.HEIGHT])
    arrays = (trace.phase, trace.force, trace.object_pos, trace.touches)
    given = [(*(of[:, k] for of in arrays), lowest[k], rim) for k in range(len(lowest))]
    return None if missing(rungs, *given[0]) else np.array([rungs(*each) for each in given])


def counted(rungs: Written, trace: Episodes, case: PickCase) -> str:
    """Return how many episodes reach each rung, by the student's ladder and by the course's."""
    mine, course = levels(rungs, trace, case), ladder.reached(trace, case)
    lines = [f"{'rung':10} {'yours':>6} {'course':>7}"]
    for k, name in enumerate(ladder.RUNGS):
        own = "-" if mine is None else (mine > k).sum()
        lines.append(f"{name:10} {own:>6} {(course > k).sum():>7}")
    lines.append(f"All phases are done in {(trace.phase[-1] == DONE).sum()} episodes.")
    if mine is not None and len(other := np.flatnonzero(mine != course)):
        k = other[0]
        lines.append(f"The ladders differ in {len(other)} episodes; in number {k} yours counts "
                     f"{mine[k]} rungs, the course's {course[k]}.")  # fmt: skip
    return "\n".join(lines)


def rate(rungs: Written, wilson: Written, trace: Episodes, case: PickCase) -> str:
    """Return the rate of success with its interval, by the student and by the course."""
    n, course = len(case.starts), int((ladder.reached(trace, case) == len(ladder.RUNGS)).sum())
    mine = levels(rungs, trace, case)
    own = course if mine is None else int((mine == len(ladder.RUNGS)).sum())
    of = "-" if missing(wilson, own, n) else percent(wilson(own, n))
    by_course = percent(rates.wilson(course, n))
    return f"yours   {own} of {n}: {of}\ncourse  {course} of {n}: {by_course}"


def percent(interval: tuple[float, float]) -> str:
    """Return an interval of a rate in percent."""
    return " to ".join(f"{100 * end:.1f}" for end in interval) + " %"


def slide(creep: Written, trace: Episodes, case: PickCase) -> str:
    """Return the median speed of the slide in the move, by the student and by the course."""
    held = ladder.reached(trace, case) > ladder.RUNGS.index("carried")
    inner, hand = ladder.inside_move(trace) & held, hand_pose(trace.q).position[..., 2]
    rows = [(inner[:, k], k) for k in np.flatnonzero(inner.sum(axis=0) > 1)]
    if not rows:
        return "No episode is carried, so there is no slide to measure."
    course, of = scaled_value(ladder.grip(trace, held)[1], "mm/s"), "-"
    if not missing(creep, *(np.arange(2.0),) * 3):
        found = [creep(hand[at, k], trace.object_pos[at, k, 2], trace.t[at]) for at, k in rows]
        of = scaled_value(float(np.median(found)), "mm/s")
    return f"yours   {of}\ncourse  {course}   in {len(rows)} episodes"


def conclusions(run: Experiment) -> str:
    """Return the sentences about the recorded episodes."""
    m, n = run.metrics["exact"], len(spec.EXACT.starts)
    good, counts = int(m.resting), [n, *(int(getattr(m, rung)) for rung in ladder.RUNGS)]
    steps = zip(ladder.RUNGS, counts, counts[1:], strict=False)
    lost = [f"{a - b} at “{rung}”" for rung, a, b in steps if a > b]
    differ = sum(finding.found for finding in order_does_not_matter(run))
    side = "nearer to the base" if m.short < 0 else "further from the base"
    return bullets([
        f"{good} of {n} episodes reach the last rung. The interval of the rate is "
        f"{percent(rates.wilson(good, n))}.",
        f"Episodes fail first: {listed(lost)}." if lost else "No episode fails.",
        f"All phases are done in {m.finished:.0f} episodes. At some time the object is lifted in "
        f"{m.raised_once:.0f}.",
        f"When the fingers begin to close, the hand is "
        f"{scaled_value(abs(m.short), 'mm')} {side} than the expert believes the object (median).",
        f"In the move a finger presses with {m.press:.1f} N, and the object slides down by "
        f"{scaled_value(m.creep, 'mm/s')} (medians)." if counts[4] else
        "No episode is carried, so force and slide are not measured.",
        f"The repeated batch differs in {differ} numbers." if differ else
        "The repeated batch is equal to the last bit.",
    ])  # fmt: skip
