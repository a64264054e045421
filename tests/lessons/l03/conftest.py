"""Landings, slides and bounces without Genesis."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import slide_on_corners
from lessons.changed_runs import beginning, passed

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import LESSON, spec, study, study_spec, theory
from robo_genesis.sim.bodies.contacts import SETTINGS
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

MASSES = {"cube": spec.BASELINE.mass, "ball": spec.DROPPED_BALL.mass}
SECONDS = {name: theory.contact_seconds(study.case_of(name)) for name in study.ROWS}
CLEAN = study_spec.ELLIPTIC | study_spec.FINER_SLIDES


def readings_of(page: str) -> dict[str, Mapping[str, float]]:
    """Return the engine's values of sound runs of a page."""
    declared = LESSON.pages[page].readings
    cases = {n: c for n, c in LESSON.pages[page].cases.items() if n not in study_spec.IN_MUJOCO}
    known = {"model": spec.EXPECTED_MODEL, "mass": MASSES, study.GROUP: SECONDS}
    known |= passed(LESSON.pages["lab"])
    known |= {name: {n: getattr(of, name) for n, of in cases.items()} for name in SETTINGS}
    return {
        group: {name: known[group][name] for name in of.units} for group, of in declared.items()
    }


READINGS = {page: readings_of(page) for page in LESSON.pages}
"""The engine's values of sound runs, by page."""


@pytest.fixture(scope="session")
def contact_traces() -> dict[str, ContactTrace]:
    """The runs of all pages of L03, computed by MuJoCo."""
    every = {n: case for page in LESSON.pages.values() for n, case in page.cases.items()}
    every |= spec.CASES  # the longer ones
    traces = {
        name: slide_on_corners(case)
        if name in CLEAN
        else mujoco_contacts.run_case(case, own_defaults=name == study_spec.OWN_DEFAULTS)
        for name, case in every.items()
    }
    for name in CLEAN:
        rounding = np.full_like(traces[name].link_ang, 1e-6)  # of the forces at the corners
        traces[name] = replace(traces[name], link_ang=rounding)
    for name in study_spec.ENGINE_PAIRS:  # two engines never agree to the last bit
        traces[name] = replace(traces[name], link_pos=traces[name].link_pos + np.float32(1e-7))
    return traces


@pytest.fixture(scope="session")
def experiments(contact_traces, frames) -> dict[str, Experiment]:
    """A sound experiment of each page; the lecture ends some landings earlier than the lab."""
    return {
        name: Experiment(
            page,
            {run: beginning(contact_traces[run], case.steps) for run, case in page.cases.items()},
            [spec.LINK],
            READINGS[name],
            {name: frames.get(name, frames["final"]) for name in page.frames * page.camera},
            page.camera,
        )
        for name, page in LESSON.pages.items()
    }
