"""Landings, slides and bounces without Genesis."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import slide_on_corners
from lessons.experiments import experiment_of

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import spec, study, study_spec, theory
from robo_genesis.lessons.l03.pages import LESSON
from robo_genesis.sim.bodies.contacts import SETTINGS
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

# Of all pages; those of the lab are the longer ones.
CASES = {
    n: case for page in LESSON.pages.values() for n, case in page.cases.items()
} | spec.CASES

CLEAN = study_spec.ELLIPTIC | study_spec.FINER_SLIDES
READINGS = {
    "model": spec.EXPECTED_MODEL,
    "mass": {"cube": spec.BASELINE.mass, "ball": spec.DROPPED_BALL.mass},
    study.GROUP: {
        name: theory.contact_seconds(study.case_of(name)) for name in study.ROWS
    },
    **{
        name: {n: getattr(case, name) for n, case in CASES.items()} for name in SETTINGS
    },
}
"""The engine's values of sound runs."""


@pytest.fixture(scope="session")
def contact_traces() -> dict[str, ContactTrace]:
    """The runs of all pages of L03, computed by MuJoCo."""
    traces = {
        name: slide_on_corners(case)
        if name in CLEAN
        else mujoco_contacts.run_case(
            case, own_defaults=name == study_spec.OWN_DEFAULTS
        )
        for name, case in CASES.items()
    }
    for name in CLEAN:
        rounding = np.full_like(
            traces[name].link_ang, 1e-6
        )  # of the forces at the corners
        traces[name] = replace(traces[name], link_ang=rounding)
    for name in study_spec.ENGINE_PAIRS:  # two engines never agree to the last bit
        traces[name] = replace(
            traces[name], link_pos=traces[name].link_pos + np.float32(1e-7)
        )
    return traces


@pytest.fixture(scope="session")
def experiments(contact_traces, frames) -> dict[str, Experiment]:
    """A sound experiment of each page; the lecture ends some landings earlier than the lab."""
    given = (contact_traces, READINGS, [spec.LINK], frames)
    return {name: experiment_of(page, *given) for name, page in LESSON.pages.items()}
