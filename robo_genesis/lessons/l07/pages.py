"""The measuring pages of L07, and its declaration."""

from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, json_value, runs_of
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.franka import CREDIT, JOINT_NAMES
from robo_genesis.sim.camera import record

from . import checks, rungs, spec, study, table_map
from .bowl_checks import MESHES
from .bowls import BowlMetrics
from .metrics import SceneMetrics, scene_metrics
from .rest import RestMetrics
from .rest_checks import REST

MEASURES = False


def of_scenes(*scenes: str) -> MeasuringPage:
    """Return a page that examines these scenes, scene A among them."""
    runs = spec.runs(*scenes)
    return MeasuringPage(
        runs=runs_of(runs),
        kind=Trace,
        joints=JOINT_NAMES,
        readings=study.readings(*scenes) | record.groups(*rungs.CAMERAS),
        with_camera={"pixels": study.areas(*scenes)},
        measure=scene_metrics,
        checks=checks.CHECKS,
        parameters=lambda: spec.parameters(runs),
        frames=("initial", "final", *record.frame_names(*rungs.CAMERAS)),
    )


SCENES = spec.SCENES_OF_LECTURE
LECTURE = of_scenes(*SCENES).with_more(
    lambda: (
        spec.parameters(spec.runs(*SCENES) | spec.FURTHER)
        | table_map.parameters()
        | {"attacks": json_value(spec.ATTACKS)}
    ),
    runs_of(spec.FURTHER) | table_map.RUNS,
    study.FURTHER | table_map.READINGS,
    (*checks.LECTURE, table_map.map_follows),
)
LAB = with_functions(
    of_scenes("baseline"), "margin", "at_rest", "visible", "reachable", "ladder"
)
MISTAKES = of_scenes(*spec.SCENES).with_more(checks=(checks.hovering_is_at_rest,))

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, SceneMetrics)
    | dict.fromkeys(MESHES.runs, BowlMetrics)
    | dict.fromkeys(REST.cases, RestMetrics),
    pages={
        "lecture": LECTURE,
        "lab": LAB,
        "mistakes": MISTAKES,
        "meshes": MESHES,
        "rest": REST,
    },
    replays={
        "scenes": Replay(
            ("baseline", "hovering"),
            follows="object",
            thing="object",
            credit=CREDIT,
            view="The robot lifts an object from the table.",
            quality="The object rises {rise}, the hand {hand_rise}.",
            filmed="scene A",
        )
    },
)
