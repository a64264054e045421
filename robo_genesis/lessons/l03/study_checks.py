"""Named checks of L03's lecture and deeper pages: landings, clean slides, hops, second engine."""

import numpy as np

from robo_genesis.core.checks import (
    Finding,
    Findings,
    above,
    at_most,
    below,
    equal,
    nearly,
    noted,
    within,
)
from robo_genesis.core.experiment import Experiment

from . import checks, spec, study, study_spec, theory
from .metrics import CLEAR, SlideMetrics, aligned

# Landings


def time_constants(run: Experiment) -> Findings:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    for name, found in run.readings[study.GROUP].items():
        expected = theory.contact_seconds(study.case_of(name))
        yield within(
            f"{name}.time_constant_s", found, expected, study_spec.TIME_CONSTANT
        )


def rebound_goes(run: Experiment) -> Findings:
    """With the default time constant, all cubes rebound at the baseline's solver step;
    at all smaller steps studied, none does from any of the nine heights.
    """
    for name in study_spec.STEP_CASES:
        rebounds = [found.rebound for *_, found in study.row(run, name)]
        step = study.case_of(name).h
        limit = CLEAR if step < spec.BASELINE.h else np.inf
        yield at_most(f"{name}.highest_rebound_m", max(rebounds), limit)
        if step == spec.BASELINE.h:
            yield above(f"{name}.lowest_rebound_m", min(rebounds), CLEAR)


def scatter_shrinks(run: Experiment) -> Findings:
    """Depths as shares of v T / e scatter widely at h = T / 2, and less at every smaller step."""
    limit = np.inf
    for name in sorted(study_spec.STEP_CASES, key=study.share_of_step, reverse=True):
        depths = study.row(run, name)
        shares = [found.penetration / theory.depth(case) for _, case, found in depths]
        scatter, label = np.ptp(shares), f"{name}.scatter_of_depth_share"
        coarse = above(label, scatter, study_spec.SCATTER_COARSE)
        yield (
            coarse if study.share_of_step(name) >= 0.5 else below(label, scatter, limit)
        )
        limit = min(limit, scatter)
        yield noted(f"{name}.smallest_depth_share", min(shares))
    yield at_most("scatter_left", limit, study_spec.SCATTER_FINE)


def first_step_decides(run: Experiment) -> Findings:
    """With solver steps of 5 ms and 10 ms, half the time constant in force, the first
    sample in the table is the deepest of each landing: its depth follows from the fall
    alone.
    """
    for name, case, found in study.row(run, "h_5000us", "h_10000us"):
        depth = theory.first_depth(case)
        yield within(
            f"{name}.depth_m", found.penetration, depth, study_spec.FIRST_DEPTH
        )


def depth_by_hand(run: Experiment) -> Findings:
    """With fine steps, each cube sinks in by v T / e: within 10 % for a time constant
    of 10 ms, and within 20 % for 2 ms.
    """
    for scene, share in study_spec.DEPTH_SHARES.items():
        for name, case, found in study.row(run, scene):
            depth_share = found.penetration / theory.depth(case)
            yield within(f"{name}.depth_share", depth_share, 1.0, share)


def release_speed(run: Experiment) -> Findings:
    """With fine steps and time constants of 10, 5 and 2 ms, a contact releases a cube
    at e⁻² of its impact speed, within 10 %.
    """
    for name, case, found in study.row(run, *study_spec.RELEASE_CASES):
        expected, label = theory.release_speed(case), f"{name}.upward_speed_m_s"
        yield nearly(label, found.upward_speed, expected, study_spec.RELEASE_SHARE)


def stiff_contacts_rebound(run: Experiment) -> Findings:
    """With 10 ms no cube rebounds; with 5 ms and 2 ms each rebounds as from a linear
    contact, within 25 %.
    """
    for name, case, found in study.row(run, *study_spec.RELEASE_CASES):
        expected, label = theory.rebound(case), f"{name}.rebound_m"
        as_linear = nearly(label, found.rebound, expected, study_spec.REBOUND_SHARE)
        yield as_linear if expected else at_most(label, found.rebound, CLEAR)


# Slides with the elliptic cone


def clean_slides_stay_down(run: Experiment) -> Findings:
    """With the engine's elliptic cone, cubes slide on four corners at every sample."""
    for name, _, found in study.clean(run):
        yield at_most(f"{name}.hop_m", found.hop, CLEAR)
        contacts = run.traces[name].contacts[:, 0]
        yield equal(f"{name}.fewest_contacts", contacts.min(), 4)
        yield equal(f"{name}.most_contacts", contacts.max(), 4)


def clean_slides_are_coulomb_s(run: Experiment) -> Findings:
    """With the elliptic cone, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    for name, case, found in study.clean(run):
        expected, label = theory.stepped_distance(case), f"{name}.stop_distance_m"
        tolerance = study_spec.STEPPED_TOLERANCE
        yield within(label, found.stop_distance, expected, tolerance)


def clean_slides_order(run: Experiment) -> Findings:
    """With less friction a cube with the elliptic cone travels farther; the smaller
    coefficient changes nothing.
    """
    return checks.orders_of_distances(run, "_elliptic")


def larger_friction_rules(run: Experiment) -> Findings:
    """Clean slides show the larger of two coefficients, and fit no other rule."""
    for name, case, found in study.clean(run):
        distance = (found.stop_distance or np.nan) + case.speed * case.h / 2
        apparent = theory.apparent_friction(case, distance)
        for rule, combined in theory.RULES.items():
            error = abs(combined(case.friction, case.surface_friction) - apparent)
            label, tolerance = f"{name}.error_of_{rule}", study_spec.RULE_TOLERANCE
            fits = at_most(label, error, tolerance)
            yield fits if rule == "the larger" else above(label, error, tolerance)


# Pushes with the default cone


def default_cone_hops(run: Experiment) -> Findings:
    """With the engine's default friction model, both cubes that are pushed to 2 m/s hop."""
    for name, case in study_spec.HOPPED.items():
        top = float(run.traces[name].link_pos[:, 0, 2].max())
        yield noted(f"{name}.rise_m", top - case.rest_height)
        yield above(f"{name}.hop_m", run.metrics[name].hop, study_spec.HOP)


def by_formula(run: Experiment, name: str) -> Finding:
    """Require the hop of one solver step, within 25 %."""
    hop, expected = run.metrics[name].hop, theory.hop(run.cases[name])
    return nearly(f"{name}.hop_m", hop, expected, study_spec.HOP_SHARE)


def hop_follows_step(run: Experiment) -> Findings:
    """Each cube begins with its speed. From 10 ms to 2 ms the hop is that of the formula
    for one step, within 25 %; at smaller steps at most 15 % of the hop at 5 ms is left.
    """
    for step, cases in study_spec.HOP_STEP_CASES.items():
        for name, case in cases.items():
            speed = run.traces[name].link_vel[0, 0, 0]
            yield equal(f"{name}.start_speed_m_s", speed, case.speed)
            hop = run.metrics[name.replace(step, "hop_5000us")].hop
            left = study_spec.HOP_LEFT * hop
            fine = at_most(f"{name}.hop_m", run.metrics[name].hop, left)
            yield by_formula(run, name) if step in study_spec.HOP_APPLIES else fine


def hop_follows_speed(run: Experiment) -> Findings:
    """At a step of 5 ms the hop grows with the speed, and is below 1 mm up to 0.2 m/s."""
    previous = 0.0
    for name, case in study_spec.HOP_SPEED_CASES.items():
        found = run.metrics[name].hop
        slow = at_most(f"{name}.hop_m", found, study_spec.INVISIBLE)
        yield slow if case.speed <= study_spec.SLOW else by_formula(run, name)
        yield above(f"{name}.higher_than_slower_m", found - previous, 0.0)
        previous = found


def stops_nearly_right(run: Experiment) -> Findings:
    """The cube with the friction of the surface still stops near v² / (2 μ g)."""
    name = study.LANES["low"]
    expected = theory.coulomb_distance(run.cases[name])
    found, label = run.metrics[name].stop_distance, f"{name}.stop_distance_m"
    yield nearly(label, found, expected, study_spec.NEARLY)


def hop_is_paid_by_friction(run: Experiment) -> Findings:
    """The first step reduces v_x by μ times the gain of v_z, far more than under the weight."""
    for name in study_spec.HOPPED:
        case, (lost, gained) = run.cases[name], study.first_impulses(run, name)
        mu = theory.pair_friction(case)
        under_weight = mu * case.gravity * case.dt
        yield above(f"{name}.lost_m_s", lost, study_spec.BLOW * under_weight)
        label = f"{name}.mu_times_gained_m_s"
        yield nearly(label, mu * gained, lost, study_spec.RATIO_TOLERANCE)


def the_cone_alone_hops(run: Experiment) -> Findings:
    """With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."""
    for name in study_spec.CONVEX_SLIDES:
        yield above(f"{name}.hop_m", run.metrics[name].hop, study_spec.HOP)


def finer_steps_contradict(run: Experiment) -> Findings:
    """At one of the finer solver steps the stopping distance of the cube with the higher
    coefficient differs from that at 5 ms by more than 5 % of Coulomb's.
    """
    found = study.stops_of_lane(run, "high")
    for name, distance in found.items():
        yield above(f"{name}.stop_distance_m", distance, 0)
    stops = np.array([*found.values()], dtype=float)
    share = np.abs(stops - stops[0]) / theory.coulomb_distance(
        run.cases[study.LANES["high"]]
    )
    yield above("largest_change_share", share.max(), study_spec.UNSETTLED)


def one_stop_converges(run: Experiment) -> Findings:
    """Over the steps of at most T / 10 the stopping distance of the cube with the low
    coefficient changes by at most 5 % of Coulomb's.
    """
    for lane, coarsest in study.LANES.items():
        fine = [found or np.nan for found in study.stops_of_lane(run, lane).values()]
        spread = np.ptp(fine[-study_spec.FINEST :])
        share = spread / theory.coulomb_distance(run.cases[coarsest])
        limit = study_spec.UNSETTLED if lane == "low" else np.inf
        yield at_most(f"{lane}.spread_share", share, limit)


# The second engine


def engines_land_alike(run: Experiment) -> Findings:
    """With equal settings, cubes land in MuJoCo as in the engine: place and orientation
    agree at every shared sample.
    """
    for name, other in study_spec.ENGINE_PAIRS.items():
        if name not in checks.measured(run, SlideMetrics):
            for array in ("link_pos", "link_quat"):
                one, two = aligned(run.traces[name], run.traces[other], array)
                apart, label = np.abs(one - two).max(), f"{name}.{array}_in_{other}"
                yield at_most(label, apart, study_spec.ENGINES_APART)


def engines_hop_alike(run: Experiment) -> Findings:
    """With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."""
    for name, other in study_spec.ENGINE_PAIRS.items():
        if name in checks.measured(run, SlideMetrics):
            first, second = run.metrics[name].hop, run.metrics[other].hop
            yield within(f"{name}.hop_m", first, second, study_spec.SAME_HOP)


LECTURE = (
    time_constants,
    rebound_goes,
    scatter_shrinks,
    first_step_decides,
    depth_by_hand,
    clean_slides_stay_down,
    clean_slides_are_coulomb_s,
    clean_slides_order,
    larger_friction_rules,
    default_cone_hops,
    hop_follows_step,
    hop_follows_speed,
)
CONTACT = (
    default_cone_hops,
    stops_nearly_right,
    hop_is_paid_by_friction,
    clean_slides_stay_down,
    clean_slides_are_coulomb_s,
    larger_friction_rules,
    the_cone_alone_hops,
    finer_steps_contradict,
    one_stop_converges,
    engines_land_alike,
    engines_hop_alike,
)
ENERGY = (
    time_constants,
    release_speed,
    stiff_contacts_rebound,
    checks.level_in_flight,
    checks.energy_converges,
)
