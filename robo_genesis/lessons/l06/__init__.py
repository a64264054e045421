"""L06: many worlds at once."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robo_genesis.core.channels import View
from robo_genesis.core.palette import MARKS
from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.declaration import Compared, Filmed, Lesson, on_demand
from robo_genesis.lessons.experiment import MeasuringPage, Run, runs_of
from robo_genesis.lessons.l06 import (
    checks,
    claims_text,
    exercises,
    plausibility,
    spec,
    study,
    text,
)
from robo_genesis.lessons.l06.metrics import WorldMetrics, world_metrics
from robo_genesis.lessons.l06.run import ask, commands, reach, reset_some, set_loads
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim.franka import FRANKA_MJCF, JOINT_NAMES
from robo_genesis.sim.joints import resolve_joints
from robo_genesis.sim.visual_shape import WORLD, Part, read_shape

if TYPE_CHECKING:
    from robo_genesis.lessons.l06 import plots

__all__ = [
    "DT", "FRANKA_MJCF", "JOINT_NAMES", "LAB", "LECTURE", "LESSON", "SUBSTEPS", "ask", "commands",
    "exercises", "kinematics", "plots", "reach", "read_shape", "reset_some", "resolve_joints",
    "set_loads", "spec", "study", "target_parts", "text",
]  # fmt: skip

__getattr__ = on_demand(__name__, "plots")


def target_parts(marker: Any) -> list[Part]:
    """Return the shape of a sphere at each target, in the colour of its environment."""
    (part,) = read_shape(marker)
    found = []
    for k, name in enumerate(spec.WORLDS):
        rgb = tuple(bytes.fromhex(MARKS[spec.CASE_MARKS[name]].light[1:]))
        for position in spec.WORLDS[name].positions:
            at = part.vertices + np.float32(position + (*spec.PLACES[k], 0))
            found.append(replace(part, link=WORLD, rgb=rgb, vertices=at))
    return found


COPY_NOTE = "repeats another run of this page, and has no metrics of its own"

LECTURE = MeasuringPage(
    runs={
        **runs_of(spec.CASES),
        **{name: Run(world, False, COPY_NOTE) for name, world in spec.COPIES.items()},
    },
    kind=Trace,
    joints=JOINT_NAMES,
    readings=study.readings,
    measure=world_metrics,
    checks=checks.CHECKS,
    claims=claims_text.CLAIMS,
    parameters=spec.parameters,
    validate=plausibility.require_possible_runs,
)
LAB = replace(LECTURE)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, WorldMetrics),
    pages={"lab": LAB, "lecture": LECTURE},
    filmed=Filmed("the robots of all environments", "the batch"),
    marks=spec.CASE_MARKS,
    compared=Compared(
        tuple(spec.WORLDS),
        joint="joint1",
        band=0.01,
        places=spec.PLACES,
        view=View(
            thing="robots",
            alt="Four robots in 3D, in the postures of the sample that is shown. Spheres in the "
            "colours of the runs are at the targets of the hands.",
            credit="Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from "
            "franka_description, © Franka Robotics GmbH; decimated and converted",
        ),
        alt="Position of joint1 over time in four environments.",
        caption="Position of joint1 in four environments, from get_dofs_position.",
        quality="The hand ends {final_distance} from its last target; after 1.8 s it moved "
        "{moved_later}.",
    ),
)
