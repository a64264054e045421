"""Named checks of landings, slides and bounces: all pass, or the invariant that failed is named."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate, wrong_stamps
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.energy import kept_at_bounces
from robo_genesis.lessons.l03.metrics import (
    RESTING_BAND,
    BounceMetrics,
    CaseMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.sim import end_state as postures
from robo_genesis.sim.contacts import SETTINGS, TOP, ContactCase

MASS_SHARE = 1e-5
"""What the engine's mass may differ from density times volume by, as a share: float32."""

DEPTH_APART = 1e-4
"""What a reported depth may differ from that of positions by: corners differ a little [m]."""

START_TOLERANCE = 2e-3
"""How far a settled cube may lie from where it was put [m]: it sinks in, and must not wander."""


@dataclass(frozen=True, slots=True)
class ContactExperiment:
    """All that the checks of the lab look at.

    `model` counts entities of the baseline's scene, and links, geoms, joints, dofs and qpos of its
    cube; `masses` are the engine's, of the cube and of the ball [kg]; `settings` are read back from
    the scenes, by name and case; `posture` says what shows the baseline's ends.
    """

    model: Mapping[str, int]
    masses: Mapping[str, float]
    settings: Mapping[str, Mapping[str, float]]
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
    if dict(run.model) == spec.EXPECTED_MODEL:
        return []
    return [f"the model has {dict(run.model)}, expected {spec.EXPECTED_MODEL}"]


def mass(run: ContactExperiment) -> list[str]:
    """The engine's masses are density times volume."""
    expected = {case.shape: case.mass for case in run.cases.values()}
    found = {name: run.masses.get(name, np.nan) for name in expected}
    return [
        f"the engine's {name} weighs {found[name]:g} kg, density times volume is {of:g} kg"
        for name, of in expected.items()
        if not abs(found[name] - of) <= MASS_SHARE * of
    ]


def settings(run: ContactExperiment) -> list[str]:
    """Frictions and substeps of the scenes, as they are read back, are those asked for."""
    problems = []
    for name, found in run.settings.items():
        for case, value in found.items():
            asked = getattr(run.cases[case], name)
            if not abs(value - asked) <= 1e-6:
                problems.append(f"{case} has {name} {value:g}, asked for {asked:g}")
    return problems + [f"{name} was not read" for name in SETTINGS if not run.settings.get(name)]


def stamps(run: ContactExperiment) -> list[str]:
    """Each case covers the time that it asks for: a state for t = 0 and one an outer step."""
    return wrong_stamps(run.cases, run.traces)


def start(run: ContactExperiment) -> list[str]:
    """Each run begins where it was asked to, a pushed cube with the speed that it was given."""
    problems = []
    for name, case in run.cases.items():
        trace = run.traces[name]
        away = np.abs(trace.link_pos[0, 0] - np.array(case.start)).max()
        if not away <= (START_TOLERANCE if case.settle else spec.SAME_STATE):
            problems.append(f"{name} starts {away:g} m from {case.start}")
        if not abs(float(trace.link_vel[0, 0, 0]) - case.speed) <= 1e-6:
            problems.append(f"{name} starts with {trace.link_vel[0, 0, 0]:g} m/s along x")
    return problems


def one_factor(run: ContactExperiment) -> list[str]:
    """Cases that are held against each other differ in what is said, and in nothing else."""
    allowed = {pair: {"substeps"} for pair in spec.FINER}
    allowed[spec.EQUAL_STEP] = {"dt", "substeps"}
    allowed[("low_on_050", "high_on_050")] = {"friction", "start"}
    for lane in ("low", "high"):
        allowed[(f"{lane}_on_050", f"{lane}_on_030")] = {"surface_friction"}
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
        if not apart <= DEPTH_APART:
            problems.append(f"{name}: reported and earlier depth are up to {apart:g} m apart")
    return problems


def equal_step_equal_states(run: ContactExperiment) -> list[str]:
    """Runs of equal solver steps and other outer steps have the same states at shared times."""
    short, long = (run.traces[name] for name in spec.EQUAL_STEP)
    every, problems = round(long.dt / short.dt), []
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        apart = np.abs(getattr(short, name)[::every] - getattr(long, name)).max()
        if not apart <= spec.SAME_STATE:
            problems.append(f"{name} is up to {apart:g} apart")
    return problems


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
    if not apart <= spec.SAME_SLIDE:
        problems.append(f"high_on_030 and high_on_050 stop {apart:g} m apart")
    return problems


def near_coulomb(run: ContactExperiment) -> list[str]:
    """Each stopping distance is near v² / (2 μ g) with the larger coefficient, hops and all."""
    problems = []
    for name, found in run.slides().items():
        case = run.cases[name]
        friction = max(case.friction, case.surface_friction)
        expected = sliding.coulomb_distance(case.speed, friction, case.gravity)
        measured = found.stop_distance
        if measured is None or not abs(measured - expected) <= spec.COULOMB_SHARE * expected:
            problems.append(f"{name} stops at {measured} m, Coulomb has {expected:g} m")
    return problems


def level_in_flight(run: ContactExperiment) -> list[str]:
    """In the air, the energy that semi-implicit Euler keeps stays the same to within float32."""
    return [
        f"{name}: it changes by {found.flight_drift} J of {found.start_energy:g} J"
        for name, found in run.bounces().items()
        if found.flight_drift is None
        or not found.flight_drift <= spec.LEVEL_SHARE * found.start_energy
    ]


def energy_converges(run: ContactExperiment) -> list[str]:
    """The finest step keeps at the bounce what a linear spring does; a coarse one does not."""
    by_step = sorted(run.bounces(), key=lambda name: run.cases[name].h)
    kept = {name: run.bounces()[name].first_kept for name in by_step}
    gone = [f"{name} does not bounce" for name, share in kept.items() if share is None]
    if gone or not by_step:
        return gone or ["no ball bounces"]
    spring = run.cases[by_step[0]].spring or (np.nan, np.nan)
    off = {name: abs(float(kept[name] or 0) - 100 * kept_at_bounces(spring[1])) for name in by_step}
    finest, worst = off[by_step[0]], max(off.values())
    if finest <= spec.FINE_SHARE and worst > 5 * spec.FINE_SHARE:
        return []
    return [f"the finest is {finest:.2f} % off, the farthest {worst:.2f} %"]


def posture(run: ContactExperiment) -> list[str]:
    """The evidence of both ends says what it is, and shows the cube in two places."""
    return postures.problems(run.posture, run.frames, run.traces["baseline"].link_pos)


CHECKS: tuple[Callable[[ContactExperiment], list[str]], ...] = (
    structure,
    mass,
    settings,
    stamps,
    start,
    one_factor,
    lands,
    reported_late,
    equal_step_equal_states,
    settles,
    stops,
    friction_orders,
    near_coulomb,
    level_in_flight,
    energy_converges,
    posture,
)


STUDY_CHECKS = (structure, mass, settings, stamps, start, posture)
"""Those that the lecture's runs must pass, too."""


def run_study_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run what of the lab's checks holds for the lecture's runs."""
    return evaluate(STUDY_CHECKS, run)


def run_checks(run: ContactExperiment) -> tuple[Check, ...]:
    """Run every check; one that fails says what it found, one that passes what it held."""
    return evaluate(CHECKS, run)
