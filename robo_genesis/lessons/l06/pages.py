"""The measuring pages of L06, and its declaration."""

from dataclasses import replace

import numpy as np

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Run, runs_of
from robo_genesis.core.palette import MARKS
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l06 import checks, spec, study, throughput
from robo_genesis.lessons.l06.metrics import WorldMetrics, world_metrics
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES
from robo_genesis.sim.visual_shape import Part, ball

MEASURES = False


def target_parts() -> list[Part]:
    """Return a sphere at each target for the replay, in the colour of its environment."""
    parts = []
    for (x, y), (name, world) in zip(spec.PLACES, spec.WORLDS.items(), strict=True):
        red, green, blue = bytes.fromhex(MARKS[spec.CASE_MARKS[name]].light[1:])
        centres = world.positions + np.array([x, y, 0])
        parts += [ball(centre, spec.MARKER_RADIUS, (red, green, blue)) for centre in centres]
    return parts


COPY_NOTE = "repeats another run of this page, and has no metrics of its own"

LECTURE = MeasuringPage(
    runs={
        **runs_of(spec.CASES),
        **{name: Run(world, False, COPY_NOTE) for name, world in spec.COPIES.items()},
    },
    kind=Trace,
    joints=JOINT_NAMES,
    readings=study.READINGS,
    measure=world_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
MODEL = {"model": study.READINGS["model"]}
MISTAKES = replace(LECTURE, runs={}, readings=MODEL, checks=(checks.mapping,), camera=False)


def timed(page: MeasuringPage, protocol: throughput.Protocol) -> MeasuringPage:
    """Return a page that also measures a throughput."""
    of_times = checks.equal_work, checks.times_in_order
    return page.with_more(protocol.parameters, readings=protocol.readings(), checks=of_times)


LAB = timed(LECTURE, throughput.PROTOCOL)
LAB = with_functions(LAB, "accept", "command", "step_time")
THROUGHPUT = timed(MISTAKES, throughput.DEEPER)
"""The page that explains why the curve of throughput bends."""

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, WorldMetrics),
    pages={"lab": LAB, "lecture": LECTURE, "mistakes": MISTAKES, "throughput": THROUGHPUT},
    replays={
        "batch": Replay(
            tuple(spec.WORLDS),
            follows="joint1",
            thing="robots",
            goal=lambda name, state: spec.WORLDS[name].positions[-1 if state >= spec.SWITCH else 0],
            places=spec.PLACES,
            credit=CREDIT,
            view="Four robots in the postures of the sample; spheres mark the hands' targets.",
            quality="The hand ends {final_distance} from its last target; after 1.8 s it moved "
            "{moved_later}.",
            filmed="the robots of all environments",
        )
    },
)
