"""What L05 computes from its runs and answers: sag, Jacobians, families of solutions, nearest."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment, Readings
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import engine_kinematics as engine
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.joint_control import reset
from robo_genesis.sim.arm.joints import JointMap
from robo_genesis.sim.arm.kinematics import ARM, Pose, measured_hand
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

from . import spec
from .run import ReachCase, SolveCase, ask

# Groups of a bundle's metrics: what the engine's solver reported, also for smaller
# tolerances.
GROUP, PRECISE, ITERATIONS = "ik", "ik_residuals", "iterations"

# Residuals of the answers for the target and for one in the floor, with the height of
# the fingertips there; the residual for each tolerance, and the iterations to it.
READINGS = {
    GROUP: Readings(
        {
            "residual_m": "m",
            "residual_rad": "rad",
            "low_residual_m": "m",
            "low_residual_rad": "rad",
            "low_tip_m": "m",
        }
    ),
    PRECISE: Readings(dict.fromkeys(spec.PRECISE, "m")),
    ITERATIONS: Readings(dict.fromkeys(spec.PRECISE, "iterations"), "exact"),
}


def read(page: Any, scene: Any, robot: Any, joints: JointMap) -> None:
    """Give a page what the solver reports of the lesson's questions; this resets the scene."""
    reset(scene, robot, joints, spec.BASELINE.commanding(spec.BASELINE.q_start))
    first, low = (
        ask(robot, joints, case) for case in (spec.BASELINE, spec.IN_THE_FLOOR)
    )
    tip = spec.IN_THE_FLOOR.position[2] - low.error[2] - kinematics.TIP
    values = (*kinematics.distances(first.error), *kinematics.distances(low.error), tip)
    units = READINGS[GROUP].units
    page.readings[GROUP] = dict(zip(units, map(float, values), strict=True))
    page.readings |= {ITERATIONS: {}, PRECISE: {}}
    for name, case in spec.PRECISE.items():
        needed, left = iterations(robot, joints, case)
        page.readings[ITERATIONS][name] = needed
        page.readings[PRECISE][name] = left


def iterations(robot: Any, joints: JointMap, case: ReachCase) -> tuple[int, float]:
    """Return the fewest iterations after which an answer is accepted, and its residual [m].

    Without such an answer the number is that of the settings, and the residual is too
    large.
    """
    for n in range(1, case.settings.iterations + 1):
        fewer = replace(case, settings=replace(case.settings, iterations=n))
        answer = ask(robot, joints, fewer)
        if kinematics.accepted(answer.q, answer.error, *case.settings.tolerances):
            break
    return n, float(kinematics.distances(answer.error)[0])


JACOBIANS, POSTURES = "jacobians", ("start", "answer", "nearly_stretched")
STEP = 1e-4  # Angle of the central differences [rad]


def jacobian_postures(of: Any) -> dict[str, FloatArray]:
    """Return the joint positions (9,) in which a page compares Jacobians [rad or m]."""
    run = of.traces["baseline"]
    stretched = np.append(spec.NEARLY_STRETCHED, spec.BASELINE.q_start[ARM:])
    return dict(zip(POSTURES, (run.q[0], run.target[-1], stretched), strict=True))


def read_jacobians(page: Any, robot: Any, joints: JointMap) -> None:
    """Give a page the largest differences of the engine's Jacobian and ours; it assigns states."""
    found = {}
    for name, q in jacobian_postures(page).items():
        robot.set_dofs_position(q.copy(), joints.dofs, zero_velocity=True)
        rows = engine.jacobian(robot, joints)[:, :ARM]
        found[name] = float(np.abs(rows - kinematics.jacobian(q)).max())
    page.readings[JACOBIANS] = found


def other_jacobians(q: FloatArray) -> tuple[float, float]:
    """Return how far MuJoCo's Jacobian and central differences are from ours, their largest entry.

    Args:
        q: (9,) joint positions [rad or m].
    """
    ours = kinematics.jacobian(q)
    ahead, behind = (
        kinematics.hand_pose(q[:ARM] + s * STEP * np.eye(ARM)) for s in (1, -1)
    )
    quotients = kinematics.pose_error(ahead, behind).T / (2 * STEP)
    others = mujoco_kinematics.jacobian(q)[:, :ARM], quotients
    mujoco, differences = (float(np.abs(of - ours).max()) for of in others)
    return mujoco, differences


def sag(q: FloatArray, kp: FloatArray) -> FloatArray:
    """Return the motion (6,) of the hand [m and rad] by which gravity moves it from command `q`.

    Each joint stops where KP times its position error equals gravity, so it rests
    gravity / KP below its command. The Jacobian turns these small angles into a motion
    of the hand.

    Args:
        q: (9,) command [rad or m].
        kp: (9,) position gains [N·m/rad or N/m].
    """
    angles = (mujoco_kinematics.gravity_effort(q) / kp)[:ARM]
    return -kinematics.jacobian(q) @ angles


def sag_lengths(run: Experiment, name: str) -> tuple[float, float, float, float]:
    """Return the lengths of the measured motion from command to end and of the expected one [m].

    The third number is the length of their difference as a share of the expected one,
    the fourth the expected rotation [rad].
    """
    trace = run.traces[name]
    command = trace.target[-1].astype(float)
    found = measured_hand(trace, -1).position - kinematics.hand_pose(command).position
    expected, turn = np.split(sag(command, run.cases[name].kp), 2)
    ways = (found, expected, found - expected, turn)
    measured, computed, apart, turned = (float(np.linalg.norm(way)) for way in ways)
    return measured, computed, apart / computed, turned


def answers(trace: Trace, case: SolveCase) -> dict[str, np.ndarray]:
    """Return what is known of each answer, from the measured poses of the hand.

    Returns:
        Arrays (m,): `position` [m] and `rotation` [rad] residual, `accepted` by them,
        `tip`, the height of the fingertips [m], `manipulability`, `margin` of the joint
        that is nearest to a limit [rad], and `from_start`, the largest angle between
        answer and start of the run [rad].
    """
    measured = measured_hand(trace, slice(1, None))
    error = kinematics.pose_error(Pose(case.positions, case.quat), measured)
    q = trace.q[1:].astype(np.float64)
    apart, angle = kinematics.distances(error)
    accepted = kinematics.accepted(q, error, *case.settings.tolerances)
    tip = kinematics.fingertip(measured)[:, 2]
    found = {"position": apart, "rotation": angle, "accepted": accepted, "tip": tip}
    return found | {
        "manipulability": kinematics.manipulability(kinematics.jacobian(q)),
        "margin": kinematics.limit_margin(q[:, :ARM], *spec.ARM_LIMITS),
        "from_start": np.abs(q - trace.q[0])[:, :ARM].max(axis=1),
    }


def answers_of(run: Experiment, name: str) -> dict[str, np.ndarray]:
    """Return what is known of the answers of a run."""
    return answers(run.traces[name], spec.QUESTIONS[name])


GOAL = Pose(spec.TARGET, spec.DOWN)
STRIDE = 0.05  # Distance of neighbours on the curve of a self-motion [rad]


def self_motion(q: FloatArray) -> FloatArray:
    """Return postures (n, 7) [rad] that keep the hand at the target, on the curve through `q` (7,).

    Seven joints meet six conditions, so a solution is a point of a curve. From `q` the
    curve is followed along the null vector of the Jacobian in both directions, up to a
    joint limit.
    """
    there, back = (one_way(q, sign * null_vector(q)) for sign in (1, -1))
    return np.array([*back[::-1], q, *there])


def one_way(q: FloatArray, along: FloatArray) -> list[FloatArray]:
    """Return the postures beyond `q` in direction `along` (7,); see `self_motion`."""
    way: list[FloatArray] = []
    while len(way) < LONGEST_CURVE:
        q = q + STRIDE * along
        error = kinematics.pose_error(GOAL, kinematics.hand_pose(q))
        q = q + kinematics.damped_step(kinematics.jacobian(q), error, 1e-4)
        if kinematics.limit_margin(q, *spec.ARM_LIMITS) < 0:
            break
        way.append(q)
        null = null_vector(q)
        along = null if null @ along > 0 else -null
    return way


LONGEST_CURVE = 400  # Most postures of a self-motion in one direction


def null_vector(q: FloatArray) -> FloatArray:
    """Return the direction (7,) of joint angles that leaves the hand at rest, of length 1."""
    return np.linalg.svd(kinematics.jacobian(q))[2][-1]


def families(solutions: FloatArray) -> list[tuple[FloatArray, list[int]]]:
    """Group solutions that a self-motion connects without moving the hand.

    Args:
        solutions: (n, 7) accepted answers for the target [rad].

    Returns:
        The curve (m, 7) of each family and the indices of its solutions, the largest
        family first.
    """
    left, found = list(range(len(solutions))), []
    while left:
        curve = self_motion(solutions[left[0]])
        gaps = np.linalg.norm(solutions[left][:, None] - curve, axis=-1).min(axis=1)
        inside = [n for n, gap in zip(left, gaps, strict=True) if gap <= SAME_CURVE]
        found.append((curve, inside))
        left = [n for n in left if n not in inside]
    return sorted(found, key=lambda family: -len(family[1]))


# Two steps along the curve, of which one may be missing at a joint limit.
SAME_CURVE = 0.1  # A solution within this distance of a curve belongs to it [rad]


def solution_families(run: Experiment) -> list[tuple[FloatArray, list[int]]]:
    """Return the curve (m, 7) of each family of answers for the target [rad], the largest first.

    With it are the numbers of its answers, from 0, in the order of joint 1.
    """
    numbers = np.flatnonzero(answers_of(run, "many_starts")["accepted"])
    q = run.traces["many_starts"].q[1 + numbers, :ARM].astype(float)
    return [
        (curve, numbers[sorted(inside, key=lambda k: q[k, 0])].tolist())
        for curve, inside in families(q)
    ]


def weighted(apart: FloatArray, angle: FloatArray) -> FloatArray:
    """Return one distance (…) [m] of distances (…) [m] and angles (…) [rad] from a target."""
    return np.hypot(apart, spec.ANGLE_WEIGHT * angle)


@cache
def nearest() -> tuple[FloatArray, FloatArray]:
    """Return posture (7,) [rad] and pose error (6,) nearest to the target beyond reach.

    The nearest has the smallest `weighted` distance that SciPy's bounded least squares
    reaches from eight of the random starts.
    """
    from scipy.optimize import least_squares

    target = Pose(spec.BEYOND_REACH, spec.DOWN)

    def error(q: FloatArray) -> FloatArray:
        return kinematics.pose_error(target, kinematics.hand_pose(q))

    def left(q: FloatArray) -> FloatArray:
        return error(q) * np.repeat([1.0, spec.ANGLE_WEIGHT], 3)

    searches = (
        least_squares(left, start, bounds=spec.ARM_LIMITS, ftol=1e-6)
        for start in spec.RANDOM_STARTS[:8, :ARM]
    )
    near = min(searches, key=lambda search: search.cost).x
    # Rounding decides where such a search stops. On each processor, the last one ends
    # at one value.
    fine = dict.fromkeys(("ftol", "xtol", "gtol"), 1e-14)
    best = least_squares(left, near, bounds=spec.ARM_LIMITS, **fine).x
    return best, error(best)
