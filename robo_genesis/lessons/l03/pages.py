"""The measuring pages of L03, and its declaration."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from robo_genesis.core.channels import Replay
from robo_genesis.core.checks import Findings
from robo_genesis.core.declaration import Lesson
from robo_genesis.core.exercises import with_functions
from robo_genesis.core.experiment import MeasuringPage, Readings, Run, counts, runs_of
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies.contacts import SETTINGS, ContactCase

from . import checks, metrics, spec, study, study_checks, study_spec

MEASURES = False


def readings(cases: Mapping[str, ContactCase]) -> dict[str, Readings]:
    """Return the engine's values of a page with these cases.

    They are the counts of the cube's scene, the masses, the settings of the cases, and
    the time constants of the scenes side by side.
    """
    found = {
        "model": counts(spec.EXPECTED_MODEL),
        "mass": Readings(dict.fromkeys([case.shape for case in cases.values()], "kg")),
        **{name: Readings(dict.fromkeys(cases, "1")) for name in SETTINGS},
    }
    if scenes := [
        scene for scene, row in study.ROWS.items() if row.keys() <= cases.keys()
    ]:
        found[study.GROUP] = Readings(dict.fromkeys(scenes, "s"))
    return found


CUBE = MeasuringPage(
    runs=runs_of(spec.CASES),
    kind=ContactTrace,
    links=(spec.LINK,),
    readings=readings(spec.CASES),
    measure=metrics.case_metrics,
    checks=checks.CHECKS,
    parameters=spec.parameters,
)


def further(name: str, *own: Callable[..., Findings]) -> MeasuringPage:
    """Return a page with runs in Genesis and checks of its own, and without a camera."""
    cases = study_spec.CASES_OF[name]
    return replace(
        CUBE,
        runs=runs_of(cases),
        readings=readings(cases),
        checks=(*checks.OF_ALL_PAGES, *own),
        parameters=lambda: spec.parameters() | study_spec.parameters(name),
        camera=False,
    )


LECTURE = further("lecture", *study_checks.LECTURE, checks.posture)
CONTACT = further("contact", *study_checks.CONTACT)
IN_MUJOCO = {
    name: Run(case, note="run in MuJoCo, not in Genesis")
    for name, case in study_spec.IN_MUJOCO.items()
}

LESSON = Lesson(
    spec=spec,
    metrics={
        **dict.fromkeys(spec.LANDINGS, metrics.LandingMetrics),
        **dict.fromkeys(spec.SLIDES, metrics.SlideMetrics),
        **dict.fromkeys(spec.BOUNCES, metrics.BounceMetrics),
    },
    pages={
        "lab": with_functions(
            CUBE, "make_scene", "read_contacts", "landing", "push", "stop"
        ),
        "lecture": replace(
            LECTURE, camera=True, frames=(*CUBE.frames, *study_spec.DEEPEST)
        ),
        "mistakes": further("mistakes"),
        "contact": replace(CONTACT, runs={**CONTACT.runs, **IN_MUJOCO}),
        "energy": further("energy", *study_checks.ENERGY),
    },
    replays={
        "drops": Replay(
            tuple(study_spec.DROPPED),
            spec.LINK,
            "cube",
            until=0.5,
            rest=spec.BASELINE.rest_height,
        ),
        "slides": Replay(tuple(study_spec.HOPPED), spec.LINK, "cube", axes=("x", "z")),
    },
)
