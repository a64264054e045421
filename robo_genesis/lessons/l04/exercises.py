"""Checks of the functions that a student writes: four in L04's lab, one beside the formula.

See `core/exercises.py`.
"""

from collections.abc import Iterable
from functools import partial
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np

from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import Written, as_test, compared, refused, same_array
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.joint_control import ControlCase
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.arm.laws import LAW

from .metrics import StepMetrics
from .spec import ENTRY
from .theory import IdealJoint, stepped_joint

MEASURES = False

TINY = 1e-6  # Largest difference of a returned time or angle that rounding explains

# Arguments of `stepped` in the order of its signature.
INVENTED = {
    "not_clipped": (1.1, 3500.0, 100.0, 1.0, np.inf, 0.0, 0.005, 0.005, 80),
    "clipped_with_gravity": (1.1, 7000.0, 100.0, 1.0, 87.0, 22.0, 0.25, 0.005, 80),
    "much_passive_damping": (0.4, 900.0, 10.0, 30.0, 12.0, -3.0, -0.2, 0.002, 80),
}

RESPONSE = ("rise_time", "overshoot", "settling_time")


@as_test
def resolver(resolve: Written, robot: Any, joints: JointMap) -> Findings:
    """Check `resolve(robot, names)`: local DOFs in the order of the names, odd joints refused."""
    names = list(joints.names)
    yield equal("dofs", list(resolve(robot, names)), joints.dofs)
    backwards = joints.dofs[::-1]
    yield equal("dofs_in_reverse", list(resolve(robot, names[::-1])), backwards)
    shifted = SimpleNamespace(get_joint=lambda name: _joint(5 + names.index(name)))
    expected = [5 + n for n in range(len(names))]
    yield equal("dofs_of_a_shifted_robot", list(resolve(shifted, names)), expected)
    odd = {"ball": _joint(0, 1, 2), "one DOF, two qpos": _joint(0, qpos=2)}
    for label, joint in odd.items():
        one = SimpleNamespace(get_joint={"wrist": joint}.__getitem__)
        error = refused(partial(resolve, one, ["wrist"]))
        named = isinstance(error, ValueError) and "wrist" in str(error)
        yield equal(f"value_error_names_the_joint ({label})", named, True)
    twice = refused(lambda: resolve(robot, [names[3], names[3]]))
    yield equal("value_error_for_one_joint_twice", isinstance(twice, ValueError), True)


def _joint(*dofs: int, qpos: int | None = None) -> SimpleNamespace:
    """Return a joint with these local DOFs, and other solver-level ones."""
    count = len(dofs)
    return SimpleNamespace(
        n_dofs=count,
        n_qs=qpos or count + (count > 1),
        dofs_idx_local=list(dofs),
        dofs_idx=[dof + 7 for dof in dofs],
        qs_idx_local=list(dofs),
    )


@as_test
def control_loop(
    record: Written,
    scene: Any,
    robot: Any,
    joints: JointMap,
    case: ControlCase,
    trace: Trace,
) -> Findings:
    """Check `record(scene, robot, dofs, q_target, steps)` against a run of the same case.

    Call it after a reset to the case. The function returns t (n+1,), q (n+1, d), qd (n,
    d) and the control force (n, d).
    """
    dofs, name = joints.dofs, "control_dofs_position"
    with patch.object(robot, name, wraps=getattr(robot, name)) as command:
        found = list(record(scene, robot, dofs, case.q_target, case.steps))
    yield equal("number_of_commands", command.call_count, case.steps)
    expected = trace.t, trace.q, trace.qd, trace.control_force
    for name, values, right in zip(
        ("t", "q", "qd", "force"), found, expected, strict=True
    ):
        yield from same_array(f"{name}_against_the_recorded_run", values, right, TINY)


@as_test
def pd_law(law: Written, traces: Iterable[tuple[Trace, ControlCase]]) -> Findings:
    """Check `law(error, qd, kp, kv, limit)` with every recorded control force of joint4."""
    for number, (trace, case) in enumerate(traces):
        error, qd, force = case.q_target - trace.q[1:], trace.qd, trace.control_force
        constant = [float(of[ENTRY]) for of in (case.kp, case.kv, trace.effort_limit)]
        found = [
            law(e, v, *constant)
            for e, v in zip(error[:, ENTRY], qd[:, ENTRY], strict=True)
        ]
        label = f"run_{number}.control_force"
        yield from same_array(label, found, force[:, ENTRY], LAW)
    for sign in (1.0, -1.0):
        clipped = law(sign, 0.0, 1e3, 0.0, 87.0)
        yield equal(f"demand_of_{1e3 * sign:g}_with_limit_87", clipped, 87.0 * sign)


@as_test
def step_response(
    measure: Written, runs: Iterable[tuple[Trace, StepMetrics]]
) -> Findings:
    """Check `measure(t, q, q_target)`: rise time, overshoot, settling time; None if not observed.

    The runs are measured ones; two invented responses never rise, and leave the band at
    the end.
    """
    for number, (trace, of) in enumerate(runs):
        q, target = trace.q[:, ENTRY].astype(float), float(trace.target[0, ENTRY])
        expected = of.rise_time, of.overshoot, of.settling_time
        yield from compared(
            f"run_{number}", RESPONSE, measure(trace.t, q, target), expected, TINY
        )
    for name, q, expected in (
        ("never_rises", np.linspace(0.0, 0.1, 6), (None, 0.0, None)),
        ("leaves_at_the_end", np.array([0.0, *[0.25] * 4, 0.30]), (0.01, 0.05, None)),
    ):
        found = measure(np.arange(6) * 0.01, q, 0.25)
        yield from compared(name, RESPONSE, found, expected, TINY)


@as_test
def stepped(model: Written) -> Findings:
    """Check `model(inertia, kp, kv, d, limit, g, step, h, n)`: n + 1 positions [rad]."""
    for name, arguments in INVENTED.items():
        inertia, kp, kv, d, limit, g, step, h, n = arguments
        joint = IdealJoint(inertia, kv + d, kp)
        expected = stepped_joint(joint, d, step, h, n, limit=limit, gravity=g)
        found = np.ravel(model(*arguments))
        yield from same_array(name, found, expected, TINY)
