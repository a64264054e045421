"""Mistakes made on purpose with poses, answers of a solver, and cameras.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l05.metrics import reach_metrics
from robo_genesis.lessons.l05.run import ReachCase, ask, command_path, control_case
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.engine_kinematics import END_EFFECTOR, IkAnswer, link_poses_at
from robo_genesis.sim.arm.joint_control import reset, run_case, validate
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.views import read_intrinsics, read_transform

MEASURES = False


def written(answer: IkAnswer, case: ReachCase) -> str:
    """Return whether an answer is accepted, with its residual."""
    apart, angle = kinematics.distances(answer.error)
    verdict = "refused" if refused(lambda: control_case(case, answer)) else "accepted"
    return f"{verdict} with a residual of {1000 * apart:.2f} mm and {1000 * angle:.2f} mrad"


def swapped_quaternion(robot: Any, joints: JointMap, case: ReachCase) -> Mistake:
    """Give the orientation as (x, y, z, w)."""
    wrong = replace(case, quat=np.roll(case.quat, -1))  # the mistake
    answer = ask(robot, joints, wrong)
    fingers = kinematics.rotate(kinematics.hand_pose(answer.q).quat, np.array([0.0, 0.0, 1.0]))
    shown = bool(fingers[2] > 0.9 and not refused(lambda: control_case(wrong, answer)))
    text = (
        f"The answer is {written(answer, wrong)}. At the answer the axis from the hand to the "
        f"fingers has the vertical component {fingers[2]:+.3f}; down is −1."
    )
    return Mistake("swapped_quaternion", shown, text)


def other_frame(robot: Any, joints: JointMap, case: ReachCase, base: FloatArray) -> Mistake:
    """Give a target in the frame of a base that is at `base` (3,) in the world [m]."""
    answer = ask(robot, joints, case)  # the mistake: the solver expects a pose in the world
    (reached,), _ = link_poses_at(robot, joints, [END_EFFECTOR], answer.q)
    apart = float(np.linalg.norm(reached - (case.position + base)))
    shown = bool(not refused(lambda: control_case(case, answer)) and apart > 0.1)
    text = (
        f"The answer is {written(answer, case)}. The hand would be {1000 * apart:.1f} mm from "
        f"the intended place; the base is {1000 * np.linalg.norm(base):.1f} mm from the "
        "world's origin."
    )
    return Mistake("other_frame", shown, text)


def unaccepted_answer(scene: Any, robot: Any, joints: JointMap, case: ReachCase) -> Mistake:
    """Command an answer that the acceptance rule refuses."""
    answer = ask(robot, joints, case)
    trace = run_case(scene, robot, joints, case.commanding(answer.q.astype(float)))  # the mistake
    apart = np.linalg.norm(kinematics.hand_pose(trace.q).position - case.position, axis=-1)
    behind = np.abs(trace.q[-1] - trace.target[-1])[: kinematics.ARM].max()
    shown = bool(refused(lambda: control_case(case, answer)) and apart[-1] > 1 and behind < 0.05)
    text = (
        f"The answer is {written(answer, case)}. Commanded anyway, each joint ends within "
        f"{1000 * behind:.1f} mrad of its command. The hand starts {apart[0]:.2f} m from its "
        f"target and ends {apart[-1]:.2f} m from it."
    )
    curves = {"hand to target": (trace.t, apart)}
    return Mistake("unaccepted_answer", shown, text, curves, "distance [m]")


def in_the_floor(
    scene: Any, robot: Any, joints: JointMap, cases: Mapping[str, ReachCase]
) -> Mistake:
    """Command answers within both tolerances, whatever the height of their fingertips.

    The symptom is that the first two hands end far from their targets, and the last one does not.
    """
    text, left = "", []
    for name, case in cases.items():
        answer = ask(robot, joints, case)
        path = command_path(case, answer.q.astype(float))
        trace = run_case(scene, robot, joints, case.commanding(path))  # the mistake: no clearance
        m, tip = reach_metrics(trace, case), kinematics.fingertip(kinematics.hand_pose(answer.q))[2]
        force = np.linalg.norm(to_numpy(robot.get_contacts()["force_a"]).sum(axis=0))
        text += (
            f"{name}: the residual is {1000 * m.command_distance:.3f} mm, and the answer has the "
            f"fingertips at a height of {1000 * tip:.0f} mm. The hand ends "
            f"{1000 * m.final_distance:.0f} mm from its target, where contacts push with "
            f"{force:.0f} N. "
        )
        left.append(m.final_distance)
    return Mistake("in_the_floor", bool(min(left[:2]) > 0.04 and left[2] < 0.01), text.strip())


def degrees(scene: Any, robot: Any, joints: JointMap, case: ReachCase) -> Mistake:
    """Command an accepted answer, converted to degrees."""
    right = control_case(case, ask(robot, joints, case))
    wrong = replace(right, q_target=np.rad2deg(right.q_target))
    refusal, dofs = refused(lambda: validate(wrong, joints)), joints.dofs_idx_local.tolist()
    reset(scene, robot, joints, right)
    robot.control_dofs_position(wrong.q_target, dofs)  # the mistake: not validated
    for _ in range(case.steps):
        scene.step()
    q = to_numpy(robot.get_dofs_position(dofs))
    at_limit = np.minimum(np.abs(q - joints.lower), np.abs(q - joints.upper)) < 0.01
    apart = np.linalg.norm(kinematics.hand_pose(q).position - case.position)
    shown = bool(refusal and at_limit[: kinematics.ARM].any() and apart > 0.1)
    text = (
        f"The engine raised no exception. {at_limit[: kinematics.ARM].sum()} of the arm's joints "
        f"end at a limit, and the hand ends {1000 * apart:.0f} mm from its target. "
        f"The course's validation before a run: {quoted(refusal)}"
    )
    return Mistake("degrees", shown, text)


def rows_first(meant: Any, given: Any, point: FloatArray) -> Mistake:
    """Give `res` as (H, W): two cameras of one pose, the second with the mistake."""
    K, other = read_intrinsics(meant), read_intrinsics(given)
    shapes = [tuple(map(int, camera.res[::-1])) for camera in (meant, given)]
    fields = [np.degrees(2 * np.arctan(k[0, 2] / k[0, 0])) for k in (K, other)]
    pose = read_transform(meant)
    apart = np.linalg.norm(cameras.project(point, K, pose) - cameras.project(point, other, pose))
    shown = bool(shapes[0] == shapes[1][::-1] and apart > 10)
    text = (
        f"This `res` gives arrays of shape {shapes[1]} instead of {shapes[0]}, and the horizontal "
        f"field of view is {fields[1]:.1f}° instead of {fields[0]:.1f}°. With the camera matrix of "
        f"the intended picture, the target is expected {apart:.0f} pixels from its place."
    )
    return Mistake("rows_first", shown, text)


def stale_extrinsics(camera: Any, moved_to: Mapping[str, Any], point: FloatArray) -> Mistake:
    """Keep the extrinsics of a camera that has moved since."""
    kept = to_numpy(camera.extrinsics).astype(float).copy()
    camera.set_pose(**moved_to)
    pose, again, K = read_transform(camera), to_numpy(camera.extrinsics), read_intrinsics(camera)
    old = cameras.other_axes(np.linalg.inv(kept))
    apart = np.linalg.norm(cameras.project(point, K, old) - cameras.project(point, K, pose))
    now = "still that matrix" if (again == kept).all() else "the matrix of the new pose"
    text = (
        f"With the matrix read before the move, the target is expected {apart:.0f} pixels from its "
        f"place in the picture. Read again after the move, `camera.extrinsics` is {now}."
    )
    return Mistake("stale_extrinsics", bool(apart > 10), text)


def beyond_far(depth: FloatArray | None, camera: Any) -> Mistake:
    """Back-project every depth (H, W) [m] that is smaller than `far`, None without pictures."""
    if depth is None:
        return Mistake("beyond_far", True, "SKIP: this run has no camera.")
    heights = cameras.back_project(depth, read_intrinsics(camera), read_transform(camera))[..., 2]
    nothing = depth > 0.999 * camera.far
    kept = nothing & (depth < camera.far)  # the mistake: depths are rounded
    shown = bool(nothing.sum() > 1000 and heights[nothing].max() > 1)
    text = (
        f"{nothing.sum()} of {depth.size} pixels show no surface. Their depth is "
        f"{depth[nothing].min():.6f} m with `far` at {camera.far:g} m; `depth < far` keeps "
        f"{kept.sum()} of them. Back-projected, they are up to {heights[nothing].max():.1f} m "
        "above the floor."
    )
    return Mistake("beyond_far", shown, text)
