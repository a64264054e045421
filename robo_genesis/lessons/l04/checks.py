"""Named checks of a step experiment."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from robo_genesis.core.check_spec import LIMIT_TOLERANCE, READ_BACK
from robo_genesis.core.checks import Finding, at_most, below, equal, model_counts
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.laws import laws_of_motion
from robo_genesis.lessons.l04.metrics import RISE_FRACTION, SETTLING_BAND, is_saturated
from robo_genesis.sim.arm import laws
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joint_control import differences
from robo_genesis.sim.arm.joints import EFFORT_UNIT, POSITION_UNIT
from robo_genesis.sim.common_checks import posture, stamps


def mapping(run: Experiment) -> Iterator[Finding]:
    """Seven arm joints and two finger joints are found by name, each with its own DOF."""
    model = run.readings["model"]
    yield from model_counts(model, spec.EXPECTED_MODEL)
    yield equal("joint_names", run.joints.names, JOINT_NAMES)
    yield equal("joint_types", run.joints.types, spec.EXPECTED_TYPES)
    for what, indices in (("dofs", run.joints.dofs_idx_local), ("qpos", run.joints.qs_idx_local)):
        inside = ((indices >= 0) & (indices < model[what])).all()
        distinct = len(set(indices)) == len(JOINT_NAMES)
        expected = f"nine different indices below {model[what]}"
        yield Finding(f"local_{what}", indices, bool(distinct and inside), expected)


def configuration(run: Experiment) -> Iterator[Finding]:
    """Start, target, gains and limits have one finite value per joint; joint types have units."""
    fields = ("q_start", "q_target", "kp", "kv", "effort_limit")
    chosen = {f"{n}.{name}": getattr(of, name) for n, of in spec.CASES.items() for name in fields}
    limits = {f"limits.{name}": getattr(run.joints, name) for name in ("lower", "upper")}
    for name, values in (chosen | limits).items():
        recorded = name in limits
        yield equal(f"{name}.shape", np.shape(values), (len(run.joints.names),), recorded)
        yield equal(f"{name}.not_finite", int((~np.isfinite(values)).sum()), 0, recorded)
    unknown = set(run.joints.types) - (POSITION_UNIT.keys() & EFFORT_UNIT.keys())
    yield equal("joint_types_without_unit", sorted(unknown), [])


def target_limits(run: Experiment) -> Iterator[Finding]:
    """Every start and target lies within the model's limits."""
    for case, name in product(spec.CASES, ("q_start", "q_target")):
        q = getattr(spec.CASES[case], name)
        beyond = np.maximum(run.joints.lower - q, q - run.joints.upper)
        worst = run.joints.names[int(np.argmax(beyond))]
        yield at_most(f"{case}.{name}.beyond_limit_of_{worst}", beyond.max(), LIMIT_TOLERANCE)


def baseline_approaches(run: Experiment) -> Iterator[Finding]:
    """The baseline ends nearer to its target than it starts."""
    m = run.metrics["baseline"]
    yield below("baseline.final_error_rad", m.final_error, m.initial_error)


def same_start(run: Experiment) -> Iterator[Finding]:
    """The compared cases start in the same state, at rest."""
    first = run.traces["G1"]
    for name in ("G1", "G2", "G3"):
        trace = run.traces[name]
        links = np.abs(trace.link_pos[0] - first.link_pos[0]).max()
        yield equal(f"{name}.joints_against_G1", np.abs(trace.q[0] - first.q[0]).max(), 0.0)
        yield equal(f"{name}.links_against_G1_m", links, 0.0)
        yield equal(f"{name}.start_speed", np.abs(trace.start_qd).max(), 0.0)


def one_factor(run: Experiment) -> Iterator[Finding]:
    """G1 and G2 differ in the stepped joint's KP alone, G2 and G3 in its KV alone."""
    for (one, other), expected in spec.ONE_FACTOR.items():
        found = differences(spec.CASES[one], spec.CASES[other], run.joints)
        yield equal(f"difference of {one} and {other}", found, expected, recorded=False)


def not_observed(run: Experiment) -> Iterator[Finding]:
    """A time is given exactly where the samples reach it, and `not observed` where they do not."""
    for name in spec.CASES:
        trace, m = run.traces[name], run.metrics[name]
        q = trace.q[:, spec.ENTRY].astype(np.float64)
        q_target = float(trace.target[0, spec.ENTRY])
        risen = q - q[0] >= RISE_FRACTION * (q_target - q[0])
        inside = np.abs(q - q_target) <= SETTLING_BAND
        rise, settled = m.rise_time, m.settling_time
        early = risen & (trace.t < (rise or 0.0))
        late = ~inside & (trace.t >= (np.inf if settled is None else settled))
        yield equal(f"{name}.has_rise_time", rise is not None, bool(risen.any()))
        yield equal(f"{name}.has_settling_time", settled is not None, bool(inside[-1]))
        yield equal(f"{name}.samples_risen_before_rise_time", int(early.sum()), 0)
        yield equal(f"{name}.samples_off_band_after_settling_time", int(late.sum()), 0)


def control_law(run: Experiment) -> Iterator[Finding]:
    """Each control force is clip(KP (q_target − q) − KV q̇) with the gains of its own case."""
    for name, case in spec.CASES.items():
        trace = run.traces[name]
        law = laws.control_law(case, trace.q[1:], trace.qd)  # (n, d)
        apart = float(np.abs(law - trace.control_force).max())
        yield at_most(f"{name}.distance_to_control_law", apart, laws.LAW)


def measurements(run: Experiment) -> Iterator[Finding]:
    """Position, velocity and forces are finite, and no control force exceeds its limit."""
    fields = ("q", "qd", "control_force", "internal_force")
    for name in spec.CASES:
        trace = run.traces[name]
        finite = all(np.isfinite(getattr(trace, field)).all() for field in fields)
        yield equal(f"{name}.finite", finite, True)
        excess = (np.abs(trace.control_force) - trace.effort_limit).max()
        yield at_most(f"{name}.control_force_above_limit", excess, spec.LIMIT_EXCESS)


def saturation(run: Experiment) -> Iterator[Finding]:
    """The limit reads back as it was set, and saturated samples are counted against it."""
    for name, case in spec.CASES.items():
        trace, m = run.traces[name], run.metrics[name]
        share = np.abs(trace.effort_limit - case.effort_limit) / np.abs(case.effort_limit)
        yield at_most(f"{name}.limit_read_back_share", share.max(), READ_BACK)
        force = trace.control_force[:, spec.ENTRY].astype(np.float64)
        count = int(is_saturated(force, float(trace.effort_limit[spec.ENTRY])).sum())
        yield equal(f"{name}.saturation_samples", m.saturation_samples, count)
        yield equal(f"{name}.saturation_duration_s", m.saturation_duration, count * case.dt)


CHECKS = (
    mapping, configuration, target_limits, baseline_approaches, stamps, same_start, one_factor,
    control_law, not_observed, measurements, saturation, laws_of_motion, posture,
)  # fmt: skip
WITHOUT_CAMERA = tuple(check for check in CHECKS if check is not posture)
