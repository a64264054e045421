"""Named checks of landings, slides and bounces: all pass, or the invariant that failed is named."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate, wrong_counts, wrong_masses, wrong_times
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction, spec
from robo_genesis.lessons.l03.energy import kept_at_bounces
from robo_genesis.lessons.l03.metrics import (
    RESTING_BAND,
    BounceMetrics,
    CaseMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.sim import end_state
from robo_genesis.sim.contacts import SETTINGS, TOP, ContactCase

DEPTH_TOLERANCE = 1e-4
"""Tolerance of a reported depth against that of the positions [m]: corners differ a little."""

START_TOLERANCE = 2e-3
"""Tolerance of a settled cube's position against its start [m]: it sinks in."""


@dataclass(frozen=True, slots=True)
class ContactExperiment:
    """The data that the checks of landings, slides and bounces examine.

    `model` counts the entities of the baseline's scene and the links, geoms, joints, dofs and qpos
    of its cube; `masses` are the engine's, of the cube and of the ball [kg]; `settings` are read
    back from the scenes, by name and case. `end_state` names the evidence of the baseline's first
    and last state: `camera` or `schematic`.
    """

    model: Mapping[str, int]
    masses: Mapping[str, float]
    settings: Mapping[str, Mapping[str, float]]
    cases: Mapping[str, ContactCase]
    traces: Mapping[str, ContactTrace]
    metrics: Mapping[str, CaseMetrics]
    end_state: str
    frames: Mapping[str, np.ndarray]

    def landings(self) -> dict[str, LandingMetrics]:
        """Return the metrics of the dropped cubes."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, LandingMetrics)}

    def slides(self) -> dict[str, SlideMetrics]:
        """Return the metrics of the pushed cubes."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, SlideMetrics)}

    def bounces(self) -> dict[str, BounceMetrics]:
        """Return the metrics of the balls."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, BounceMetrics)}


def structure(run: ContactExperiment) -> list[str]:
    """The scene has two entities; the cube is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return wrong_counts(run.model, spec.EXPECTED_MODEL)


def mass(run: ContactExperiment) -> list[str]:
    """The engine's masses are density times volume."""
    return wrong_masses(run.masses, {case.shape: case.mass for case in run.cases.values()})


def settings(run: ContactExperiment) -> list[str]:
    """Frictions and substeps read back from the scenes are those of the cases."""
    problems = []
    for name, found in run.settings.items():
        for case, value in found.items():
            expected = getattr(run.cases[case], name)
            if not abs(value - expected) <= 1e-6:
                problems.append(f"{case} has {name} {value:g}, expected {expected:g}")
    return problems + [f"{name} was not read" for name in SETTINGS if not run.settings.get(name)]


def stamps(run: ContactExperiment) -> list[str]:
    """The record of each case has one state at t = 0 and one after each outer step."""
    return wrong_times(run.cases, run.traces)


def start(run: ContactExperiment) -> list[str]:
    """Each run begins at the position of its case, a pushed cube with the speed of its case."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        distance = np.abs(trace.link_pos[0, 0] - np.array(case.start)).max()
        if not distance <= (START_TOLERANCE if case.settle else spec.SAME_STATE):
            problems.append(f"{name} starts {distance:g} m from {case.start}")
        if not abs(float(trace.link_vel[0, 0, 0]) - case.speed) <= 1e-6:
            problems.append(f"{name} starts with {trace.link_vel[0, 0, 0]:g} m/s along x")
    return problems


def one_factor(run: ContactExperiment) -> list[str]:
    """Compared cases differ in the declared factors and in nothing else."""
    allowed = {
        **{pair: {"substeps"} for pair in spec.FINER},
        spec.EQUAL_STEP: {"dt", "substeps"},
        ("low_on_050", "high_on_050"): {"friction", "start"},
        **{(f"{own}_on_050", f"{own}_on_030"): {"surface_friction"} for own in ("low", "high")},
    }
    finest = max(spec.BOUNCES, key=lambda name: spec.BOUNCES[name].substeps)
    allowed |= {(name, finest): {"substeps"} for name in spec.BOUNCES if name != finest}
    problems = []
    for (first, second), factors in allowed.items():
        a, b = (asdict(run.cases[name]) for name in (first, second))
        differ = {field for field in a if a[field] != b[field]}
        if differ != factors:
            problems.append(f"{first} and {second} differ in {sorted(differ)}")
    return problems


def lands(run: ContactExperiment) -> list[str]:
    """Each dropped cube touches the surface, and its centre stays above the upper face."""
    problems = []
    for name, found in run.landings().items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min())
        if found.touchdown is None or not (run.traces[name].contacts > 0).any():
            problems.append(f"{name} never touches the surface")
        if lowest <= TOP:
            problems.append(f"{name} falls to {lowest:g} m, the surface is at {TOP:g} m")
    return problems


def reported_late(run: ContactExperiment) -> list[str]:
    """With one substep, a reported depth belongs to the state before: it is one step old."""
    problems = []
    for name in run.landings():
        case, trace = run.cases[name], run.traces[name]
        below = case.rest_height - trace.link_pos[:-1, 0, 2].astype(np.float64)
        error = np.abs(trace.penetration[1:, 0] - np.maximum(below, 0)).max()
        if case.substeps == 1 and not error <= DEPTH_TOLERANCE:
            problems.append(f"{name}: reported and earlier depth differ by up to {error:g} m")
    return problems


def equal_step_equal_states(run: ContactExperiment) -> list[str]:
    """Runs with equal solver steps and different outer steps share states at shared times."""
    short, long = (run.traces[name] for name in spec.EQUAL_STEP)
    every, problems = round(long.dt / short.dt), []
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        error = np.abs(getattr(short, name)[::every] - getattr(long, name)).max()
        if not error <= spec.SAME_STATE:
            problems.append(f"{name} differs by up to {error:g}")
    return problems


def settles(run: ContactExperiment) -> list[str]:
    """Each dropped cube settles at its resting height within the window."""
    return [
        f"{name} ends {found.resting_offset:g} m off its resting height, allowed are "
        f"{RESTING_BAND:g} m"
        for name, found in run.landings().items()
        if found.resting_time is None
    ]


def stops(run: ContactExperiment) -> list[str]:
    """Each pushed cube stops within the window by the declared rule."""
    return [
        f"{name} does not stop in {run.traces[name].t[-1]:g} s"
        for name, found in run.slides().items()
        if found.stop_distance is None
    ]


def friction_orders(run: ContactExperiment) -> list[str]:
    """With less friction a cube travels farther; the smaller coefficient changes nothing."""
    far = {name: found.stop_distance or np.nan for name, found in run.slides().items()}
    problems = []
    for near, farther in (("high_on_050", "low_on_050"), ("low_on_050", "low_on_030")):
        if not far[farther] > far[near]:
            problems.append(f"{farther} stops at {far[farther]:g} m, {near} at {far[near]:g} m")
    difference = abs(far["high_on_030"] - far["high_on_050"])
    if not difference <= spec.SAME_SLIDE:
        problems.append(f"high_on_030 and high_on_050 stop {difference:g} m apart")
    return problems


def near_coulomb(run: ContactExperiment) -> list[str]:
    """Each stopping distance is near v² / (2 μ g) with the larger coefficient, despite the hops."""
    problems = []
    for name, found in run.slides().items():
        case = run.cases[name]
        mu = friction.pair_friction(case)
        expected = friction.coulomb_distance(case.speed, mu, case.gravity)
        measured = found.stop_distance
        if measured is None or not abs(measured - expected) <= spec.COULOMB_SHARE * expected:
            problems.append(f"{name} stops at {measured} m, expected {expected:g} m")
    return problems


def level_in_flight(run: ContactExperiment) -> list[str]:
    """In the air, the energy that semi-implicit Euler conserves is constant to within float32."""
    return [
        f"{name}: it changes by {found.flight_drift} J of {found.start_energy:g} J"
        for name, found in run.bounces().items()
        if found.flight_drift is None
        or not found.flight_drift <= spec.LEVEL_SHARE * found.start_energy
    ]


def energy_converges(run: ContactExperiment) -> list[str]:
    """The finest step keeps at the bounce the energy of a linear spring; a coarse one does not."""
    by_step = sorted(run.bounces(), key=lambda name: run.cases[name].h)
    kept = {name: run.bounces()[name].first_kept for name in by_step}
    missing = [f"{name} does not bounce" for name, share in kept.items() if share is None]
    if missing or not by_step:
        return missing or ["no ball bounces"]
    spring = run.cases[by_step[0]].spring or (np.nan, np.nan)
    errors = [abs(float(share or 0) - 100 * kept_at_bounces(spring[1])) for share in kept.values()]
    if errors[0] <= spec.FINE_SHARE and max(errors) > 5 * spec.FINE_SHARE:
        return []
    return [f"the finest step is {errors[0]:.2f} % off, the worst {max(errors):.2f} %"]


def posture(run: ContactExperiment) -> list[str]:
    """The evidence of the first and the last state is complete and shows the cube in two places."""
    return end_state.problems(run.end_state, run.frames, run.traces["baseline"].link_pos)


CHECKS: tuple[Callable[[ContactExperiment], list[str]], ...] = (
    structure, mass, settings, stamps, start, one_factor, lands, reported_late,
    equal_step_equal_states, settles, stops, friction_orders, near_coulomb, level_in_flight,
    energy_converges, posture,
)  # fmt: skip

STUDY_CHECKS = (structure, mass, settings, stamps, start, posture)
"""The checks that the runs of the lecture must also pass."""


def run_study_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run the checks that the runs of the lecture must also pass."""
    return evaluate(STUDY_CHECKS, run)


def run_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run all checks; the detail of each is what it found, or what it verified if it passed."""
    return evaluate(CHECKS, run)
