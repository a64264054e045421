"""What reaches have in common by the mechanics of the robot."""

from collections.abc import Iterator
from itertools import chain

import numpy as np

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l05 import spec
from robo_genesis.lessons.l05.run import SolveCase, command_path
from robo_genesis.sim.arm.kinematics import measured_hand
from robo_genesis.sim.arm.laws import assigned_postures, driven_run, model_joints
from robo_genesis.sim.laws import ZERO, apart, kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of the driven or assigned robot."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            assigned = assigned_postures(
                trace, case.start, run.links, run.traces.values()
            )
            yield from kept(name, chain(assigned, own_targets(trace, case)))
        else:
            command = command_path(case, trace.target[-1])
            yield from kept(
                name, driven_run(trace, case.commanding(command), run.links)
            )


def own_targets(trace: Trace, case: SolveCase) -> Iterator[Finding]:
    """Yield an answer that reaches the target of another question, and not its own."""
    within = case.settings.position_tolerance
    hand = measured_hand(trace, slice(1, None)).position
    targets = np.concatenate([asked.positions for asked in spec.QUESTIONS.values()])
    nearest = np.linalg.norm(hand[:, None] - targets, axis=-1).min(axis=1)
    own = np.where(
        nearest <= within, np.linalg.norm(hand - case.positions, axis=-1), 0.0
    )
    what = "distance of the hand from the target [m], where it reaches one"
    yield from apart("pose", what, own, ZERO, within)
