"""Tables of landings, slides and bounces: functions of the experiment."""

from collections.abc import Sequence

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.tables import Rows, as_table, metric_table
from robo_genesis.core.text import NOT_OBSERVED, format_value, readable
from robo_genesis.sim.bodies.contacts import ContactCase

from . import checks, spec, study, study_spec, theory
from .metrics import CLEAR, BounceMetrics, LandingMetrics, SlideMetrics
from .text import millimetres, milliseconds

MEASURES = False


def span(values: Sequence[float], digits: int = 2) -> str:
    """Write the smallest and the largest value: `0.94 to 0.96`."""
    return f"{min(values):.{digits}f} to {max(values):.{digits}f}"


# The lab


def of_kind(run: Experiment, kind: type[CaseMetrics]) -> str:
    """Return the metrics of the runs of one kind."""
    found = {spec.LABELS[name]: of for name, of in checks.measured(run, kind).items()}
    return metric_table(found, readable)


def landings(run: Experiment) -> str:
    """Return the metrics of the dropped cubes."""
    return of_kind(run, LandingMetrics)


def slides(run: Experiment) -> str:
    """Return the metrics of the pushed cubes."""
    return of_kind(run, SlideMetrics)


def bounces(run: Experiment) -> str:
    """Return the metrics of the balls."""
    return of_kind(run, BounceMetrics)


# The lecture


def stop(run: Experiment, name: str) -> str:
    """Write a stopping distance."""
    return format_value(run.metrics[name].stop_distance, "m")


@as_table
def clean_slides(run: Experiment) -> Rows:
    """Return the slides with the elliptic cone beside Coulomb's distance."""
    for name, case, found in study.clean(run):
        yield {
            "cube on table": f"{case.friction:g} on {case.surface_friction:g}",
            "h": milliseconds(case.h),
            "measured": stop(run, name),
            "v² / (2 μ g)": format_value(theory.coulomb_distance(case), "m"),
            "v² / (2 μ g) − v h / 2": format_value(theory.stepped_distance(case), "m"),
            "hop": millimetres(found.hop),
        }


@as_table
def hops_by_step(run: Experiment) -> Rows:
    """Return the hops by solver step for both coefficients, with the formula of one step."""
    for cases in study_spec.HOP_STEP_CASES.values():
        case = next(iter(cases.values()))
        row = {
            "h": milliseconds(case.h),
            "h / T": f"{case.h / theory.contact_seconds(case):.3g}",
        }
        for name, of in cases.items():
            mu = theory.pair_friction(of)
            row[f"μ = {mu:g}"] = millimetres(run.metrics[name].hop)
            row[f"formula, μ = {mu:g}"] = millimetres(theory.hop(of))
        yield row


@as_table
def hops_by_speed(run: Experiment) -> Rows:
    """Return the hops by the speed of the push at a solver step of 5 ms."""
    for name, case in study_spec.HOP_SPEED_CASES.items():
        yield {
            "push": f"{case.speed:g} m/s",
            "hop": millimetres(run.metrics[name].hop),
            "formula": millimetres(theory.hop(case)),
        }


# The deeper pages


@as_table
def settings_of_cones(run: Experiment) -> Rows:
    """Return the pushed cubes by what the setting of the cone switches."""
    kinds = (
        ("", "convex", "1"),
        ("_convex", "convex", "1"),
        ("_elliptic", "signorini", "100"),
    )
    for suffix, resolution, impratio in kinds:
        for name in (f"{of}{suffix}" for of in study_spec.HOPPED):
            case, found = run.cases[name], run.metrics[name]
            distance = found.stop_distance
            apparent = distance and f"{theory.apparent_friction(case, distance):.3f}"
            yield {
                "cone": case.cone,
                "resolution": resolution,
                "impratio": impratio,
                "μ": f"{theory.pair_friction(case):g}",
                "hop": millimetres(found.hop),
                "turns at up to": f"{found.spin:.2f} rad/s",
                "stops after": stop(run, name),
                "apparent μ": apparent or NOT_OBSERVED,
            }


@as_table
def stops_by_step(run: Experiment) -> Rows:
    """Return the stopping distances of both pushed cubes by solver step."""
    low, high = (study.stops_of_lane(run, lane) for lane in study.LANES)
    for one, other in zip(low, high, strict=True):
        yield {
            "h": milliseconds(run.cases[one].h),
            "μ = 0.5 stops after": stop(run, one),
            "μ = 0.8 stops after": stop(run, other),
            "μ = 0.8 takes": format_value(run.metrics[other].stop_time, "s"),
        }


@as_table
def engines(run: Experiment) -> Rows:
    """Return how far each pair of runs is apart, and from when they are farther than 0.05 mm."""
    for pair in (
        *study_spec.ENGINE_PAIRS.items(),
        ("baseline", study_spec.OWN_DEFAULTS),
    ):
        distance = study.distance_between(*(run.traces[name] for name in pair))
        excess = np.flatnonzero(distance > study_spec.ENGINES_APART)
        since, counts = "never", ["–", "–"]
        if len(excess):
            since = f"{run.traces[pair[1]].t[excess[0]]:.2f} s"
            counts = [str(run.traces[name].contacts[excess[0], 0]) for name in pair]
        rise = "hop" if run.cases[pair[0]].speed else "rebound"
        heights = [f"{1000 * getattr(run.metrics[name], rise):.2f}" for name in pair]
        yield {
            "run": described(run.cases[pair[0]], pair[1] == study_spec.OWN_DEFAULTS),
            "rebound or hop [mm]": " and ".join(heights),
            "farthest apart": readable(distance.max(), "m"),
            "over 0.05 mm from": since,
            "contacts there": " and ".join(counts),
        }


def described(case: ContactCase, own_defaults: bool) -> str:
    """Describe a pair of runs, in Genesis and in the other engine, by what distinguishes it."""
    if case.speed:
        return f"push, {case.cone}, μ = {theory.pair_friction(case):g}"
    own = ", MuJoCo's own contact" if own_defaults else ""
    return f"landing, h = {milliseconds(case.h)}{own}"


@as_table
def releases(run: Experiment) -> Rows:
    """Return release speed and rebound by time constant, beside the linear contact."""
    for scene in study_spec.RELEASE_CASES:
        runs, case = study.row(run, scene), study.case_of(scene)
        shares = [found.upward_speed / theory.impact_speed(of) for _, of, found in runs]
        yield {
            "T": milliseconds(theory.contact_seconds(case)),
            "h": milliseconds(case.h),
            "upward speed / impact speed": span(shares, 3),
            "rebound": heights([found.rebound for *_, found in runs]),
            "linear contact": heights([theory.rebound(of) for _, of, _ in runs]),
        }


def heights(rebounds: Sequence[float]) -> str:
    """Write the smallest and the largest rebound."""
    if max(rebounds) <= CLEAR:
        return "none"
    return f"{span([1000 * rebound for rebound in rebounds])} mm"
