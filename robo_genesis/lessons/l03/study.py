"""What the lecture and the deeper pages of L03 compute from their runs."""

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies.contacts import ContactCase

from . import study_spec, theory
from .metrics import LandingMetrics, SlideMetrics, aligned, of_body

# Group of a bundle's metrics: the engine's time constant of a contact by scene [s].
GROUP = "time_constant"

# Scenes with the landings from all heights side by side.
ROWS = study_spec.STEP_CASES | study_spec.STIFF_CASES | study_spec.RELEASE_CASES

# By cube, its push at the coarsest step.
LANES = {"low": "low_on_050", "high": "high_on_050"}


def row(run: Experiment, *scenes: str) -> list[tuple[str, ContactCase, LandingMetrics]]:
    """Return name, case and metrics of each landing of scenes, in the order of their heights."""
    return [
        (n, case, run.metrics[n]) for scene in scenes for n, case in ROWS[scene].items()
    ]


def case_of(scene: str) -> ContactCase:
    """Return the first case of a scene; its steps and its time constant are those of all."""
    return next(iter(ROWS[scene].values()))


def share_of_step(scene: str) -> float:
    """Return h / T, the solver step as a share of the time constant that is in force."""
    case = case_of(scene)
    return case.h / theory.contact_seconds(case)


def clean(run: Experiment) -> list[tuple[str, ContactCase, SlideMetrics]]:
    """Return name, case and metrics of the slides with the elliptic cone and its resolution."""
    return [
        (name, case, run.metrics[name])
        for name, case in run.cases.items()
        if case.cone == "elliptic" and case.resolution is None
    ]


def first_impulses(run: Experiment, name: str) -> tuple[float, float]:
    """Return the loss of v_x and the gain of v_z against gravity in the first outer step [m/s].

    Both are an impulse of the contact divided by the mass.
    """
    case, (before, after) = run.cases[name], of_body(run.traces[name].link_vel)[:2]
    gained = after - before
    return -gained[0], gained[2] + case.gravity * case.dt


def distance_between(first: ContactTrace, second: ContactTrace) -> FloatArray:
    """Return the distance between the centres of two runs at each shared state, (n+1,) [m].

    The distance of their starts is subtracted: some cubes lie side by side in one
        scene.
    """
    difference = np.subtract(*aligned(first, second, "link_pos"), dtype=np.float64)
    return np.linalg.norm(difference - difference[0], axis=1)


def stops_of_lane(run: Experiment, lane: str) -> dict[str, float | None]:
    """Return the stopping distances of a cube with the default cone by run, coarsest first [m]."""
    names = [LANES[lane], *(f"{step}_{lane}" for step in study_spec.STOP_CASES)]
    return {name: run.metrics[name].stop_distance for name in names}
