"""Studies of the lecture: landings by step and time constant, clean slides, hops."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, below, equal, nearly, noted, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l03 import checks, spec, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR, LandingMetrics, aligned
from robo_genesis.sim.bodies.contacts import ContactCase

GROUP = "time_constant"
"""Group of a bundle's metrics: the engine's time constant of a contact by scene [s]."""

ROWS = study_spec.STEP_CASES | study_spec.STIFF_CASES | study_spec.RELEASE_CASES
"""Scenes with the landings from all heights side by side."""


def row(run: Experiment, scene: str) -> list[tuple[str, ContactCase, LandingMetrics]]:
    """Return name, case and metrics of each landing of a scene, in the order of their heights."""
    return [(name, case, run.metrics[name]) for name, case in ROWS[scene].items()]


def case_of(scene: str) -> ContactCase:
    """Return the first case of a scene; its steps and its time constant are those of all."""
    return next(iter(ROWS[scene].values()))


def share_of_step(scene: str) -> float:
    """Return h / T, the solver step as a share of the time constant that is in force."""
    case = case_of(scene)
    return case.h / theory.contact_seconds(case)


FINEST_SCENE = min(study_spec.STEP_CASES, key=share_of_step)


def depth_shares(run: Experiment, scene: str) -> list[float]:
    """Return each depth as a share of v T / e, in the order of the heights."""
    return [found.penetration / theory.depth(case) for _, case, found in row(run, scene)]


def clean(run: Experiment) -> list[str]:
    """Return the slides with the elliptic cone and the resolution that comes with it."""
    return [n for n, c in run.cases.items() if c.cone == "elliptic" and c.resolution is None]


def time_constants(run: Experiment) -> Iterator[Finding]:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    for name, found in run.readings[GROUP].items():
        expected = theory.contact_seconds(case_of(name))
        yield within(f"{name}.time_constant_s", found, expected, study_spec.TIME_CONSTANT)


def records_each_step(run: Experiment) -> Iterator[Finding]:
    """With every solver step recorded, the baseline falls as with every second one."""
    name = study_spec.AS_BASELINE
    fine, coarse = aligned(run.traces[name], run.traces["baseline"], "link_pos")
    difference = float(np.abs(fine - coarse)[:, 2].max())
    yield at_most(f"{name}.distance_to_baseline_m", difference, spec.SAME_STATE)


def rebound_goes(run: Experiment) -> Iterator[Finding]:
    """With the default time constant, all cubes rebound at the baseline's solver step; at all
    smaller steps studied, none does from any of the nine heights.
    """
    for name in study_spec.STEP_CASES:
        rebounds, step = [found.rebound for *_, found in row(run, name)], case_of(name).h
        limit = CLEAR if step < spec.BASELINE.h else np.inf
        yield at_most(f"{name}.highest_rebound_m", max(rebounds), limit)
        if step == spec.BASELINE.h:
            yield above(f"{name}.lowest_rebound_m", min(rebounds), CLEAR)


def scatter_shrinks(run: Experiment) -> Iterator[Finding]:
    """Depths as shares of v T / e scatter widely at h = T / 2, and less at every smaller step."""
    limit = np.inf
    for name in sorted(study_spec.STEP_CASES, key=share_of_step, reverse=True):
        shares = depth_shares(run, name)
        scatter, label = float(np.ptp(shares)), f"{name}.scatter_of_depth_share"
        coarse = above(label, scatter, study_spec.SCATTER_COARSE)
        yield coarse if share_of_step(name) >= 0.5 else below(label, scatter, limit)
        limit = min(limit, scatter)
        yield noted(f"{name}.smallest_depth_share", min(shares))
    yield at_most("scatter_left", limit, study_spec.SCATTER_FINE)


def first_step_decides(run: Experiment) -> Iterator[Finding]:
    """With solver steps of 5 ms and 10 ms, half the time constant in force, the first sample in the
    table is the deepest of each landing: its depth follows from the fall alone.
    """
    for name, case, found in (*row(run, "h_5000us"), *row(run, "h_10000us")):
        depth = theory.first_depth(case)
        yield within(f"{name}.depth_m", found.penetration, depth, study_spec.FIRST_DEPTH)


def depth_by_hand(run: Experiment) -> Iterator[Finding]:
    """With fine steps, each cube sinks in by v T / e: within 10 % for a time constant of 10 ms, and
    within 20 % for 2 ms.
    """
    allowed = {FINEST_SCENE: study_spec.DEPTH_SHARE, study_spec.STIFF: study_spec.STIFF_SHARE}
    for scene, share in allowed.items():
        for name, found in zip(ROWS[scene], depth_shares(run, scene), strict=True):
            yield within(f"{name}.depth_share", found, 1.0, share)


def default_cone_hops(run: Experiment) -> Iterator[Finding]:
    """With the engine's default friction model, both cubes that are pushed to 2 m/s hop."""
    for name, case in study_spec.HOPPED.items():
        top = float(run.traces[name].link_pos[:, 0, 2].max())
        yield noted(f"{name}.rise_m", top - case.rest_height)
        yield above(f"{name}.hop_m", run.metrics[name].hop, study_spec.HOP)


def by_formula(run: Experiment, name: str) -> Finding:
    """Require the hop of one solver step, within 25 %."""
    hop, expected = run.metrics[name].hop, theory.hop(run.cases[name])
    return nearly(f"{name}.hop_m", hop, expected, study_spec.HOP_SHARE)


def hop_follows_step(run: Experiment) -> Iterator[Finding]:
    """From 10 ms to 2 ms the hop is that of the formula for one step, within 25 %; at smaller steps
    at most 15 % of the hop at 5 ms is left.
    """
    for step, cases in study_spec.HOP_STEP_CASES.items():
        for name in cases:
            left = study_spec.HOP_LEFT * run.metrics[name.replace(step, "hop_5000us")].hop
            applies = step in study_spec.HOP_APPLIES
            fine = at_most(f"{name}.hop_m", run.metrics[name].hop, left)
            yield by_formula(run, name) if applies else fine


def hop_follows_speed(run: Experiment) -> Iterator[Finding]:
    """At a step of 5 ms the hop grows with the speed, and is below 1 mm up to 0.2 m/s."""
    previous = 0.0
    for name, case in study_spec.HOP_SPEED_CASES.items():
        found = run.metrics[name].hop
        slow = at_most(f"{name}.hop_m", found, study_spec.INVISIBLE)
        yield slow if case.speed <= study_spec.SLOW else by_formula(run, name)
        yield above(f"{name}.higher_than_slower_m", found - previous, 0.0)
        previous = found


def clean_slides_stay_down(run: Experiment) -> Iterator[Finding]:
    """With the engine's elliptic cone, cubes slide on four corners at every sample."""
    for name in clean(run):
        yield at_most(f"{name}.hop_m", run.metrics[name].hop, CLEAR)
        contacts = run.traces[name].contacts[:, 0]
        yield equal(f"{name}.fewest_contacts", contacts.min(), 4)
        yield equal(f"{name}.most_contacts", contacts.max(), 4)


def clean_slides_are_coulomb_s(run: Experiment) -> Iterator[Finding]:
    """With the elliptic cone, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    for name in clean(run):
        expected = theory.stepped_distance(run.cases[name])
        found = run.metrics[name].stop_distance
        yield within(f"{name}.stop_distance_m", found, expected, study_spec.STEPPED_TOLERANCE)


def clean_slides_order(run: Experiment) -> Iterator[Finding]:
    """With less friction a cube with the elliptic cone travels farther; the smaller coefficient
    changes nothing.
    """
    return checks.orders_of_distances(run, "_elliptic")


def larger_friction_rules(run: Experiment) -> Iterator[Finding]:
    """Clean slides show the larger of two coefficients, and fit no other rule."""
    for name in clean(run):
        case, distance = run.cases[name], run.metrics[name].stop_distance
        if distance is None:
            yield Finding(f"{name}.friction", None, False, "a coefficient")
            continue
        apparent = theory.apparent_friction(case, distance + case.speed * case.h / 2)
        both = case.friction, case.surface_friction
        errors = {rule: abs(of(*both) - apparent) for rule, of in theory.RULES.items()}
        fits = [rule for rule, error in errors.items() if error <= study_spec.RULE_TOLERANCE]
        expected = f"the larger of {both[0]:g} and {both[1]:g} and no other rule; "
        expected += f"it fits {' and '.join(fits) or 'none'}"
        yield Finding(f"{name}.friction", apparent, fits == ["the larger"], expected)


CHECKS = (
    time_constants, records_each_step, rebound_goes, scatter_shrinks, first_step_decides,
    depth_by_hand,
    clean_slides_stay_down, clean_slides_are_coulomb_s, clean_slides_order, larger_friction_rules,
    default_cone_hops, hop_follows_step, hop_follows_speed,
)  # fmt: skip
