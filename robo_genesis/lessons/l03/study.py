"""What a landing and a slide owe to the solver's step, to the friction model, and to the engine."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.metrics import CLEAR, CaseMetrics, LandingMetrics, SlideMetrics
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase

GROUP = "time_constant"
"""Of a bundle's metrics: what the engine gives a contact at each solver step [s]."""

LEFT_OVER = 1e-3
"""What depths may still differ by at the finest step [m]: cubes from higher up are faster."""

HOPS_APART = 1e-4
"""What a hop may differ by between two engines of equal settings [m]."""

STEPPED_APART = 2e-4
"""What a slide on four corners may differ from the stepped formula by [m]."""

NEARLY = 0.05
"""What a stopping distance may differ from Coulomb's by and be called nearly right, as a share."""

HOP = 0.01
"""From which clearance on a slide is called a hop [m]."""

RATIO_APART = 0.02
"""What the ratio of two impulses may differ from the coefficient of friction by."""

PUSHED = ("low_on_050", "high_on_050")
"""The slides with the engine's default model of friction."""

BLOW = 5.0
"""From how many times μ g dt on a loss of speed is more than friction under the weight takes."""

RULE_APART = 0.02
"""What the coefficient that a clean slide shows may differ from a rule's by."""


@dataclass(frozen=True, slots=True)
class Studies:
    """All runs of the lecture with their metrics, and the contacts' time constants by step [s]."""

    traces: Mapping[str, ContactTrace]
    metrics: Mapping[str, CaseMetrics]
    time_constants: Mapping[str, float]

    def landing(self, name: str) -> LandingMetrics:
        """Return the metrics of a run that lands."""
        found = self.metrics[name]
        if not isinstance(found, LandingMetrics):
            raise KeyError(f"{name} is no landing")
        return found

    def landings(self, step: str) -> list[LandingMetrics]:
        """Return the metrics of the landings at one solver step, by the height that they fall."""
        return [self.landing(name) for name in spec.STEP_CASES[step]]

    def slide(self, name: str) -> SlideMetrics:
        """Return the metrics of a run that slides."""
        found = self.metrics[name]
        if not isinstance(found, SlideMetrics):
            raise KeyError(f"{name} is no slide")
        return found


def solver_step(name: str) -> float:
    """Return the length of a studied solver step by its name [s]."""
    dt, substeps = spec.STEPS_STUDIED[name]
    return dt / substeps


def first_impulses(trace: ContactTrace, case: ContactCase) -> tuple[float, float]:
    """Return what the first outer step took from v_x and gave to v_z against gravity [m/s].

    Both are an impulse of the contact divided by the mass.
    """
    before, after = (trace.link_vel[k, 0].astype(np.float64) for k in (0, 1))
    return float(before[0] - after[0]), float(after[2] - before[2] + case.gravity * case.dt)


def apparent_friction(case: ContactCase, distance: float) -> float:
    """Return the coefficient that a stopping distance [m] shows, the steps' share added."""
    whole = distance + case.speed * case.h / 2
    return sliding.apparent_friction(case.speed, whole, case.gravity)


def distance_between(run: Studies, first: str, second: str) -> np.ndarray:
    """Return the distance of two runs' centres at each shared state, (n+1,) [m]."""
    one, other = (run.traces[n].link_pos[:, 0].astype(np.float64) for n in (first, second))
    every = round(run.traces[second].dt / run.traces[first].dt)
    shared = min(len(one[::every]), len(other))
    away = one[::every][:shared] - other[:shared]
    across = away - away[0]  # side by side is no distance
    return np.asarray(np.linalg.norm(across, axis=1))


def time_constants(run: Studies) -> list[str]:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    return [
        f"{name}: the engine has {run.time_constants[name]:g} s, expected "
        f"{mujoco_contacts.time_constant(solver_step(name)):g} s"
        for name in spec.STEPS_STUDIED
        if not abs(run.time_constants[name] - mujoco_contacts.time_constant(solver_step(name)))
        <= 1e-8
    ]


def records_each_step(run: Studies) -> list[str]:
    """With every solver step recorded, the baseline falls as it does with every second one."""
    fine, coarse = run.traces[spec.AS_BASELINE].link_pos, run.traces["baseline"].link_pos
    shared = fine[:: spec.BASELINE.substeps, 0, 2]
    far = float(np.abs(shared - coarse[: len(shared), 0, 2]).max())
    return [] if far <= spec.SAME_STATE else [f"they are up to {far:g} m apart"]


def rebound_goes(run: Studies) -> list[str]:
    """At the baseline's solver step cubes rebound; at all smaller ones studied, none does."""
    problems = []
    for name in spec.STEPS_STUDIED:
        high = [found.rebound for found in run.landings(name)]
        if solver_step(name) == spec.BASELINE.h and not max(high) > CLEAR:
            problems.append(f"{name}: the highest rebound is {max(high):g} m")
        if solver_step(name) < spec.BASELINE.h and max(high) > CLEAR:
            problems.append(f"{name}: one cube rebounds by {max(high):g} m")
    return problems


def scatter_shrinks(run: Studies) -> list[str]:
    """How much the depth depends on where a step meets the surface shrinks with every step."""
    names = sorted(spec.STEPS_STUDIED, key=solver_step)
    spread = {name: float(np.ptp([f.penetration for f in run.landings(name)])) for name in names}
    problems = [
        f"{fine} scatters by {spread[fine]:g} m, {coarse} by {spread[coarse]:g} m"
        for fine, coarse in itertools.pairwise(names)
        if not spread[fine] < spread[coarse]
    ]
    if not spread[names[0]] <= LEFT_OVER:
        problems.append(f"at the finest step {spread[names[0]]:g} m are left")
    return problems


def default_cone_hops(run: Studies) -> list[str]:
    """With the engine's default friction model, both pushed cubes leave the surface."""
    return [
        f"{name} is never higher than {run.slide(name).hop:g} m"
        for name in PUSHED
        if not run.slide(name).hop > HOP
    ]


def stops_nearly_right(run: Studies) -> list[str]:
    """And yet the cube of the surface's friction stops near v² / (2 μ g)."""
    name = PUSHED[0]
    case, found = spec.REPEATED[name], run.slide(name).stop_distance
    expected = sliding.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    if found is not None and abs(found - expected) <= NEARLY * expected:
        return []
    return [f"{name} stops at {found} m, Coulomb has {expected:g} m"]


def hop_is_paid_by_friction(run: Studies) -> list[str]:
    """The first step takes from v_x μ times what it gives to v_z, far more than by the weight."""
    problems = []
    for name in PUSHED:
        case = spec.REPEATED[name]
        lost, gained = first_impulses(run.traces[name], case)
        friction = max(case.friction, case.surface_friction)
        weight = friction * case.gravity * case.dt
        if not (lost > BLOW * weight and abs(lost - friction * gained) <= RATIO_APART * lost):
            problems.append(
                f"{name} loses {lost:g} m/s along x and is given {gained:g} m/s upwards"
            )
    return problems


def clean_slides_stay_down(run: Studies) -> list[str]:
    """With the elliptic cone as the engine has it, cubes slide on four corners at every sample."""
    problems = []
    for name in spec.CLEAN_SLIDES:
        corners = set(run.traces[name].contacts[:, 0].tolist())
        if not run.slide(name).hop <= CLEAR or corners != {4}:
            problems.append(f"{name} rises by {run.slide(name).hop:g} m, with {corners} contacts")
    return problems


def clean_slides_are_coulomb_s(run: Studies) -> list[str]:
    """There, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    problems = []
    for name, case in spec.CLEAN_SLIDES.items():
        friction = max(case.friction, case.surface_friction)
        expected = sliding.stepped_distance(case.speed, friction, case.h, case.gravity)
        found = run.slide(name).stop_distance
        if found is None or not abs(found - expected) <= STEPPED_APART:
            problems.append(f"{name} stops at {found} m, expected {expected:g} m")
    return problems


def larger_friction_rules(run: Studies) -> list[str]:
    """Clean slides show the larger of two coefficients, and no other rule's."""
    problems = []
    for name, case in spec.CLEAN_SLIDES.items():
        distance = run.slide(name).stop_distance
        if distance is None:
            problems.append(f"{name} does not stop")
            continue
        apparent = apparent_friction(case, distance)
        fits = [
            rule
            for rule, of in sliding.RULES.items()
            if abs(of(case.friction, case.surface_friction) - apparent) <= RULE_APART
        ]
        if fits != ["the larger"]:
            problems.append(f"{name} stops as with {apparent:.3f}, which fits {fits or 'no rule'}")
    return problems


def the_cone_alone_hops(run: Studies) -> list[str]:
    """The round cone alone, resolved as the pyramid is, hops: it is not the shape that ends it."""
    return [
        f"{name} is never higher than {run.slide(name).hop:g} m"
        for name in spec.CONVEX_SLIDES
        if not run.slide(name).hop > HOP
    ]


def engines_land_alike(run: Studies) -> list[str]:
    """With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."""
    problems = []
    for here, there in spec.ENGINE_PAIRS.items():
        if not isinstance(run.metrics[there], LandingMetrics):
            continue
        one, other = (run.traces[name].link_pos[:, 0, 2] for name in (here, there))
        shared = min(len(one), len(other))
        far = float(np.abs(one[:shared] - other[:shared]).max())
        if not far <= spec.ENGINES_APART:
            problems.append(f"{here} and {there} are up to {far:g} m apart")
    return problems


def engines_hop_alike(run: Studies) -> list[str]:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    problems = []
    for here, there in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[there], SlideMetrics):
            one, other = run.slide(here).hop, run.slide(there).hop
            if not abs(one - other) <= HOPS_APART:
                problems.append(f"{here} rises by {one:g} m, {there} by {other:g} m")
    return problems


STUDIED = (
    time_constants,
    records_each_step,
    rebound_goes,
    scatter_shrinks,
    default_cone_hops,
    stops_nearly_right,
    hop_is_paid_by_friction,
    clean_slides_stay_down,
    clean_slides_are_coulomb_s,
    larger_friction_rules,
    the_cone_alone_hops,
    engines_land_alike,
    engines_hop_alike,
)


def run_checks(run: Studies) -> tuple[Check, ...]:
    """Run the studies' checks."""
    return evaluate(STUDIED, run)
