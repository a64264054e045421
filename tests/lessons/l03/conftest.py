"""Landings, slides and bounces without Genesis."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import slide_on_corners

from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import spec, study
from robo_genesis.sim import contacts, mujoco_contacts
from robo_genesis.sim.contacts import ContactCase

MASSES = {"cube": spec.BASELINE.mass, "ball": spec.DROPPED_BALL.mass}
SECONDS = {
    name: mujoco_contacts.time_constant(study.solver_step(name)) for name in spec.STEPS_STUDIED
}


def settings(cases: Mapping[str, ContactCase]) -> dict[str, dict[str, float]]:
    """Return the settings of cases as scenes with these cases have them."""
    return {
        name: {case: getattr(of, name) for case, of in cases.items()} for name in contacts.SETTINGS
    }


READINGS = {
    "lab": {"model": spec.EXPECTED_MODEL, "mass": MASSES, **settings(spec.CASES)},
    "lecture": {
        "model": spec.EXPECTED_MODEL,
        "mass": {"cube": MASSES["cube"]},
        study.GROUP: SECONDS,
        **settings(spec.BY_GENESIS),
    },
}
"""The engine's values of sound runs, by page."""


@pytest.fixture(scope="session")
def contact_traces() -> dict[str, ContactTrace]:
    """The runs of the lab and the lecture of L03, all computed by MuJoCo."""
    traces = {
        name: mujoco_contacts.run_case(case, own_defaults=name == spec.OWN_DEFAULTS)
        for name, case in (spec.CASES | spec.STUDY_CASES).items()
    }
    for name, case in spec.CLEAN_SLIDES.items():
        clean = slide_on_corners(case)
        rounding = np.full_like(clean.link_ang, 1e-6)  # of the forces at the corners
        traces[name] = replace(clean, link_ang=rounding)
    for name in spec.ENGINE_PAIRS:  # two engines never agree to the last bit
        traces[name] = replace(traces[name], link_pos=traces[name].link_pos + np.float32(1e-7))
    return traces
