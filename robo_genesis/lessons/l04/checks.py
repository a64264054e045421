"""Named checks of the lab and of both parts of the lecture."""

import numpy as np

from robo_genesis.core import checks
from robo_genesis.core.checks import (
    Finding,
    Findings,
    above,
    at_most,
    below,
    equal,
    nearly,
    noted,
)
from robo_genesis.core.comparison import HELD
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import format_value
from robo_genesis.sim.arm import laws
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import differences
from robo_genesis.sim.common_checks import posture, stamps
from robo_genesis.sim.laws import kept

from . import spec, study, study_spec
from .metrics import SETTLING_BAND, is_saturated


def mapping(run: Experiment) -> Findings:
    """Seven arm joints and two finger joints are found by name, each with its own DOF."""
    model = run.readings["model"]
    yield from checks.model_counts(model, spec.EXPECTED_MODEL)
    yield equal("joint_names", run.joints.names, JOINT_NAMES)
    yield equal("joint_types", run.joints.types, spec.EXPECTED_TYPES)
    for what, indices in (
        ("dofs", run.joints.dofs_idx_local),
        ("qpos", run.joints.qs_idx_local),
    ):
        inside = ((indices >= 0) & (indices < model[what])).all()
        distinct = len(set(indices)) == len(JOINT_NAMES)
        expected = f"nine different indices below {model[what]}"
        yield Finding(f"local_{what}", indices, bool(distinct and inside), expected)


def baseline_approaches(run: Experiment) -> Findings:
    """The baseline ends nearer to its target than it starts."""
    m = run.metrics["baseline"]
    yield below("baseline.final_error_rad", m.final_error, m.initial_error)


def same_start(run: Experiment) -> Findings:
    """The compared cases start in the same state, at rest."""
    first = run.traces["G1"]
    for name in study_spec.COMPARED:
        trace = run.traces[name]
        for label, difference in (
            ("joints_against_G1", trace.q[0] - first.q[0]),
            ("links_against_G1_m", trace.link_pos[0] - first.link_pos[0]),
            ("start_speed", trace.start_qd),
        ):
            yield equal(f"{name}.{label}", np.abs(difference).max(), 0.0)


def one_factor(run: Experiment) -> Findings:
    """G1 and G2 differ in the stepped joint's KP alone, G2 and G3 in its KV alone."""
    for (one, other), expected in spec.ONE_FACTOR.items():
        found = differences(spec.CASES[one], spec.CASES[other], run.joints)
        yield equal(f"difference of {one} and {other}", found, expected, recorded=False)


# The compared cases, gravity and a longer window


def orders(run: Experiment, engine: str, substeps: int = study.SUBSTEPS) -> Findings:
    """Require every ordering that the lesson claims of an engine's runs."""
    finer = f", {substeps} substeps" * (substeps != study.SUBSTEPS)
    for relation in spec.RELATIONS:
        (first, second), metric, order, _ = relation
        state, values = study.relation_outcome(run, engine, relation, substeps)
        label = f"{engine}{finer}: {metric}, {second} {order} than {first}"
        yield Finding(label, state, state == HELD, f"{HELD}: {values}", recorded=False)


def claimed_orders(run: Experiment) -> Findings:
    """Every ordering that the lesson claims holds in the compared cases."""
    return orders(run, "Genesis")


def clipped_start(run: Experiment) -> Findings:
    """G1 and G2 get the same clipped effort and move alike until G1 leaves its limit,
    which is before G2 does. G2 and G3 get the same clipped effort until G2 leaves the
    limit, and then G3 is slower. G2 also brakes at a limit. The effort of G3 first
    brakes farther from the target.
    """
    g1, g2, g3 = (run.traces[case] for case in study_spec.COMPARED)
    until = [study.at_limit_until(trace) for trace in (g1, g2)]
    yield above("G1.at_limit_until_s", until[0], 0.0)
    yield above("G2.at_limit_until_s", until[1], until[0])
    pairs = {"G1_and_G2": (g1, g2, until[0]), "G2_and_G3": (g2, g3, until[1])}
    slower = {}
    for name, (one, other, end) in pairs.items():
        n = round(end / one.dt)
        efforts = (trace.control_force[:n, spec.ENTRY] for trace in (one, other))
        yield equal(f"{name}.same_efforts", np.equal(*efforts).all(), True)
        slower[name] = one.qd[n - 1, spec.ENTRY] - other.qd[n - 1, spec.ENTRY]
    apart, noise = abs(slower["G1_and_G2"]), spec.RESOLUTION["rad/s"]
    yield at_most("G1_and_G2.speed_difference_rad_s", apart, noise)
    yield above(
        "G3.slower_than_G2_rad_s", slower["G2_and_G3"], spec.MARGINS["peak_speed"]
    )
    force, speed = g2.control_force[:, spec.ENTRY], g2.qd[:, spec.ENTRY]
    braking = is_saturated(force, g2.effort_limit[spec.ENTRY]) & (force * speed < 0)
    yield above("G2.braking_samples", braking.sum(), 0)
    left = [study.braking_error(trace) for trace in (g2, g3)]
    yield noted("G2.braking_error_rad", left[0])
    yield above("G3.braking_error_rad", left[1], left[0])


def gravity_support(run: Experiment) -> Findings:
    """Where a case ends nearly at rest, KP × final error agrees with the gravity effort."""
    for case in spec.CASES:
        if abs(run.metrics[case].final_velocity) <= study_spec.AT_REST:
            found, share = study.supports(run, case), study_spec.GRAVITY_AGREEMENT
            yield nearly(f"{case}.support_Nm", *found, share)


def ends_at_rest(run: Experiment) -> Findings:
    """The baseline and the compared cases end nearly at rest, inside the settling band."""
    for name in spec.CASES:
        m = run.metrics[name]
        yield at_most(
            f"{name}.final_speed_rad_s", abs(m.final_velocity), study_spec.AT_REST
        )
        yield below(f"{name}.share_of_band", m.final_error / SETTLING_BAND, 1.0)


def same_beginning(run: Experiment) -> Findings:
    """The longer run of G2 begins with exactly the samples of G2."""
    for name in ("q", "qd", "control_force"):
        short, long = (
            getattr(run.traces[of], name) for of in ("G2", study_spec.LONGER)
        )
        same = np.array_equal(short, long[: len(short)])
        yield equal(f"same_{name}", same, True, recorded=False)


def same_metrics(run: Experiment) -> Findings:
    """The longer run of G2 has the metrics of G2, in the digits that are shown."""
    longer = run.metrics[study_spec.LONGER]
    for name, value, unit in run.metrics["G2"].items():
        found = format_value(getattr(longer, name), unit)
        yield equal(name, found, format_value(value, unit), recorded=False)


def which_joint(run: Experiment) -> Findings:
    """P1 turns joint4 and P2 joint5; no other joint moves a tenth as far."""
    for name, joint in (("P1", 4), ("P2", 5)):
        q = run.traces[name].q
        moved = np.abs(q[-1] - q[0])
        second, most = np.sort(moved)[-2:]
        yield equal(f"{name}.joint", moved.argmax() + 1, joint)
        yield below(f"{name}.share_of_others", second / most, study_spec.ALONE)


def assigned_only(run: Experiment) -> Findings:
    """In the assigned run the engine reports no velocity and no control force."""
    trace = run.traces[study_spec.ASSIGNED]
    yield equal("largest_velocity", np.abs(trace.qd).max(), 0.0)
    yield equal("largest_force", np.abs(trace.control_force).max(), 0.0)


def laws_of_motion(run: Experiment) -> Findings:
    """At each sample links and control forces are those of the driven or assigned robot: a
    control force is clip(KP (q_target − q) − KV q̇) with the gains of its own case.
    """
    for name, case in run.cases.items():
        trace = run.traces[name]
        if name == study_spec.ASSIGNED:
            found = laws.assigned_run(trace, run.links, case.model)
        else:
            found = laws.driven_run(trace, case, run.links)
        yield from kept(name, found)


WITHOUT_CAMERA = (
    mapping,
    baseline_approaches,
    stamps,
    same_start,
    one_factor,
    laws_of_motion,
)
CHECKS = (*WITHOUT_CAMERA, posture)

# Those of part 1 of the lecture, and those that part 2 has besides.
LECTURE = (mapping, stamps, which_joint, assigned_only, laws_of_motion, posture)
MOTION = (
    claimed_orders,
    clipped_start,
    gravity_support,
    ends_at_rest,
    same_beginning,
    same_metrics,
)
