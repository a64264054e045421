"""Named checks of landings, slides and bounces: all pass, or the invariant that failed is named."""

from typing import Any

import numpy as np

from robo_genesis.core import checks
from robo_genesis.core.checks import Findings, above, at_most, nearly, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.sim.bodies.checks import laws_of_motion, settings, structure
from robo_genesis.sim.bodies.contacts import TOP
from robo_genesis.sim.common_checks import posture, stamps

from . import spec, theory
from .metrics import BounceMetrics, LandingMetrics, SlideMetrics, aligned, of_body


def measured(run: Experiment, metrics: type[CaseMetrics]) -> dict[str, Any]:
    """Return the metrics of the runs of one kind, by run."""
    return {name: of for name, of in run.metrics.items() if isinstance(of, metrics)}


def mass(run: Experiment) -> Findings:
    """The engine's masses are density times volume."""
    expected = {case.shape: case.mass for case in run.cases.values()}
    return checks.masses(run.readings["mass"], expected)


def one_factor(run: Experiment) -> Findings:
    """Compared cases differ in the declared factors and in nothing else."""
    return checks.factors(run.cases, spec.ONE_FACTOR)


def lands(run: Experiment) -> Findings:
    """Each dropped cube touches the surface, and its centre stays above the upper face."""
    for name, found in measured(run, LandingMetrics).items():
        trace = run.traces[name]
        yield above(f"{name}.touchdown_s", found.touchdown, 0)
        yield above(f"{name}.most_contacts", trace.contacts.max(), 0)
        yield above(f"{name}.lowest_m", trace.link_pos[:, 0, 2].min(), TOP)


def reported_late(run: Experiment) -> Findings:
    """With one substep, a reported depth belongs to the state before: it is one step old."""
    for name in measured(run, LandingMetrics):
        case, trace = run.cases[name], run.traces[name]
        if case.substeps == 1:
            below = np.maximum(case.rest_height - of_body(trace.link_pos)[:-1, 2], 0)
            error = np.abs(trace.penetration[1:, 0] - below).max()
            yield at_most(f"{name}.depth_error_m", error, spec.DEPTH_TOLERANCE)


def equal_step_equal_states(run: Experiment) -> Findings:
    """Runs with equal solver steps and different outer steps share states at shared times."""
    short, long = spec.EQUAL_STEP
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        one, other = aligned(run.traces[short], run.traces[long], name)
        yield at_most(
            f"{short}.{name}_against_{long}", np.abs(one - other).max(), spec.SAME_STATE
        )


def settles(run: Experiment) -> Findings:
    """Each dropped cube settles at its resting height within the window."""
    for name, found in measured(run, LandingMetrics).items():
        yield above(f"{name}.resting_time_s", found.resting_time, 0)


def stops(run: Experiment) -> Findings:
    """Each pushed cube stops within the window by the declared rule."""
    for name, found in measured(run, SlideMetrics).items():
        yield above(f"{name}.stop_distance_m", found.stop_distance, 0)


def friction_orders(run: Experiment) -> Findings:
    """With less friction a cube travels farther; the smaller coefficient changes nothing."""
    return orders_of_distances(run, "")


def orders_of_distances(run: Experiment, model: str) -> Findings:
    """Require the orders of stopping distances; `model` ends the names of the compared runs."""
    far = {
        name: run.metrics[name + model].stop_distance or np.nan for name in spec.SLIDES
    }
    for near, farther in (("high_on_050", "low_on_050"), ("low_on_050", "low_on_030")):
        label = f"{farther}{model}.farther_than_{near}{model}_m"
        yield above(label, far[farther] - far[near], 0)
    change = abs(far["high_on_030"] - far["high_on_050"])
    yield at_most(f"high{model}.change_of_distance_m", change, spec.SAME_SLIDE)


def near_coulomb(run: Experiment) -> Findings:
    """Each stopping distance is within 20 % of v² / (2 μ g) with the larger coefficient."""
    for name, found in measured(run, SlideMetrics).items():
        expected = theory.coulomb_distance(run.cases[name])
        label, share = f"{name}.stop_distance_m", spec.COULOMB_SHARE
        yield nearly(label, found.stop_distance, expected, share)


def level_in_flight(run: Experiment) -> Findings:
    """In the air, the energy that semi-implicit Euler conserves is constant to within float32."""
    for name, found in measured(run, BounceMetrics).items():
        allowed = spec.LEVEL_SHARE * found.start_energy
        yield at_most(f"{name}.flight_drift_J", found.flight_drift, allowed)


def energy_converges(run: Experiment) -> Findings:
    """The finest step keeps at the bounce the energy of a linear spring; a coarse one does not."""
    kept = {
        name: found.first_kept for name, found in measured(run, BounceMetrics).items()
    }
    finest, *coarser = sorted(kept, key=lambda name: run.cases[name].h)
    expected = 100 * theory.kept_at_bounces(spec.SPRING[1])
    label = f"{finest}.first_kept_percent"
    yield within(label, kept[finest], expected, spec.FINE_SHARE)
    for name in coarser:
        yield above(f"{name}.first_kept_percent", kept[name], 0)
    errors = [abs((kept[name] or np.nan) - expected) for name in coarser]
    yield above("largest_difference_percent", max(errors), spec.COARSE_SHARE)


CHECKS = (
    structure,
    mass,
    settings,
    stamps,
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
    laws_of_motion,
    posture,
)

# The checks that the runs of every page must pass.
OF_ALL_PAGES = (structure, mass, settings, stamps, laws_of_motion)
