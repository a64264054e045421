"""Studies of the deeper page about contact: cones, steps, and a second engine."""

from collections.abc import Iterator, Mapping

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, noted, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction, spec, study, study_spec
from robo_genesis.lessons.l03.metrics import LandingMetrics, SlideMetrics
from robo_genesis.lessons.l03.study import slide
from robo_genesis.sim.bodies.contacts import ContactCase

LANES = {"low": "low_on_050", "high": "high_on_050"}


def distance_between(traces: Mapping[str, ContactTrace], first: str, second: str) -> FloatArray:
    """Return the distance between the centres of two runs at each shared state, (n+1,) [m].

    The distance of their starts is subtracted: some cubes lie side by side in one scene.
    """
    one, other = (traces[n].link_pos[:, 0].astype(np.float64) for n in (first, second))
    every = round(traces[second].dt / traces[first].dt)
    shared = min(len(one[::every]), len(other))
    difference = one[::every][:shared] - other[:shared]
    return np.asarray(np.linalg.norm(difference - difference[0], axis=1))


def runs_of_lane(lane: str) -> dict[str, ContactCase]:
    """Return the pushes of one cube with the default cone by name, the coarsest step first."""
    finer = {f"{step}_{lane}": of[f"{step}_{lane}"] for step, of in study_spec.STOP_CASES.items()}
    return {LANES[lane]: spec.SLIDES[LANES[lane]], **finer}


def stops_of_lane(run: Experiment, lane: str) -> dict[str, float | None]:
    """Return the stopping distance of each of these runs [m]."""
    return {name: slide(run.metrics, name).stop_distance for name in runs_of_lane(lane)}


def stops_nearly_right(run: Experiment) -> Iterator[Finding]:
    """The cube with the friction of the surface still stops near v² / (2 μ g)."""
    name = LANES["low"]
    case, found = run.cases[name], slide(run.metrics, name).stop_distance
    expected = friction.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    yield within(f"{name}.stop_distance_m", found, expected, study_spec.NEARLY * expected)


def hop_is_paid_by_friction(run: Experiment) -> Iterator[Finding]:
    """The first step reduces v_x by μ times the gain of v_z, far more than under the weight."""
    for name in study_spec.HOPPED:
        case = run.cases[name]
        lost, gained = study.first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        yield above(f"{name}.lost_m_s", lost, study_spec.BLOW * mu * case.gravity * case.dt)
        allowed = study_spec.RATIO_TOLERANCE * lost
        yield within(f"{name}.mu_times_gained_m_s", mu * gained, lost, allowed)


def the_cone_alone_hops(run: Experiment) -> Iterator[Finding]:
    """With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."""
    return study.hops(run, study_spec.CONVEX_SLIDES)


def half_the_step_contradicts(run: Experiment) -> Iterator[Finding]:
    """The stopping distance of the cube with the higher coefficient changes by more than 5 % of
    Coulomb's when the solver step of 5 ms is halved.
    """
    found = stops_of_lane(run, "high")
    for name, distance in found.items():
        stopped = distance is not None
        yield Finding(f"{name}.stop_distance_m", distance, stopped, "a distance")
    coarse, half = (found[name] or 0.0 for name in (LANES["high"], study_spec.HALF_THE_STEP))
    case = run.cases[LANES["high"]]
    expected = friction.coulomb_distance(case.speed, case.friction, case.gravity)
    change = abs(half - coarse) / expected
    yield above("change_at_half_the_step_share", change, study_spec.UNSETTLED)


def engines_land_alike(run: Experiment) -> Iterator[Finding]:
    """With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."""
    for name, other in study_spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], LandingMetrics):
            pair = [run.traces[n].link_pos[:, 0, 2] for n in (name, other)]
            shared = min(map(len, pair))
            difference = float(np.abs(pair[0][:shared] - pair[1][:shared]).max())
            label = f"{name}.distance_to_{other}_m"
            yield at_most(label, difference, study_spec.ENGINES_APART)


def engines_hop_alike(run: Experiment) -> Iterator[Finding]:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    for name, other in study_spec.ENGINE_PAIRS.items():
        if isinstance(run.metrics[other], SlideMetrics):
            first, second = slide(run.metrics, name).hop, slide(run.metrics, other).hop
            yield within(f"{name}.hop_m", first, second, study_spec.SAME_HOP)
            yield noted(f"{other}.hop_m", second)


CHECKS = (
    study.default_cone_hops, stops_nearly_right, hop_is_paid_by_friction,
    study.clean_slides_stay_down, study.clean_slides_are_coulomb_s, study.larger_friction_rules,
    the_cone_alone_hops, half_the_step_contradicts, engines_land_alike, engines_hop_alike,
)  # fmt: skip
