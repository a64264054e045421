"""The measuring pages of L06, and its declaration."""

from dataclasses import replace

import numpy as np

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, runs_of
from robo_genesis.core.palette import MARKS
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES
from robo_genesis.sim.visual_shape import Part, ball

from . import checks, spec, study, throughput
from .metrics import WorldMetrics, world_metrics

MEASURES = False


def target_parts() -> list[Part]:
    """Return a sphere at the target of each robot of the replay, in the colour of the robot."""
    parts = []
    for place, name in zip(spec.PLACES, spec.VARIANTS, strict=True):
        red, green, blue = bytes.fromhex(MARKS[spec.CASE_MARKS[name]].light[1:])
        centre = spec.TARGETS[0] + np.array([*place, 0])
        parts.append(ball(centre, spec.MARKER_RADIUS, (red, green, blue)))
    return parts


WORLDS = MeasuringPage(
    runs=runs_of(spec.CASES)
    | runs_of(
        spec.COPIES,
        measured=False,
        note="repeats another run of this page, and has no metrics of its own",
    ),
    kind=Trace,
    joints=JOINT_NAMES,
    readings=study.READINGS,
    measure=world_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LECTURE = WORLDS.with_more(readings=study.LECTURE_READINGS, checks=checks.LECTURE)
MODEL = {"model": study.READINGS["model"]}
MISTAKES = replace(
    WORLDS, runs={}, readings=MODEL, checks=(checks.mapping,), camera=False
)


def timed(page: MeasuringPage, protocol: throughput.Protocol) -> MeasuringPage:
    """Return a page that also measures a throughput."""
    return page.with_more(
        protocol.parameters, {}, protocol.readings(), [checks.equal_work]
    )


LAB = timed(WORLDS, throughput.PROTOCOL)
LAB = with_functions(LAB, "accept", "command", "step_time")

# The page that explains why the curve of throughput bends.
THROUGHPUT = timed(MISTAKES, throughput.DEEPER)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, WorldMetrics),
    pages={
        "lab": LAB,
        "lecture": LECTURE,
        "mistakes": MISTAKES,
        "throughput": THROUGHPUT,
    },
    replays={
        "robots": Replay(
            tuple(spec.VARIANTS),
            follows="joint4",
            thing="robots",
            goal=lambda name, state: spec.TARGETS[0],
            places=spec.PLACES,
            credit=CREDIT,
            view="Four robots in the postures of the sample; spheres mark the hands' targets.",
            quality="The hand passes its target by {overshoot} and ends {final_distance} from it.",
            filmed="the robots of all environments",
        )
    },
)
