"""Effects of the solver step, the friction model and the engine on landings and slides."""

import itertools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction, spec
from robo_genesis.lessons.l03.metrics import CLEAR, CaseMetrics, LandingMetrics, SlideMetrics
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase

GROUP = "time_constant"
"""Group of a bundle's metrics: the engine's time constant of a contact by solver step [s]."""

SCATTER_LEFT = 1e-3
"""Largest scatter of the depths at the finest step [m]: cubes from higher up are faster."""

HOP_TOLERANCE = 1e-4
"""Tolerance of a hop between two engines with equal settings [m]."""

STEPPED_TOLERANCE = 2e-4
"""Tolerance of a slide on four corners against the stepped formula [m]."""

NEARLY = 0.05
"""Relative tolerance of a stopping distance that counts as nearly Coulomb's."""

HOP = 0.01
"""Clearance from which a slide counts as a hop [m]."""

RATIO_TOLERANCE = 0.02
"""Relative tolerance of the ratio of two impulses against the coefficient of friction."""

PUSHED = ("low_on_050", "high_on_050")
"""The slides with the engine's default friction model."""

BLOW = 5.0
"""Loss of speed, in multiples of μ g dt, above which it is more than friction under the weight."""

RULE_TOLERANCE = 0.02
"""Tolerance of the coefficient that a clean slide shows against that of a rule."""


@dataclass(frozen=True, slots=True)
class Studies:
    """All runs of the lecture with their metrics, and the contacts' time constants by step [s]."""

    traces: Mapping[str, ContactTrace]
    metrics: Mapping[str, CaseMetrics]
    time_constants: Mapping[str, float]

    def landings(self, step: str) -> list[LandingMetrics]:
        """Return the metrics of the landings at one solver step, in the order of their heights."""
        found = [self.metrics[name] for name in spec.STEP_CASES[step]]
        return [of for of in found if isinstance(of, LandingMetrics)]

    def slide(self, name: str) -> SlideMetrics:
        """Return the metrics of a run that slides.

        Raises:
            KeyError: the run does not exist or is not a slide.
        """
        found = self.metrics[name]
        if not isinstance(found, SlideMetrics):
            raise KeyError(f"{name} is not a slide")
        return found


def solver_step(name: str) -> float:
    """Return the length of a studied solver step by its name [s]."""
    dt, substeps = spec.STEPS_STUDIED[name]
    return dt / substeps


def first_impulses(trace: ContactTrace, case: ContactCase) -> tuple[float, float]:
    """Return the loss of v_x and the gain of v_z against gravity in the first outer step [m/s].

    Both are an impulse of the contact divided by the mass.
    """
    before, after = (trace.link_vel[k, 0].astype(np.float64) for k in (0, 1))
    return float(before[0] - after[0]), float(after[2] - before[2] + case.gravity * case.dt)


def distance_between(run: Studies, first: str, second: str) -> FloatArray:
    """Return the distance between the centres of two runs at each shared state, (n+1,) [m].

    The distance of their starts is subtracted: some cubes lie side by side in one scene.
    """
    one, other = (run.traces[n].link_pos[:, 0].astype(np.float64) for n in (first, second))
    every = round(run.traces[second].dt / run.traces[first].dt)
    shared = min(len(one[::every]), len(other))
    difference = one[::every][:shared] - other[:shared]
    return np.asarray(np.linalg.norm(difference - difference[0], axis=1))


def time_constants(run: Studies) -> list[str]:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    expected = {
        name: mujoco_contacts.time_constant(solver_step(name)) for name in spec.STEPS_STUDIED
    }
    return [
        f"{name}: the engine has {run.time_constants[name]:g} s, expected {seconds:g} s"
        for name, seconds in expected.items()
        if not abs(run.time_constants[name] - seconds) <= 1e-8
    ]


def records_each_step(run: Studies) -> list[str]:
    """With every solver step recorded, the baseline falls as with every second one."""
    fine, coarse = run.traces[spec.AS_BASELINE].link_pos, run.traces["baseline"].link_pos
    shared = fine[:: spec.BASELINE.substeps, 0, 2]
    difference = float(np.abs(shared - coarse[: len(shared), 0, 2]).max())
    return [] if difference <= spec.SAME_STATE else [f"they are up to {difference:g} m apart"]


def rebound_goes(run: Studies) -> list[str]:
    """At the baseline's solver step cubes rebound; at all smaller steps studied, none does."""
    problems = []
    for name in spec.STEPS_STUDIED:
        highest = max(found.rebound for found in run.landings(name))
        if solver_step(name) == spec.BASELINE.h and not highest > CLEAR:
            problems.append(f"{name}: the highest rebound is {highest:g} m")
        if solver_step(name) < spec.BASELINE.h and highest > CLEAR:
            problems.append(f"{name}: one cube rebounds by {highest:g} m")
    return problems


def scatter_shrinks(run: Studies) -> list[str]:
    """The scatter of the depth over the heights of fall is smaller with every smaller step."""
    names = sorted(spec.STEPS_STUDIED, key=solver_step)
    scatter = {name: float(np.ptp([f.penetration for f in run.landings(name)])) for name in names}
    problems = [
        f"{fine} scatters by {scatter[fine]:g} m, {coarse} by {scatter[coarse]:g} m"
        for fine, coarse in itertools.pairwise(names)
        if not scatter[fine] < scatter[coarse]
    ]
    if not scatter[names[0]] <= SCATTER_LEFT:
        problems.append(f"at the finest step the scatter is {scatter[names[0]]:g} m")
    return problems


def without_hop(run: Studies, names: Iterable[str]) -> list[str]:
    """Return the slides that stay near the surface."""
    hops = {name: run.slide(name).hop for name in names}
    return [f"{name} rises by at most {hop:g} m" for name, hop in hops.items() if not hop > HOP]


def default_cone_hops(run: Studies) -> list[str]:
    """With the engine's default friction model, both pushed cubes leave the surface."""
    return without_hop(run, PUSHED)


def stops_nearly_right(run: Studies) -> list[str]:
    """The cube with the friction of the surface still stops near v² / (2 μ g)."""
    name = PUSHED[0]
    case, found = spec.REPEATED[name], run.slide(name).stop_distance
    expected = friction.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    if found is not None and abs(found - expected) <= NEARLY * expected:
        return []
    return [f"{name} stops at {found} m, expected {expected:g} m"]


def hop_is_paid_by_friction(run: Studies) -> list[str]:
    """The first step reduces v_x by μ times the gain of v_z, far more than under the weight."""
    problems = []
    for name in PUSHED:
        case = spec.REPEATED[name]
        lost, gained = first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        weight, error = mu * case.gravity * case.dt, abs(lost - mu * gained)
        if not (lost > BLOW * weight and error <= RATIO_TOLERANCE * lost):
            problems.append(f"{name} loses {lost:g} m/s along x and gains {gained:g} m/s upwards")
    return problems


def clean_slides_stay_down(run: Studies) -> list[str]:
    """With the engine's elliptic cone, cubes slide on four corners at every sample."""
    problems = []
    for name in spec.CLEAN_SLIDES:
        corners = set(run.traces[name].contacts[:, 0].tolist())
        if not run.slide(name).hop <= CLEAR or corners != {4}:
            problems.append(f"{name} rises by {run.slide(name).hop:g} m, with {corners} contacts")
    return problems


def clean_slides_are_coulomb_s(run: Studies) -> list[str]:
    """With the elliptic cone, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    problems = []
    for name, case in spec.CLEAN_SLIDES.items():
        mu = friction.pair_friction(case)
        expected = friction.stepped_distance(case.speed, mu, case.h, case.gravity)
        found = run.slide(name).stop_distance
        if found is None or not abs(found - expected) <= STEPPED_TOLERANCE:
            problems.append(f"{name} stops at {found} m, expected {expected:g} m")
    return problems


def larger_friction_rules(run: Studies) -> list[str]:
    """Clean slides show the larger of two coefficients, and fit no other rule."""
    problems = []
    for name, case in spec.CLEAN_SLIDES.items():
        distance = run.slide(name).stop_distance
        if distance is None:
            problems.append(f"{name} does not stop")
            continue
        continuous = distance + case.speed * case.h / 2
        apparent = friction.apparent_friction(case.speed, continuous, case.gravity)
        fits = [
            rule
            for rule, of in friction.RULES.items()
            if abs(of(case.friction, case.surface_friction) - apparent) <= RULE_TOLERANCE
        ]
        if fits != ["the larger"]:
            problems.append(f"{name} shows {apparent:.3f}, which fits {fits or 'no rule'}")
    return problems


def the_cone_alone_hops(run: Studies) -> list[str]:
    """With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."""
    return without_hop(run, spec.CONVEX_SLIDES)


def engines_land_alike(run: Studies) -> list[str]:
    """With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."""
    problems = []
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], LandingMetrics):
            pair = [run.traces[n].link_pos[:, 0, 2] for n in (name, other)]
            shared = min(map(len, pair))
            difference = float(np.abs(pair[0][:shared] - pair[1][:shared]).max())
            if not difference <= spec.ENGINES_APART:
                problems.append(f"{name} and {other} are up to {difference:g} m apart")
    return problems


def engines_hop_alike(run: Studies) -> list[str]:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    problems = []
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], SlideMetrics):
            first, second = run.slide(name).hop, run.slide(other).hop
            if not abs(first - second) <= HOP_TOLERANCE:
                problems.append(f"{name} rises by {first:g} m, {other} by {second:g} m")
    return problems


STUDIED: tuple[Callable[[Studies], list[str]], ...] = (
    time_constants, records_each_step, rebound_goes, scatter_shrinks, default_cone_hops,
    stops_nearly_right, hop_is_paid_by_friction, clean_slides_stay_down,
    clean_slides_are_coulomb_s, larger_friction_rules, the_cone_alone_hops, engines_land_alike,
    engines_hop_alike,
)  # fmt: skip


def run_checks(run: Studies) -> tuple[Check, ...]:
    """Run the checks of the studies."""
    return evaluate(STUDIED, run)
