"""Named checks of a step experiment."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from robo_genesis.core.checks import wrong_times
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.metrics import (
    RISE_FRACTION,
    SATURATION_THRESHOLD,
    SETTLING_BAND,
)  # fmt: skip
from robo_genesis.sim import end_state
from robo_genesis.sim.franka import JOINT_NAMES
from robo_genesis.sim.joint_control import LIMIT_TOLERANCE, differences
from robo_genesis.sim.joints import EFFORT_UNIT, POSITION_UNIT

CONTROL_LAW_TOLERANCE = 1e-2
"""Room for float32 in KP times a position error [N·m or N]."""


def mapping(run: Experiment) -> Iterator[str]:
    """Seven arm joints and two finger joints are found by name, each with its own DOF."""
    model = run.readings["model"]
    found = (
        ("the model has", dict(model), spec.EXPECTED_MODEL),
        ("names are", run.joints.names, JOINT_NAMES),
        ("types are", run.joints.types, spec.EXPECTED_TYPES),
    )
    yield from (f"{what} {a}, expected {b}" for what, a, b in found if a != b)
    for what, indices in (("dofs", run.joints.dofs_idx_local), ("qpos", run.joints.qs_idx_local)):
        inside = ((indices >= 0) & (indices < model[what])).all()
        if len(set(indices)) != len(JOINT_NAMES) or not inside:
            yield (
                f"local {what} are {indices.tolist()}, expected nine distinct ones below "
                f"{model[what]}"
            )


def configuration(run: Experiment) -> Iterator[str]:
    """Start, target, gains and limits have one finite value per joint; joint types have units."""
    n = len(run.joints.names)
    given = {
        f"{case}.{name}": getattr(values, name)
        for case, values in spec.CASES.items()
        for name in ("q_start", "q_target", "kp", "kv", "effort_limit")
    }
    given |= {f"limits: {name}": getattr(run.joints, name) for name in ("lower", "upper")}
    for name, values in given.items():
        if np.shape(values) != (n,) or not np.isfinite(values).all():
            yield f"{name} is not {n} finite values"
    unknown = set(run.joints.types) - (POSITION_UNIT.keys() & EFFORT_UNIT.keys())
    if unknown:
        yield f"no unit is known for joint types {sorted(unknown)}"


def target_limits(run: Experiment) -> Iterator[str]:
    """Every start and target lies within the model's limits."""
    lower, upper = run.joints.lower, run.joints.upper
    for case, name in product(spec.CASES, ("q_start", "q_target")):
        q = getattr(spec.CASES[case], name)
        outside = (q < lower - LIMIT_TOLERANCE) | (q > upper + LIMIT_TOLERANCE)
        for k in np.flatnonzero(outside):
            limits = f"[{lower[k]:g}, {upper[k]:g}]"
            yield f"{case}.{name}[{run.joints.names[k]}] = {q[k]:g} is outside {limits}"


def baseline_approaches(run: Experiment) -> Iterator[str]:
    """The baseline ends nearer to its target than it starts."""
    m = run.metrics["baseline"]
    if not m.final_error < m.initial_error:
        yield f"final error {m.final_error:g} rad is not below the initial {m.initial_error:g} rad"


def stamps(run: Experiment) -> Iterator[str]:
    """Each run has its configured steps, states at times k · dt from zero, and its own target."""
    yield from wrong_times(spec.CASES, run.traces)
    for name, case in spec.CASES.items():
        if not (run.traces[name].target == case.q_target).all():
            yield f"{name} was not commanded its target at every step"


def same_start(run: Experiment) -> Iterator[str]:
    """The compared cases start in the same state, at rest."""
    first = run.traces["G1"]
    for name in ("G1", "G2", "G3"):
        trace = run.traces[name]
        if (trace.q[0] != first.q[0]).any() or (trace.link_pos[0] != first.link_pos[0]).any():
            yield f"{name} starts elsewhere than G1"
        if not np.allclose(trace.q[0], spec.CASES[name].q_start, rtol=0, atol=LIMIT_TOLERANCE):
            yield f"{name} does not start at its case's q_start"
        if trace.start_qd.any():
            yield f"{name} starts with velocity {trace.start_qd.tolist()}"


def one_factor(run: Experiment) -> Iterator[str]:
    """G1 and G2 differ in the stepped joint's KP alone, G2 and G3 in its KV alone."""
    for (one, other), expected in spec.ONE_FACTOR.items():
        found = differences(spec.CASES[one], spec.CASES[other], run.joints)
        if found != expected:
            yield f"{one} → {other} changes {found}, expected {expected}"


def not_observed(run: Experiment) -> Iterator[str]:
    """A time is given exactly where the samples reach it, and `not observed` where they do not."""
    for name in spec.CASES:
        trace, m = run.traces[name], run.metrics[name]
        q = trace.q[:, spec.ENTRY].astype(np.float64)
        q_target = float(trace.target[0, spec.ENTRY])
        risen = q - q[0] >= RISE_FRACTION * (q_target - q[0])
        inside = np.abs(q - q_target) <= SETTLING_BAND
        for label, time, seen in (
            ("rise", m.rise_time, risen.any()),
            ("settling", m.settling_time, inside[-1]),
        ):
            if (time is not None) != seen:
                yield f"{name}: {label} time is {time}, the samples say observed={seen}"
        if m.rise_time is not None and risen[trace.t < m.rise_time].any():
            yield f"{name}: a sample before {m.rise_time:g} s had risen already"
        if m.settling_time is not None and not inside[trace.t >= m.settling_time].all():
            yield f"{name}: it leaves the band after {m.settling_time:g} s"


def control_law(run: Experiment) -> Iterator[str]:
    """Each control force is clip(KP (q_target − q) − KV q̇) with the gains of its own case."""
    for name, c in spec.CASES.items():
        trace = run.traces[name]
        limit = trace.effort_limit
        law = np.clip(c.kp * (c.q_target - trace.q[1:]) - c.kv * trace.qd, -limit, limit)  # (n, d)
        apart = float(np.abs(law - trace.control_force).max())
        if apart > CONTROL_LAW_TOLERANCE:
            yield f"{name}: control force differs by up to {apart:g} from its case's control law"


def measurements(run: Experiment) -> Iterator[str]:
    """Position, velocity and forces are finite, and no control force exceeds its limit."""
    for name in spec.CASES:
        trace = run.traces[name]
        # A trace refuses values that are not finite when it is made; its arrays may change later.
        for field in ("q", "qd", "control_force", "internal_force"):
            if not np.isfinite(getattr(trace, field)).all():
                yield f"{name}.{field} is not finite everywhere"
        excess = np.abs(trace.control_force) - trace.effort_limit
        if (excess > 1e-3).any():
            yield f"{name}: control force exceeds its limit by {excess.max():g}"


def saturation(run: Experiment) -> Iterator[str]:
    """The limit reads back as it was set, and saturated samples are counted against it."""
    for name, case in spec.CASES.items():
        trace, m = run.traces[name], run.metrics[name]
        if not np.allclose(trace.effort_limit, case.effort_limit, rtol=1e-6):
            yield f"{name}: limit reads back {trace.effort_limit.tolist()}"
        threshold = SATURATION_THRESHOLD * float(trace.effort_limit[spec.ENTRY])
        count = int((np.abs(trace.control_force[:, spec.ENTRY]).astype(float) >= threshold).sum())
        if (m.saturation_samples, m.saturation_duration) != (count, count * case.dt):
            yield f"{name}: {m.saturation_samples} samples reported, {count} counted"


def posture(run: Experiment) -> list[str]:
    """Two different camera frames, or a schematic whose links moved, show the end state."""
    return end_state.problems(run.rendered, run.frames, run.traces["baseline"].link_pos)


CHECKS = (
    mapping, configuration, target_limits, baseline_approaches, stamps, same_start, one_factor,
    control_law, not_observed, measurements, saturation, posture,
)  # fmt: skip
