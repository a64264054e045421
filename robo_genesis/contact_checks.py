"""Named checks of landings, slides and bounces: all pass, or the invariant that failed is named."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass

import numpy as np

from robo_genesis import l03, sliding
from robo_genesis import posture as postures
from robo_genesis.checks import Check, evaluate
from robo_genesis.contact_metrics import (
    RESTING_BAND,
    BounceMetrics,
    CaseMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.contacts import TOP, ContactCase
from robo_genesis.trace import ContactTrace

MASS_SHARE = 1e-5
"""What the engine's mass may differ from density times volume by, as a share: float32."""

START_TOLERANCE = 2e-3
"""How far a settled cube may lie from where it was put [m]: it sinks in, and must not wander."""


@dataclass(frozen=True, slots=True)
class ContactExperiment:
    """All that the checks of the lab look at.

    `model` counts entities of the baseline's scene, and links, geoms, joints, dofs and qpos of its
    cube; `masses` are the engine's, of the cube and of the ball [kg]; `posture` says what shows the
    baseline's ends.
    """

    model: Mapping[str, int]
    masses: Mapping[str, float]
    cases: Mapping[str, ContactCase]
    traces: Mapping[str, ContactTrace]
    metrics: Mapping[str, CaseMetrics]
    posture: str
    frames: Mapping[str, np.ndarray]

    def landings(self) -> dict[str, LandingMetrics]:
        """Return the metrics of the cubes that are dropped."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, LandingMetrics)}

    def slides(self) -> dict[str, SlideMetrics]:
        """Return those of the cubes that are pushed."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, SlideMetrics)}

    def bounces(self) -> dict[str, BounceMetrics]:
        """Return those of the balls."""
        return {n: m for n, m in self.metrics.items() if isinstance(m, BounceMetrics)}


def structure(run: ContactExperiment) -> list[str]:
    """The scene has two entities; the cube is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    if dict(run.model) == l03.EXPECTED_MODEL:
        return []
    return [f"the model has {dict(run.model)}, expected {l03.EXPECTED_MODEL}"]


def mass(run: ContactExperiment) -> list[str]:
    """The engine's masses are density times volume."""
    expected = {"cube": l03.BASELINE.mass, "ball": l03.DROPPED_BALL.mass}
    return [
        f"the engine's {name} weighs {found:g} kg, density times volume is {expected[name]:g} kg"
        for name, found in run.masses.items()
        if abs(found - expected[name]) > MASS_SHARE * expected[name]
    ]


def stamps(run: ContactExperiment) -> list[str]:
    """Each case covers the time that it asks for: a state for t = 0 and one an outer step."""
    problems = []
    for name, case in run.cases.items():
        t, asked = run.traces[name].t, np.arange(case.steps + 1) * case.dt
        if len(t) != len(asked) or not np.allclose(t, asked, rtol=0, atol=1e-9):
            problems.append(f"{name} has {len(t) - 1} steps to {t[-1]:g} s, asked for "
                            f"{case.steps} steps of {case.dt:g} s")  # fmt: skip
    return problems


def start(run: ContactExperiment) -> list[str]:
    """Each run begins where it was asked to, a pushed cube with the speed that it was given."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        away = np.abs(trace.link_pos[0, 0] - np.array(case.start)).max()
        if away > START_TOLERANCE or (not case.settle and away > l03.SAME_STATE):
            problems.append(f"{name} starts {away:g} m from {case.start}")
        if abs(float(trace.link_vel[0, 0, 0]) - case.speed) > 1e-6:
            problems.append(f"{name} starts with {trace.link_vel[0, 0, 0]:g} m/s along x")
    return problems


def one_factor(run: ContactExperiment) -> list[str]:
    """Cases that are held against each other differ in what is said, and in nothing else."""
    allowed = {pair: {"substeps"} for pair in l03.FINER}
    allowed[l03.EQUAL_STEP] = {"dt", "substeps"}
    allowed[("low_on_050", "high_on_050")] = {"friction", "start"}
    for lane in ("low", "high"):
        allowed[(f"{lane}_on_050", f"{lane}_on_030")] = {"surface_friction"}
    problems = []
    for (first, second), factors in allowed.items():
        a, b = (asdict(run.cases[name]) for name in (first, second))
        differ = {field for field in a if a[field] != b[field]}
        if differ != factors:
            problems.append(f"{first} and {second} differ in {sorted(differ)}")
    return problems


def lands(run: ContactExperiment) -> list[str]:
    """Each dropped cube touches the surface, and its centre never comes below the upper face."""
    problems = []
    for name, found in run.landings().items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min())
        if found.touchdown is None or not (run.traces[name].contacts > 0).any():
            problems.append(f"{name} never touches the surface")
        if lowest <= TOP:
            problems.append(f"{name} comes down to {lowest:g} m, the surface is at {TOP:g} m")
    return problems


def reported_late(run: ContactExperiment) -> list[str]:
    """With one substep, a reported depth is that of the state before: it is one step old."""
    problems = []
    for name in run.landings():
        case, trace = run.cases[name], run.traces[name]
        if case.substeps != 1:
            continue
        below = case.rest_height - trace.link_pos[:-1, 0, 2].astype(np.float64)
        apart = np.abs(trace.penetration[1:, 0] - np.maximum(below, 0)).max()
        if not apart <= 1e-4:
            problems.append(f"{name}: reported and earlier depth are up to {apart:g} m apart")
    return problems


def finer_sinks_less(run: ContactExperiment) -> list[str]:
    """At the same outer step, the cube with more substeps sinks in less."""
    found = run.landings()
    return [
        f"{fine} sinks in by {found[fine].penetration:g} m, "
        f"{coarse} by {found[coarse].penetration:g} m"
        for coarse, fine in l03.FINER
        if not found[fine].penetration < found[coarse].penetration
    ]


def equal_step_equal_states(run: ContactExperiment) -> list[str]:
    """Runs of equal solver steps and other outer steps have the same states at shared times."""
    short, long = (run.traces[name] for name in l03.EQUAL_STEP)
    every = round(long.dt / short.dt)
    apart = np.abs(short.link_pos[::every] - long.link_pos).max()
    return [] if apart <= l03.SAME_STATE else [f"they are up to {apart:g} m apart"]


def settles(run: ContactExperiment) -> list[str]:
    """Each dropped cube comes to rest within the window, near the height where it belongs."""
    return [
        f"{name} is {found.resting_offset:g} m off at the end, allowed are {RESTING_BAND:g} m"
        for name, found in run.landings().items()
        if found.resting_time is None
    ]


def stops(run: ContactExperiment) -> list[str]:
    """Each pushed cube stops within the window, by the rule that was declared."""
    return [
        f"{name} does not stop in {run.traces[name].t[-1]:g} s"
        for name, found in run.slides().items()
        if found.stop_distance is None
    ]


def friction_orders(run: ContactExperiment) -> list[str]:
    """Less friction goes farther; a surface that is not the larger of the two changes nothing."""
    far = {name: found.stop_distance or np.nan for name, found in run.slides().items()}
    problems = []
    for near, farther in (("high_on_050", "low_on_050"), ("low_on_050", "low_on_030")):
        if not far[farther] > far[near]:
            problems.append(f"{farther} stops at {far[farther]:g} m, {near} at {far[near]:g} m")
    apart = abs(far["high_on_030"] - far["high_on_050"])
    if not apart <= l03.SAME_SLIDE:
        problems.append(f"high_on_030 and high_on_050 stop {apart:g} m apart")
    return problems


def larger_friction_rules(run: ContactExperiment) -> list[str]:
    """Of the rules for combining two coefficients, the larger one comes nearest in every slide."""
    problems = []
    for name, found in run.slides().items():
        case = run.cases[name]
        if found.stop_distance is None:
            problems.append(f"{name} does not stop")
            continue
        apparent = sliding.apparent_friction(case.speed, found.stop_distance, case.gravity)
        rule = sliding.nearest_rule(apparent, case.friction, case.surface_friction)
        if rule != "the larger":
            problems.append(f"{name} stops as with {apparent:.3f}, nearest is {rule}")
    return problems


def near_coulomb(run: ContactExperiment) -> list[str]:
    """Each stopping distance is near v² / (2 μ g) with the larger coefficient, hops and all."""
    problems = []
    for name, found in run.slides().items():
        case = run.cases[name]
        friction = max(case.friction, case.surface_friction)
        expected = sliding.coulomb_distance(case.speed, friction, case.gravity)
        measured = found.stop_distance
        if measured is None or abs(measured - expected) > l03.COULOMB_SHARE * expected:
            problems.append(f"{name} stops at {measured} m, Coulomb has {expected:g} m")
    return problems


def level_in_flight(run: ContactExperiment) -> list[str]:
    """In the air, the energy that semi-implicit Euler keeps stays the same to within float32."""
    return [
        f"{name}: it changes by {found.flight_drift:g} J of {found.start_energy:g} J"
        for name, found in run.bounces().items()
        if not found.flight_drift <= l03.LEVEL_SHARE * found.start_energy
    ]


def energy_converges(run: ContactExperiment) -> list[str]:
    """The two finest steps keep the same share at the first bounce; a coarse one is farther off."""
    by_step = sorted(run.bounces(), key=lambda name: run.cases[name].h)
    kept = {name: run.bounces()[name].first_kept for name in by_step}
    gone = [f"{name} does not bounce" for name, share in kept.items() if share is None]
    if gone:
        return gone
    finest, fine, *coarse = (float(kept[name] or 0) for name in by_step)
    apart, worst = abs(fine - finest), max(abs(share - finest) for share in coarse)
    if apart <= l03.FINE_SHARE < worst:
        return []
    return [f"the finest two are {apart:.2f} % apart, the farthest coarse one is {worst:.2f} % off"]


def posture(run: ContactExperiment) -> list[str]:
    """The evidence of both ends says what it is, and shows the cube in two places."""
    return postures.problems(run.posture, run.frames, run.traces["baseline"].link_pos)


CHECKS: tuple[Callable[[ContactExperiment], list[str]], ...] = (
    structure,
    mass,
    stamps,
    start,
    one_factor,
    lands,
    reported_late,
    finer_sinks_less,
    equal_step_equal_states,
    settles,
    stops,
    friction_orders,
    larger_friction_rules,
    near_coulomb,
    level_in_flight,
    energy_converges,
    posture,
)


STUDY_CHECKS = (structure, mass, stamps, start, posture)
"""Those that the lecture's runs must pass, too."""


def run_study_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run what of the lab's checks holds for the lecture's runs."""
    return evaluate(STUDY_CHECKS, run)


def run_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run every check; one that fails says what it found, one that passes what it held."""
    return evaluate(CHECKS, run)
