"""L01: is this machine ready?"""

from dataclasses import replace
from typing import TYPE_CHECKING

from robo_genesis.core.declaration import Filmed, Lesson, Moving, on_demand
from robo_genesis.core.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l01 import checks, exercises, machine, mistakes, spec, text
from robo_genesis.lessons.l01.metrics import FallMetrics, fall_metrics
from robo_genesis.sim.bodies.rigid_bodies import read_model, run_drop
from robo_genesis.sim.visual_shape import floor, read_shape

if TYPE_CHECKING:
    from robo_genesis.lessons.l01 import plots

__all__ = [
    "LAB", "LECTURE", "LESSON", "exercises", "floor", "machine", "mistakes", "plots", "read_model",
    "read_shape", "run_drop", "spec", "text",
]  # fmt: skip

__getattr__ = on_demand(__name__, "plots")


def readings(rendered: bool) -> dict[str, Readings]:
    """Return the engine's counts of the scene."""
    return {"model": counts(spec.EXPECTED_MODEL)}


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings=readings,
    measure=fall_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)
LECTURE = replace(
    LAB,
    readings=lambda rendered: readings(rendered) | machine.readings(),
    checks=(*checks.CHECKS, checks.doctor),
    parameters=spec.lecture_parameters,
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, FallMetrics),
    pages={"lab": LAB, "lecture": LECTURE},
    filmed=Filmed("the sphere"),
    compared=Moving(tuple(spec.CASES), link=spec.LINK, thing="sphere"),
)
