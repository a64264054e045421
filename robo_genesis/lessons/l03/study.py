"""Effects of the solver step, the friction model and the engine on landings and slides."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, below, equal, noted, within
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

PUSHED = ("low_on_050", "high_on_050")
"""The slides with the engine's default friction model."""


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


def time_constants(run: Experiment) -> Iterator[Finding]:
    for name in spec.STEPS_STUDIED:
        found = run.readings[GROUP][name]
        expected = mujoco_contacts.time_constant(solver_step(name))
        yield within(f"{name}.time_constant_s", found, expected, spec.TIME_CONSTANT)


def records_each_step(run: Experiment) -> Iterator[Finding]:
    fine, coarse = run.traces[spec.AS_BASELINE].link_pos, run.traces["baseline"].link_pos
    shared = fine[:: spec.BASELINE.substeps, 0, 2]
    difference = float(np.abs(shared - coarse[: len(shared), 0, 2]).max())
    yield at_most(f"{spec.AS_BASELINE}.distance_to_baseline_m", difference, spec.SAME_STATE)


def rebound_goes(run: Experiment) -> Iterator[Finding]:
    for name in spec.STEPS_STUDIED:
        highest = max(found.rebound for found in landings_at(run.metrics, name))
        label, step = f"{name}.highest_rebound_m", solver_step(name)
        if step > spec.BASELINE.h:
            yield noted(label, highest)
        elif step == spec.BASELINE.h:
            yield above(label, highest, CLEAR)
        else:
            yield at_most(label, highest, CLEAR)


def scatter_shrinks(run: Experiment) -> Iterator[Finding]:
    limit, finest = np.inf, min(spec.STEPS_STUDIED, key=solver_step)
    for name in sorted(spec.STEPS_STUDIED, key=solver_step, reverse=True):
        scatter = float(np.ptp([of.penetration for of in landings_at(run.metrics, name)]))
        yield below(f"{name}.scatter_m", scatter, limit)
        limit = scatter
    yield at_most(f"{finest}.scatter_left_m", limit, spec.SCATTER_LEFT)


def hops(run: Experiment, names: Iterable[str]) -> Iterator[Finding]:
    """Require slides that leave the surface."""
    for name in names:
        yield above(f"{name}.hop_m", slide(run.metrics, name).hop, spec.HOP)


def default_cone_hops(run: Experiment) -> Iterator[Finding]:
    return hops(run, PUSHED)


def stops_nearly_right(run: Experiment) -> Iterator[Finding]:
    name = PUSHED[0]
    case, found = spec.REPEATED[name], slide(run.metrics, name).stop_distance
    expected = friction.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    yield within(f"{name}.stop_distance_m", found, expected, spec.NEARLY * expected)


def hop_is_paid_by_friction(run: Experiment) -> Iterator[Finding]:
    for name in PUSHED:
        case = spec.REPEATED[name]
        lost, gained = first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        yield above(f"{name}.lost_m_s", lost, spec.BLOW * mu * case.gravity * case.dt)
        yield within(f"{name}.mu_times_gained_m_s", mu * gained, lost, spec.RATIO_TOLERANCE * lost)


def clean_slides_stay_down(run: Experiment) -> Iterator[Finding]:
    for name in spec.CLEAN_SLIDES:
        yield at_most(f"{name}.hop_m", slide(run.metrics, name).hop, CLEAR)
        contacts = run.traces[name].contacts[:, 0]
        yield equal(f"{name}.fewest_contacts", contacts.min(), 4)
        yield equal(f"{name}.most_contacts", contacts.max(), 4)


def clean_slides_are_coulomb_s(run: Experiment) -> Iterator[Finding]:
    for name, case in spec.CLEAN_SLIDES.items():
        mu = friction.pair_friction(case)
        expected = friction.stepped_distance(case.speed, mu, case.h, case.gravity)
        found = slide(run.metrics, name).stop_distance
        yield within(f"{name}.stop_distance_m", found, expected, spec.STEPPED_TOLERANCE)


def larger_friction_rules(run: Experiment) -> Iterator[Finding]:
    for name, case in spec.CLEAN_SLIDES.items():
        label, distance = f"{name}.friction", slide(run.metrics, name).stop_distance
        if distance is None:
            yield Finding(label, None, False, "a coefficient")
            continue
        continuous = distance + case.speed * case.h / 2
        apparent = friction.apparent_friction(case.speed, continuous, case.gravity)
        fits = [
            rule
            for rule, of in friction.RULES.items()
            if abs(of(case.friction, case.surface_friction) - apparent) <= spec.RULE_TOLERANCE
        ]
        expected = f"the larger of {case.friction:g} and {case.surface_friction:g}"
        expected += f" and no other rule; it fits {' and '.join(fits) or 'none'}"
        yield Finding(label, apparent, fits == ["the larger"], expected)


def the_cone_alone_hops(run: Experiment) -> Iterator[Finding]:
    return hops(run, spec.CONVEX_SLIDES)


def engines_land_alike(run: Experiment) -> Iterator[Finding]:
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], LandingMetrics):
            pair = [run.traces[n].link_pos[:, 0, 2] for n in (name, other)]
            shared = min(map(len, pair))
            difference = float(np.abs(pair[0][:shared] - pair[1][:shared]).max())
            yield at_most(f"{name}.distance_to_{other}_m", difference, spec.ENGINES_APART)


def engines_hop_alike(run: Experiment) -> Iterator[Finding]:
    for name, other in spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], SlideMetrics):
            first, second = slide(run.metrics, name).hop, slide(run.metrics, other).hop
            yield within(f"{name}.hop_m", first, second, spec.SAME_HOP)
            yield noted(f"{other}.hop_m", second)


CHECKS = (
    time_constants, records_each_step, rebound_goes, scatter_shrinks, default_cone_hops,
    stops_nearly_right, hop_is_paid_by_friction, clean_slides_stay_down,
    clean_slides_are_coulomb_s, larger_friction_rules, the_cone_alone_hops, engines_land_alike,
    engines_hop_alike,
)  # fmt: skip
