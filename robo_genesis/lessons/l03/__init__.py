"""L03: rigid-body physics and stable simulation."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.declaration import Filmed, Lesson, Moving, on_demand
from robo_genesis.lessons.experiment import MeasuringPage, Readings, counts, runs_of
from robo_genesis.lessons.l03 import (
    checks,
    claims_text,
    mistakes,
    plausibility,
    spec,
    study,
    tables,
    text,
)  # fmt: skip
from robo_genesis.lessons.l03.metrics import case_metrics, metrics_class
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import (
    SETTINGS,
    SURFACE_SIZE,
    TOP,
    build_world,
    record_world,
    time_constant,
)
from robo_genesis.sim.rigid_bodies import read_model
from robo_genesis.sim.visual_shape import read_shape, slab

if TYPE_CHECKING:
    from robo_genesis.lessons.l03 import plots

__all__ = [
    "LAB", "LECTURE", "LESSON", "SURFACE_SIZE", "TOP", "build_world", "mistakes",
    "mujoco_contacts", "plots", "read_model", "read_shape", "record_world", "slab", "spec",
    "study", "tables", "text", "time_constant",
]  # fmt: skip

__getattr__ = on_demand(__name__, "plots")


def readings(shapes: Collection[str], cases: Collection[str]) -> dict[str, Readings]:
    """Return the engine's counts of the cube's scene, its masses, and the settings of cases."""
    return {
        "model": counts(spec.EXPECTED_MODEL),
        "mass": Readings(dict.fromkeys(shapes, "kg")),
        **{name: Readings(dict.fromkeys(cases, "1")) for name in SETTINGS},
    }


def study_readings(rendered: bool) -> Mapping[str, Readings]:
    """Return those of the lecture, with the time constants but none of the runs in MuJoCo."""
    seconds = Readings(dict.fromkeys(spec.STEPS_STUDIED, "s"))
    return readings(["cube"], spec.BY_GENESIS) | {study.GROUP: seconds}


LAB = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=ContactTrace,
    links=(spec.LINK,),
    readings=lambda rendered: readings(["cube", "ball"], spec.CASES),
    measure=case_metrics,
    checks=checks.CHECKS,
    claims=claims_text.CLAIMS,
    parameters=spec.parameters,
    validate=plausibility.require_possible_runs,
)
LECTURE = replace(
    LAB,
    runs=runs_of(spec.STUDY_CASES),
    readings=study_readings,
    checks=(*checks.STUDY_CHECKS, *study.CHECKS),
    parameters=spec.study_parameters,
)

LESSON = Lesson(
    spec=spec,
    metrics={name: metrics_class(case) for name, case in spec.CASES.items()},
    pages={"lab": LAB, spec.STUDY_PAGE: LECTURE},
    filmed=Filmed("the cube"),
    compared=Moving(("baseline", "dt10_sub1"), link=spec.LINK, thing="cube", until=0.5),
    further={"slides": Moving(tuple(spec.SLIDES), link=spec.LINK, thing="cube", axes=("x", "z"))},
)
