"""Effects of the solver step, the friction model and the engine on landings and slides."""

import itertools
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import friction, spec
from robo_genesis.lessons.l03.metrics import CLEAR, LandingMetrics, SlideMetrics
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


def landings_at(metrics: Mapping[str, CaseMetrics], step: str) -> list[LandingMetrics]:
    """Return the metrics of the landings at one solver step, in the order of their heights."""
    found = [metrics[name] for name in spec.STEP_CASES[step]]
    return [of for of in found if isinstance(of, LandingMetrics)]


def slide(metrics: Mapping[str, CaseMetrics], name: str) -> SlideMetrics:
    """Return the metrics of a run that slides.

    Raises:
        KeyError: the run does not exist or is not a slide.
    """
    found = metrics[name]
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


def distance_between(traces: Mapping[str, ContactTrace], first: str, second: str) -> FloatArray:
    """Return the distance between the centres of two runs at each shared state, (n+1,) [m].

    The distance of their starts is subtracted: some cubes lie side by side in one scene.
    """
    one, other = (traces[n].link_pos[:, 0].astype(np.float64) for n in (first, second))
    every = round(traces[second].dt / traces[first].dt)
    shared = min(len(one[::every]), len(other))
    difference = one[::every][:shared] - other[:shared]
    return np.asarray(np.linalg.norm(difference - difference[0], axis=1))


def time_constants(run: Experiment) -> Iterator[str]:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    for name in spec.STEPS_STUDIED:
        found = run.readings[GROUP][name]
        expected = mujoco_contacts.time_constant(solver_step(name))
        if not abs(found - expected) <= 1e-8:
            yield f"{name}: the engine has {found:g} s, expected {expected:g} s"


def records_each_step(run: Experiment) -> Iterator[str]:
    """With every solver step recorded, the baseline falls as with every second one."""
    fine, coarse = run.traces[spec.AS_BASELINE].link_pos, run.traces["baseline"].link_pos
    shared = fine[:: spec.BASELINE.substeps, 0, 2]
    difference = float(np.abs(shared - coarse[: len(shared), 0, 2]).max())
    if not difference <= spec.SAME_STATE:
        yield f"they are up to {difference:g} m apart"


def rebound_goes(run: Experiment) -> Iterator[str]:
    """At the baseline's solver step cubes rebound; at all smaller steps studied, none does."""
    for name in spec.STEPS_STUDIED:
        highest = max(found.rebound for found in landings_at(run.metrics, name))
        if solver_step(name) == spec.BASELINE.h and not highest > CLEAR:
            yield f"{name}: the highest rebound is {highest:g} m"
        if solver_step(name) < spec.BASELINE.h and highest > CLEAR:
            yield f"{name}: one cube rebounds by {highest:g} m"


def scatter_shrinks(run: Experiment) -> Iterator[str]:
    """The scatter of the depth over the heights of fall is smaller with every smaller step."""
    names = sorted(spec.STEPS_STUDIED, key=solver_step)
    depths = {name: [of.penetration for of in landings_at(run.metrics, name)] for name in names}
    scatter = {name: float(np.ptp(of)) for name, of in depths.items()}
    for fine, coarse in itertools.pairwise(names):
        if not scatter[fine] < scatter[coarse]:
            yield f"{fine} scatters by {scatter[fine]:g} m, {coarse} by {scatter[coarse]:g} m"
    if not scatter[names[0]] <= SCATTER_LEFT:
        yield f"at the finest step the scatter is {scatter[names[0]]:g} m"


def without_hop(run: Experiment, names: Iterable[str]) -> Iterator[str]:
    """Yield the slides that stay near the surface."""
    for name in names:
        hop = slide(run.metrics, name).hop
        if not hop > HOP:
            yield f"{name} rises by at most {hop:g} m"


def default_cone_hops(run: Experiment) -> Iterator[str]:
    """With the engine's default friction model, both pushed cubes leave the surface."""
    return without_hop(run, PUSHED)


def stops_nearly_right(run: Experiment) -> Iterator[str]:
    """The cube with the friction of the surface still stops near v² / (2 μ g)."""
    name = PUSHED[0]
    case, found = spec.REPEATED[name], slide(run.metrics, name).stop_distance
    expected = friction.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    if found is None or not abs(found - expected) <= NEARLY * expected:
        yield f"{name} stops at {found} m, expected {expected:g} m"


def hop_is_paid_by_friction(run: Experiment) -> Iterator[str]:
    """The first step reduces v_x by μ times the gain of v_z, far more than under the weight."""
    for name in PUSHED:
        case = spec.REPEATED[name]
        lost, gained = first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        weight, error = mu * case.gravity * case.dt, abs(lost - mu * gained)
        if not (lost > BLOW * weight and error <= RATIO_TOLERANCE * lost):
            yield f"{name} loses {lost:g} m/s along x and gains {gained:g} m/s upwards"


def clean_slides_stay_down(run: Experiment) -> Iterator[str]:
    """With the engine's elliptic cone, cubes slide on four corners at every sample."""
    for name in spec.CLEAN_SLIDES:
        corners = set(run.traces[name].contacts[:, 0].tolist())
        if not slide(run.metrics, name).hop <= CLEAR or corners != {4}:
            yield f"{name} rises by {slide(run.metrics, name).hop:g} m, with {corners} contacts"


def clean_slides_are_coulomb_s(run: Experiment) -> Iterator[str]:
    """With the elliptic cone, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    for name, case in spec.CLEAN_SLIDES.items():
        mu = friction.pair_friction(case)
        expected = friction.stepped_distance(case.speed, mu, case.h, case.gravity)
        found = slide(run.metrics, name).stop_distance
        if found is None or not abs(found - expected) <= STEPPED_TOLERANCE:
            yield f"{name} stops at {found} m, expected {expected:g} m"


def larger_friction_rules(run: Experiment) -> Iterator[str]:
    """Clean slides show the larger of two coefficients, and fit no other rule."""
    for name, case in spec.CLEAN_SLIDES.items():
        distance = slide(run.metrics, name).stop_distance
        if distance is None:
            yield f"{name} does not stop"
            continue
        continuous = distance + case.speed * case.h / 2
        apparent = friction.apparent_friction(case.speed, continuous, case.gravity)
        fits = [
            rule
            for rule, of in friction.RULES.items()
            if abs(of(case.friction, case.surface_friction) - apparent) <= RULE_TOLERANCE
        ]
        if fits != ["the larger"]:
            yield f"{name} shows {apparent:.3f}, which fits {fits or 'no rule'}"


def the_cone_alone_hops(run: Experiment) -> Iterator[str]:
    """With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."""
    return without_hop(run, spec.CONVEX_SLIDES)


def engines_land_alike(run: Experiment) -> Iterator[str]:
    """With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."""
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], LandingMetrics):
            pair = [run.traces[n].link_pos[:, 0, 2] for n in (name, other)]
            shared = min(map(len, pair))
            difference = float(np.abs(pair[0][:shared] - pair[1][:shared]).max())
            if not difference <= spec.ENGINES_APART:
                yield f"{name} and {other} are up to {difference:g} m apart"


def engines_hop_alike(run: Experiment) -> Iterator[str]:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], SlideMetrics):
            first, second = slide(run.metrics, name).hop, slide(run.metrics, other).hop
            if not abs(first - second) <= HOP_TOLERANCE:
                yield f"{name} rises by {first:g} m, {other} by {second:g} m"


CHECKS = (
    time_constants, records_each_step, rebound_goes, scatter_shrinks, default_cone_hops,
    stops_nearly_right, hop_is_paid_by_friction, clean_slides_stay_down,
    clean_slides_are_coulomb_s, larger_friction_rules, the_cone_alone_hops, engines_land_alike,
    engines_hop_alike,
)  # fmt: skip
