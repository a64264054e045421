"""L06, a box lands."""

from typing import TYPE_CHECKING

from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.declaration import Filmed, Lesson, Moving, on_demand
from robo_genesis.lessons.experiment import MeasuringPage, counts, runs_of
from robo_genesis.lessons.l06 import checks, spec, text
from robo_genesis.lessons.l06.metrics import LandingMetrics, landing_metrics
from robo_genesis.sim.rigid_bodies import read_model, run_drop

if TYPE_CHECKING:
    from robo_genesis.lessons.l06 import plots

__all__ = ["LAB", "LESSON", "plots", "read_model", "run_drop", "spec", "text"]

__getattr__ = on_demand(__name__, "plots")

LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=BodyTrace,
    links=(spec.LINK,),
    readings=lambda rendered: {"model": counts(spec.EXPECTED_MODEL)},
    measure=landing_metrics,
    checks=checks.CHECKS,
    claims=text.CLAIMS,
    parameters=spec.parameters,
)

LESSON = Lesson(
    spec=spec,
    metrics=dict.fromkeys(spec.CASES, LandingMetrics),
    pages={"lab": LAB},
    filmed=Filmed("the box"),
    compared=Moving(tuple(spec.CASES), link=spec.LINK, thing="box"),
)
