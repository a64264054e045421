"""Named checks of L04's deeper pages: theory, solver step, second engine, grid."""

from itertools import pairwise
from typing import Any

import numpy as np

from robo_genesis.core.checks import (
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
from robo_genesis.sim.arm.joint_control import differences

from . import checks, spec, study, study_spec
from .metrics import is_saturated
from .theory import overshoot_share


def study_factors(run: Experiment) -> Findings:
    """Each study case differs from its compared case in one factor: target, substeps or window."""
    factors = {
        f"q_target[{spec.STEPPED_JOINT}]": study_spec.STEP_CASES,
        "substeps": study_spec.SUBSTEP_CASES,
        "steps": study_spec.LONGER_CASES,
    }
    for factor, cases in factors.items():
        for name, case in ((n, c) for n, c in cases.items() if n in run.page.runs):
            compared = name.split("_")[0]
            found = differences(study_spec.COMPARED[compared], case, run.joints)
            yield equal(
                f"difference of {compared} and {name}", found, [factor], recorded=False
            )


def same_model(run: Experiment) -> Findings:
    """What the engines report of the stepped joint agrees with its model in MuJoCo."""
    expected = study.by_model(run.traces)
    for name, value in run.readings[study.GROUP].items():
        yield nearly(name, value, expected[name], study_spec.SAME_MODEL)


def small_step_unsaturated(run: Experiment) -> Findings:
    """No effort of the small steps and of the hold runs reaches the saturation threshold."""
    for name in study_spec.STEP_CASES:
        trace = run.traces[name]
        efforts = np.vstack([trace.start_control_force, trace.control_force])
        saturated = is_saturated(efforts, trace.effort_limit)[:, spec.ENTRY]
        yield equal(f"{name}.saturated_efforts", saturated.sum(), 0)


def theory_small_step(run: Experiment) -> Findings:
    """The overshoot of each small step agrees with the formula within the declared
    margin, and its curve is closer to the formula than that of the large step.
    """
    for case in study_spec.SMALL_STEPPED:
        ideal, found = study.ideal(run, case).overshoot, study.share(run, case, "small")
        allowed = study_spec.SMALL_STEP_TOLERANCE
        yield within(
            f"{case}_small.overshoot_share", overshoot_share(found), ideal, allowed
        )
        yield noted(f"{case}.ideal_overshoot_share", ideal)
        off_small, off_large = (
            study.off_ideal(run, case, kind) for kind in ("small", "")
        )
        yield below(f"{case}_small.distance_to_theory", off_small, off_large)


def stepped_model(run: Experiment) -> Findings:
    """The overshoots of a one-joint model with the solver step agree with Genesis
    within the declared margins.
    """
    small, allowed = study_spec.SMALL_STEP, study_spec.SMALL_STEP_TOLERANCE
    for case in study_spec.SMALL_STEPPED:
        _, model, found = (of / small for of in study.overshoots(run, case, small))
        yield within(f"{case}_small.overshoot_share_of_model", model, found, allowed)
    for case in study_spec.COMPARED:
        _, model, found = study.overshoots(run, case, spec.STEP)
        yield within(
            f"{case}.overshoot_of_model_rad",
            model,
            found,
            study_spec.ONE_JOINT_TOLERANCE,
        )


def model_predicts(run: Experiment) -> Findings:
    """The stepped model overshoots in the large steps in which Genesis does. In the
    small step of G1 it is nearer to Genesis than the ideal joint, in that of G2 it is
    not.
    """
    margin = spec.MARGINS["overshoot"]
    for case in study_spec.COMPARED:
        _, model, found = study.overshoots(run, case, spec.STEP)
        yield equal(f"{case}.model_overshoots", model > margin, found > margin)
    for case, nearer in (("G1", True), ("G2", False)):
        ideal, model, found = study.overshoots(run, case, study_spec.SMALL_STEP)
        off_model, off_ideal = (
            np.abs(np.array([model, ideal]) - found) / study_spec.SMALL_STEP
        )
        yield noted(f"{case}_small.model_off_share", off_model)
        yield noted(f"{case}_small.ideal_off_share", off_ideal)
        yield equal(f"{case}_small.model_nearer", off_model < off_ideal, nearer)


def clipped_before_parting(run: Experiment) -> Findings:
    """Each compared case is too far from the ideal joint at the first sample after t =
    0, and its effort at t = 0 is clipped.
    """
    for case in study_spec.COMPARED:
        trace, distance = run.traces[case], study.distance_from_ideal(run, case)
        clipped = is_saturated(trace.start_control_force, trace.effort_limit)
        too_far = study_spec.PARTING_THRESHOLD
        yield above(f"{case}.first_distance_rad", distance[1], too_far)
        yield equal(f"{case}.first_effort_clipped", clipped[spec.ENTRY], True)
        yield noted(f"{case}.largest_distance_rad", distance.max())


def convergence(run: Experiment) -> Findings:
    """G2's overshoot in Genesis falls with each refinement of the solver's step."""
    overshoot = study.overshoot_by_substeps(run, "Genesis")
    for coarse, fine in pairwise(overshoot):
        fall = overshoot[coarse] - overshoot[fine]
        yield above(
            f"fall_from_{coarse}_to_{fine}_substeps_rad", fall, spec.RESOLUTION["rad"]
        )


def one_limit(run: Experiment) -> Findings:
    """With a finer solver step, stable runs of both engines approach the same overshoot of G2."""
    steps = spec.G2.substeps, max(study_spec.SUBSTEPS_STUDIED)
    declared, finest = (study.spread(run, n) for n in steps)
    yield noted("spread_at_lesson_step_rad", declared)
    yield at_most(
        "spread_at_finest_step_rad", finest, study_spec.SPREAD_SHARE * declared
    )


def second_engine_order(run: Experiment) -> Findings:
    """Every ordering that the lesson claims holds in Genesis and in the stable runs of MuJoCo."""
    for engine in study.ENGINES:
        if not study.unstable(run, engine):
            yield from checks.orders(run, engine)


def order_at_finer_step(run: Experiment) -> Findings:
    """Every ordering that the lesson claims also holds in Genesis with half the solver
    step, and with a tenth.
    """
    for substeps in study_spec.REFINED:
        yield from checks.orders(run, "Genesis", substeps)


def stable_engines(run: Experiment) -> Findings:
    """At the lesson's solver step, G1 to G3 are stable in Genesis and with
    implicitfast, and at least one of them is unstable with Euler.
    """
    for engine in study.ENGINES:
        yield equal(
            f"{engine}.unstable", study.unstable(run, engine), engine == "Euler"
        )
    for case in ("G2", "G3"):
        above_two = np.flatnonzero(study.damping_ratio(case) > 2)
        yield noted(f"{case}.ratio_above_two", [run.joints.names[k] for k in above_two])
        chattering = run.traces[study.run_name("Euler", case)]
        yield noted(f"{case}.Euler_clipped", study.unstable_joints(chattering))


def first_step(run: Experiment) -> Findings:
    """G2 and G3 have the same clipped effort before and after the first outer step.
    They move alike in MuJoCo, while G3 is slower in Genesis.
    """
    noise = spec.RESOLUTION["rad/s"]
    speeds = {}
    for engine in study.ENGINES:
        for case in ("G2", "G3"):
            trace = run.traces[study.run_name(engine, case)]
            efforts = np.array([trace.start_control_force, trace.control_force[0]])
            clipped = is_saturated(efforts, trace.effort_limit)[:, spec.ENTRY]
            yield equal(f"{engine}.{case}_clipped", clipped.all(), True)
            speeds[case] = trace.qd[0, spec.ENTRY]
        slower, label = speeds["G2"] - speeds["G3"], f"{engine}.slower_rad_s"
        alike = within(label, slower, 0, noise)
        yield above(label, slower, noise) if engine == "Genesis" else alike


def implicit_term(run: Experiment) -> Findings:
    """A commanded position adds h (d + KV) to the joint's entry in the engine's mass matrix."""
    inertia = run.readings[study.GROUP]["inertia_Genesis"]
    for kv in study.COMPARED_KV:
        label = f"mass_KV_{kv:g}_less_term"
        mass = study.without_term(run, kv)
        yield within(label, mass, inertia, study_spec.SAME_MODEL * inertia)


def grid_matches_cases(run: Experiment) -> Findings:
    """G1, G2 and G3 give the same results in the batch as alone, within the declared margins."""
    for name, point in study_spec.CASE_POINTS.items():
        results = [results_of(run, of) for of in (name, point.name)]
        for what, unit in results[0]:
            a, b = np.array([of[what, unit] for of in results], float)  # None is NaN
            apart = np.where(np.isnan(a) & np.isnan(b), 0.0, np.abs(a - b)).max()
            label = f"{name}, difference of {what} ({unit})"
            yield at_most(label, apart, study_spec.AGREEMENT[unit])


def results_of(run: Experiment, name: str) -> dict[tuple[str, str], Any]:
    """Return curves and metrics of the stepped joint in a run by name and unit."""
    trace = run.traces[name]
    return {
        ("position", "rad"): trace.q[:, spec.ENTRY],
        ("control force", "N·m"): trace.control_force[:, spec.ENTRY],
    } | {(metric, unit): value for metric, value, unit in run.metrics[name].items()}


FORMULA = (
    study_factors,
    same_model,
    implicit_term,
    clipped_before_parting,
    small_step_unsaturated,
    theory_small_step,
    stepped_model,
    model_predicts,
)
INTEGRATOR = (
    study_factors,
    same_model,
    stable_engines,
    first_step,
    convergence,
    one_limit,
    second_engine_order,
    order_at_finer_step,
)
