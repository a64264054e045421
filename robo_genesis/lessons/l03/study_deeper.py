"""Studies of the deeper pages: cones, steps and a second engine; the release of a landing."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, nearly, noted, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import checks, study, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR, SlideMetrics, aligned

LANES = {"low": "low_on_050", "high": "high_on_050"}
"""By cube, its push at the coarsest step."""


def first_impulses(run: Experiment, name: str) -> tuple[float, float]:
    """Return the loss of v_x and the gain of v_z against gravity in the first outer step [m/s].

    Both are an impulse of the contact divided by the mass.
    """
    case, velocity = run.cases[name], run.traces[name].link_vel[:2, 0].astype(np.float64)
    before, after = velocity
    return float(before[0] - after[0]), float(after[2] - before[2] + case.gravity * case.dt)


def distance_between(first: ContactTrace, second: ContactTrace) -> FloatArray:
    """Return the distance between the centres of two runs at each shared state, (n+1,) [m].

    The distance of their starts is subtracted: some cubes lie side by side in one scene.
    """
    difference = np.subtract(*aligned(first, second, "link_pos"), dtype=np.float64)
    return np.asarray(np.linalg.norm(difference - difference[0], axis=1))


def stops_of_lane(run: Experiment, lane: str) -> dict[str, float | None]:
    """Return the stopping distances of a cube with the default cone by run, coarsest first [m]."""
    names = [LANES[lane], *(f"{step}_{lane}" for step in study_spec.STOP_CASES)]
    return {name: run.metrics[name].stop_distance for name in names}


def stops_nearly_right(run: Experiment) -> Iterator[Finding]:
    """The cube with the friction of the surface still stops near v² / (2 μ g)."""
    name = LANES["low"]
    found, expected = run.metrics[name].stop_distance, theory.coulomb_distance(run.cases[name])
    yield nearly(f"{name}.stop_distance_m", found, expected, study_spec.NEARLY)


def hop_is_paid_by_friction(run: Experiment) -> Iterator[Finding]:
    """The first step reduces v_x by μ times the gain of v_z, far more than under the weight."""
    for name in study_spec.HOPPED:
        case, (lost, gained) = run.cases[name], first_impulses(run, name)
        mu = theory.pair_friction(case)
        yield above(f"{name}.lost_m_s", lost, study_spec.BLOW * mu * case.gravity * case.dt)
        label = f"{name}.mu_times_gained_m_s"
        yield nearly(label, mu * gained, lost, study_spec.RATIO_TOLERANCE)


def the_cone_alone_hops(run: Experiment) -> Iterator[Finding]:
    """With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."""
    for name in study_spec.CONVEX_SLIDES:
        yield above(f"{name}.hop_m", run.metrics[name].hop, study_spec.HOP)


def half_the_step_contradicts(run: Experiment) -> Iterator[Finding]:
    """The stopping distance of the cube with the higher coefficient changes by more than 5 % of
    Coulomb's when the solver step of 5 ms is halved.
    """
    found = stops_of_lane(run, "high")
    for name, distance in found.items():
        stopped = distance is not None
        yield Finding(f"{name}.stop_distance_m", distance, stopped, "a distance")
    coarse, half = (found[name] or 0.0 for name in (LANES["high"], study_spec.HALF_THE_STEP))
    change = abs(half - coarse) / theory.coulomb_distance(run.cases[LANES["high"]])
    yield above("change_at_half_the_step_share", change, study_spec.UNSETTLED)


def one_stop_converges(run: Experiment) -> Iterator[Finding]:
    """Over the steps of at most T / 10 the stopping distance of the cube with the low coefficient
    changes by at most 5 % of Coulomb's.
    """
    for lane in LANES:
        fine = [found or np.nan for found in stops_of_lane(run, lane).values()]
        spread = float(np.ptp(fine[-study_spec.FINEST :]))
        share = spread / theory.coulomb_distance(run.cases[LANES[lane]])
        label = f"{lane}.spread_share"
        yield at_most(label, share, study_spec.UNSETTLED) if lane == "low" else noted(label, share)


def engines_land_alike(run: Experiment) -> Iterator[Finding]:
    """With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."""
    for name, other in study_spec.ENGINE_PAIRS.items():
        if name not in checks.measured(run, SlideMetrics):
            one, two = aligned(run.traces[name], run.traces[other], "link_pos")
            difference = float(np.abs(one - two)[:, 2].max())
            label = f"{name}.distance_to_{other}_m"
            yield at_most(label, difference, study_spec.ENGINES_APART)


def engines_hop_alike(run: Experiment) -> Iterator[Finding]:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    for name, other in study_spec.ENGINE_PAIRS.items():
        if name in checks.measured(run, SlideMetrics):
            first, second = run.metrics[name].hop, run.metrics[other].hop
            yield within(f"{name}.hop_m", first, second, study_spec.SAME_HOP)
            yield noted(f"{other}.hop_m", second)


OF_CONTACT = (
    study.default_cone_hops, stops_nearly_right, hop_is_paid_by_friction,
    study.clean_slides_stay_down, study.clean_slides_are_coulomb_s, study.larger_friction_rules,
    the_cone_alone_hops, half_the_step_contradicts, one_stop_converges, engines_land_alike,
    engines_hop_alike,
)  # fmt: skip


def release_speed(run: Experiment) -> Iterator[Finding]:
    """With fine steps and time constants of 10, 5 and 2 ms, a contact releases a cube at e⁻² of its
    impact speed, within 10 %.
    """
    for scene in study_spec.RELEASE_CASES:
        for name, case, found in study.row(run, scene):
            expected, label = theory.release_speed(case), f"{name}.upward_speed_m_s"
            yield nearly(label, found.upward_speed, expected, study_spec.RELEASE_SHARE)


def stiff_contacts_rebound(run: Experiment) -> Iterator[Finding]:
    """With 10 ms no cube rebounds; with 5 ms and 2 ms each rebounds as from a linear contact,
    within 25 %.
    """
    for scene in study_spec.RELEASE_CASES:
        for name, case, found in study.row(run, scene):
            expected, label = theory.rebound(case), f"{name}.rebound_m"
            as_linear = nearly(label, found.rebound, expected, study_spec.REBOUND_SHARE)
            yield as_linear if expected else at_most(label, found.rebound, CLEAR)


OF_ENERGY = (
    study.time_constants, release_speed, stiff_contacts_rebound, checks.level_in_flight,
    checks.energy_converges,
)  # fmt: skip
