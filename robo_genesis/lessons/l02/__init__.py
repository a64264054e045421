"""L02: scenes, entities, and the simulation life cycle."""

from dataclasses import replace
from typing import TYPE_CHECKING

from robo_genesis.core.declaration import Filmed, Lesson, Moving, on_demand
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l02 import (
    checks,
    exercises,
    life_cycle,
    mistakes,
    spec,
    study,
    text,
    trials,
)
from robo_genesis.lessons.l02.metrics import DropMetrics, drop_metrics
from robo_genesis.sim.bodies.falls import fallen
from robo_genesis.sim.bodies.rigid_bodies import read_model, run_drop
from robo_genesis.sim.visual_shape import floor, read_shape

if TYPE_CHECKING:
    from robo_genesis.lessons.l02 import plots

__all__ = [
    "LAB", "LECTURE", "LESSON", "MISTAKES", "exercises", "fallen", "floor", "life_cycle",
    "mistakes", "plots", "read_model", "read_shape", "run_drop", "spec", "text", "trials",
]  # fmt: skip

__getattr__ = on_demand(__name__, "plots")


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's values of the scene and the box."""
    return {"model": counts(spec.EXPECTED_MODEL), "body": Readings({"mass": "kg"})}


def study_readings(rendered: bool) -> dict[str, Readings]:
    """Return those of the lecture, which also tries each call on both sides of build."""
    tried = {life_cycle.GROUP: counts(life_cycle.expected(rendered))}
    return readings(rendered) | tried | trials.readings()


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings=readings,
    measure=drop_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LECTURE = replace(
    LAB,
    runs=runs_of(spec.CASES | spec.SUBSTEP_CASES),
    readings=study_readings,
    checks=(*checks.CHECKS, *study.CHECKS, life_cycle.sides_of_build, *trials.CHECKS),
    parameters=spec.study_parameters,
    frames=(*LAB.frames, spec.TRAYS),
)
MISTAKES = replace(LAB)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, DropMetrics),
    pages={"lab": LAB, spec.STUDY_PAGE: LECTURE, "mistakes": MISTAKES},
    filmed=Filmed("the box"),
    compared=Moving(tuple(spec.CASES), link=spec.LINK, thing="box"),
)
