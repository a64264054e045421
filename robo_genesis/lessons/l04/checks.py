"""Named checks of a step experiment."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Check, evaluate, wrong_times
from robo_genesis.core.scene import JOINT_NAMES
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.metrics import (
    RISE_FRACTION,
    SATURATION_THRESHOLD,
    SETTLING_BAND,
    StepMetrics,
)  # fmt: skip
from robo_genesis.sim import end_state
from robo_genesis.sim.joint_control import LIMIT_TOLERANCE, ControlCase, differences
from robo_genesis.sim.joints import EFFORT_UNIT, POSITION_UNIT, JointMap

CONTROL_LAW_TOLERANCE = 1e-2
"""Room for float32 in KP times a position error [N·m or N]."""


@dataclass(frozen=True, slots=True)
class StepExperiment:
    """Everything that the checks of lesson L04 read.

    `model` counts links, joints, dofs and qpos as the engine reports them. `end_state` is `camera`
    or `schematic`: camera `frames` show the baseline's ends, or a drawing of measured links does.
    """

    joints: JointMap
    model: Mapping[str, int]
    cases: Mapping[str, ControlCase]
    traces: Mapping[str, Trace]
    metrics: Mapping[str, StepMetrics]
    end_state: str
    frames: Mapping[str, np.ndarray]

    @property
    def entry(self) -> int:
        """Column of the stepped joint."""
        return self.joints.entry(spec.STEPPED_JOINT)


def mapping(run: StepExperiment) -> list[str]:
    """Seven arm joints and two finger joints are found by name, each with its own DOF."""
    found = (
        ("the model has", dict(run.model), spec.EXPECTED_MODEL),
        ("names are", run.joints.names, JOINT_NAMES),
        ("types are", run.joints.types, spec.EXPECTED_TYPES),
    )
    problems = [f"{what} {a}, expected {b}" for what, a, b in found if a != b]
    for what, indices in (("dofs", run.joints.dofs_idx_local), ("qpos", run.joints.qs_idx_local)):
        if len(set(indices)) != len(JOINT_NAMES) or not set(indices) <= set(range(run.model[what])):
            problems.append(
                f"local {what} are {indices.tolist()}, expected nine distinct ones below "
                f"{run.model[what]}"
            )
    return problems


def configuration(run: StepExperiment) -> list[str]:
    """Start, target, gains and limits have one finite value per joint; joint types have units."""
    n = len(run.joints.names)
    problems = [
        f"{case}.{name} is not {n} finite values"
        for case, values in run.cases.items()
        for name in ("q_start", "q_target", "kp", "kv", "effort_limit")
        if np.shape(getattr(values, name)) != (n,) or not np.isfinite(getattr(values, name)).all()
    ]
    problems += [
        f"limits: {name} is not {n} finite values"
        for name in ("lower", "upper")
        if (values := getattr(run.joints, name)).shape != (n,) or not np.isfinite(values).all()
    ]
    unknown = set(run.joints.types) - (POSITION_UNIT.keys() & EFFORT_UNIT.keys())
    if unknown:
        problems.append(f"no unit is known for joint types {sorted(unknown)}")
    return problems


def target_limits(run: StepExperiment) -> list[str]:
    """Every start and target lies within the model's limits."""
    return [
        f"{case}.{name}[{run.joints.names[k]}] = {getattr(values, name)[k]:g} is outside "
        f"[{run.joints.lower[k]:g}, {run.joints.upper[k]:g}]"
        for case, values in run.cases.items()
        for name in ("q_start", "q_target")
        for k in np.flatnonzero(
            (getattr(values, name) < run.joints.lower - LIMIT_TOLERANCE)
            | (getattr(values, name) > run.joints.upper + LIMIT_TOLERANCE)
        )
    ]


def baseline_approaches(run: StepExperiment) -> list[str]:
    """The baseline ends nearer to its target than it starts."""
    m = run.metrics["baseline"]
    if m.final_error < m.initial_error:
        return []
    return [f"final error {m.final_error:g} rad is not below the initial {m.initial_error:g} rad"]


def stamps(run: StepExperiment) -> list[str]:
    """Each run has its configured steps, states at times k · dt from zero, and its own target."""
    return wrong_times(run.cases, run.traces) + [
        f"{name} was not commanded its target at every step"
        for name, case in run.cases.items()
        if not (run.traces[name].target == case.q_target).all()
    ]


def same_start(run: StepExperiment) -> list[str]:
    """The compared cases start in the same state, at rest."""
    problems = []
    first = run.traces["G1"]
    for name in ("G1", "G2", "G3"):
        trace = run.traces[name]
        if (trace.q[0] != first.q[0]).any() or (trace.link_pos[0] != first.link_pos[0]).any():
            problems.append(f"{name} starts elsewhere than G1")
        if not np.allclose(trace.q[0], run.cases[name].q_start, rtol=0, atol=LIMIT_TOLERANCE):
            problems.append(f"{name} does not start at its case's q_start")
        if trace.start_qd.any():
            problems.append(f"{name} starts with velocity {trace.start_qd.tolist()}")
    return problems


def one_factor(run: StepExperiment) -> list[str]:
    """G1 and G2 differ in the stepped joint's KP alone, G2 and G3 in its KV alone."""
    return [
        f"{one} → {other} changes {found}, expected {expected}"
        for (one, other), expected in spec.ONE_FACTOR.items()
        for found in [differences(run.cases[one], run.cases[other], run.joints)]
        if found != expected
    ]


def not_observed(run: StepExperiment) -> list[str]:
    """A time is given exactly where the samples reach it, and `not observed` where they do not."""
    problems = []
    for name, m in run.metrics.items():
        trace = run.traces[name]
        q = trace.q[:, run.entry].astype(np.float64)
        q_target = float(trace.target[0, run.entry])
        risen = q - q[0] >= RISE_FRACTION * (q_target - q[0])
        inside = np.abs(q - q_target) <= SETTLING_BAND
        for label, time, seen in (
            ("rise", m.rise_time, risen.any()),
            ("settling", m.settling_time, inside[-1]),
        ):
            if (time is not None) != seen:
                problems.append(f"{name}: {label} time is {time}, the samples say observed={seen}")
        if m.rise_time is not None and risen[trace.t < m.rise_time].any():
            problems.append(f"{name}: a sample before {m.rise_time:g} s had risen already")
        if m.settling_time is not None and not inside[trace.t >= m.settling_time].all():
            problems.append(f"{name}: it leaves the band after {m.settling_time:g} s")
    return problems


def control_law(run: StepExperiment) -> list[str]:
    """Each control force is clip(KP (q_target − q) − KV q̇) with the gains of its own case."""
    problems = []
    for name, c in run.cases.items():
        trace = run.traces[name]
        limit = trace.effort_limit
        law = np.clip(c.kp * (c.q_target - trace.q[1:]) - c.kv * trace.qd, -limit, limit)  # (n, d)
        apart = float(np.abs(law - trace.control_force).max())
        if apart > CONTROL_LAW_TOLERANCE:
            problems.append(
                f"{name}: control force differs by up to {apart:g} from its case's control law"
            )
    return problems


def measurements(run: StepExperiment) -> list[str]:
    """Position, velocity and forces are finite, and no control force exceeds its limit."""
    problems = []
    for name, trace in run.traces.items():
        # A trace refuses values that are not finite when it is made; its arrays may change later.
        problems += [
            f"{name}.{field} is not finite everywhere"
            for field in ("q", "qd", "control_force", "internal_force")
            if not np.isfinite(getattr(trace, field)).all()
        ]
        excess = np.abs(trace.control_force) - trace.effort_limit
        if (excess > 1e-3).any():
            problems.append(f"{name}: control force exceeds its limit by {excess.max():g}")
    return problems


def saturation(run: StepExperiment) -> list[str]:
    """The limit reads back as it was set, and saturated samples are counted against it."""
    problems = []
    for name, case in run.cases.items():
        trace, m = run.traces[name], run.metrics[name]
        if not np.allclose(trace.effort_limit, case.effort_limit, rtol=1e-6):
            problems.append(f"{name}: limit reads back {trace.effort_limit.tolist()}")
        threshold = SATURATION_THRESHOLD * float(trace.effort_limit[run.entry])
        count = int((np.abs(trace.control_force[:, run.entry]).astype(float) >= threshold).sum())
        if (m.saturation_samples, m.saturation_duration) != (count, count * case.dt):
            problems.append(f"{name}: {m.saturation_samples} samples reported, {count} counted")
    return problems


def posture(run: StepExperiment) -> list[str]:
    """Two different camera frames, or a schematic whose links moved, show the end state."""
    return end_state.problems(run.end_state, run.frames, run.traces["baseline"].link_pos)


CHECKS: tuple[Callable[[StepExperiment], list[str]], ...] = (
    mapping, configuration, target_limits, baseline_approaches, stamps, same_start, one_factor,
    control_law, not_observed, measurements, saturation, posture,
)  # fmt: skip


def run_checks(run: StepExperiment) -> tuple[Check, ...]:
    """Run every check on an experiment."""
    return evaluate(CHECKS, run)
