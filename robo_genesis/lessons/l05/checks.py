"""Named checks of the kinematics of L05."""

from collections.abc import Callable

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
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.kinematics import ARM, CHAIN, HAND, Pose, measured_hand
from robo_genesis.sim.arm.laws import assigned_run, driven_run
from robo_genesis.sim.camera import checks as camera_checks
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.checks import Marker
from robo_genesis.sim.camera.record import SEGMENTS, view_of
from robo_genesis.sim.common_checks import posture, stamps, structure
from robo_genesis.sim.laws import kept
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

from . import spec, study
from .run import SolveCase, command_path

# The links of the chain among those of the arrays.
OF_CHAIN = slice(HAND - ARM, HAND + 1)


def mapping(run: Experiment) -> Findings:
    """The engine has the joints, limits and links that our forward kinematics uses."""
    yield from structure(run)
    chain = tuple(name for name, *_ in CHAIN)
    yield equal("links_of_the_chain", tuple(run.links[OF_CHAIN]), chain)
    for name, values in zip(("lower", "upper"), spec.ARM_LIMITS, strict=True):
        apart = np.abs(getattr(run.joints, name)[:ARM] - values).max()
        yield at_most(f"{name}_limits_against_the_model_file", apart, spec.SAME_POSE[1])


def acceptance(run: Experiment) -> Findings:
    """The residual of the commanded answer is within both tolerances, as the engine
    reports it and by forward kinematics of the command, and the fingertips are higher
    than the least clearance.
    """
    found, limits = run.readings[study.GROUP], spec.IK.tolerances
    m = run.metrics["baseline"]
    by_fk = (m.command_distance, m.command_angle)
    for unit, expected, most in zip(("m", "rad"), by_fk, limits, strict=True):
        name, left = f"residual_{unit}", found[f"residual_{unit}"]
        yield at_most(name, left, most)
        label = f"{name}_by_forward_kinematics"
        yield within(label, left, expected, spec.SAME_RESIDUAL)
    command = kinematics.hand_pose(run.traces["baseline"].target[-1])
    height = kinematics.fingertip(command)[2]
    yield above("fingertip_height_m", height, spec.IK.clearance)


def forward_kinematics(run: Experiment) -> Findings:
    """In every state of the reaches, our forward kinematics gives the engine's link
    poses within 5 µm and 5 µrad.
    """
    return same_links(run, kinematics.link_poses)


def second_engine(run: Experiment) -> Findings:
    """MuJoCo gives the same link poses in every state of the reaches, within 5 µm and 5 µrad."""
    links = run.links[OF_CHAIN]
    return same_links(run, lambda q: mujoco_kinematics.link_poses(q, links))


def jacobians_agree(run: Experiment) -> Findings:
    """The Jacobians of the engine, of MuJoCo and of central differences are ours within
    5 · 10⁻⁶, in three postures.
    """
    for name, q in study.jacobian_postures(run).items():
        found = (run.readings[study.JACOBIANS][name], *study.other_jacobians(q))
        for other, apart in zip(
            ("engine", "mujoco", "differences"), found, strict=True
        ):
            yield at_most(f"{name}.{other}", apart, spec.SAME_POSE[0])


def stretched_is_singular(run: Experiment) -> Findings:
    """Two singular values of the nearly stretched arm are below a third of all others."""
    values = [
        np.linalg.svd(kinematics.jacobian(q), compute_uv=False)
        for q in study.jacobian_postures(run).values()
    ]
    others = min(values[0].min(), values[1].min(), values[2][3])
    yield below("nearly_stretched", values[2][4], others / 3)


def same_links(run: Experiment, poses: Callable[[FloatArray], Pose]) -> Findings:
    """Compare the links of the chain in every state of the runs with another computation.

    Args:
        run: the experiment.
        poses: returns positions (n, 8, 3) [m] and orientations (n, 8, 4) at `q` (n, 9).
    """
    for name in run.metrics:
        trace = run.traces[name]
        position, quat = trace.link_pos[:, OF_CHAIN], trace.link_quat[:, OF_CHAIN]
        measured = Pose(position.astype(float), quat.astype(float))
        error = kinematics.pose_error(measured, poses(trace.q))
        apart, angle = kinematics.distances(error)
        yield at_most(f"{name}.links_apart_m", apart.max(), spec.SAME_POSE[0])
        yield at_most(f"{name}.links_apart_rad", angle.max(), spec.SAME_POSE[1])


def arrived(run: Experiment) -> Findings:
    """Each run ends within 2 cm and 0.05 rad of its target."""
    for name in spec.CASES:
        m = run.metrics[name]
        yield at_most(f"{name}.final_distance_m", m.final_distance, spec.REACHED[0])
        yield at_most(f"{name}.final_angle_rad", m.final_angle, spec.REACHED[1])


def sag_explains(run: Experiment) -> Findings:
    """Gravity, KP and the Jacobian explain the displacement from the command's pose to
    the last pose, except for at most 2 % of it, and the angle between them within 2 %.
    """
    for name in spec.CASES:
        *_, share, turn = study.sag_lengths(run, name)
        yield at_most(f"{name}.unexplained_share", share, spec.SAG_SHARE)
        found = run.metrics[name].tracking_angle
        yield nearly(f"{name}.angle_rad", found, turn, spec.SAG_SHARE)


def smaller_angles_explain_more(run: Experiment) -> Findings:
    """With KP doubled, gravity, KP and the Jacobian explain a larger share of the sag."""
    one, half = (study.sag_lengths(run, name)[2] for name in ("baseline", "kp_doubled"))
    yield below("unexplained_share_with_kp_doubled", half, one)


def kp_has_a_price(run: Experiment) -> Findings:
    """With KP doubled the hand swings past its target at least three times as far as
    before. With a ramp it is never farther past it than at the end, and its last place
    is within 1 mm of that without a ramp; no joint of the arm reaches its force limit.
    """
    base, doubled, ramp = (
        run.metrics[n] for n in ("baseline", "kp_doubled", "kp_doubled_ramp")
    )
    yield above("overshoot_with_kp_doubled_m", doubled.overshoot, 3 * base.overshoot)
    yield at_most("overshoot_with_a_ramp_m", ramp.overshoot, ramp.final_distance)
    trace = run.traces["kp_doubled_ramp"]
    places = (
        measured_hand(of, -1).position for of in (run.traces["kp_doubled"], trace)
    )
    apart = np.linalg.norm(np.subtract(*places))
    yield at_most("last_places_apart_with_a_ramp_m", apart, 1e-3)
    share = np.abs(trace.control_force / trace.effort_limit)[:, :ARM].max()
    yield below("largest_share_of_a_force_limit_with_a_ramp", share, 1.0)


def price_at_finer_step(run: Experiment) -> Findings:
    """With 20 substeps KP doubled swings at least twice as far as the baseline and less
    than half as far as with 2; with a ramp the hand is never farther past its target
    than at the end.
    """
    base, doubled, ramp = (run.metrics[name] for name in spec.FINER)
    yield above("overshoot_with_kp_doubled_m", doubled.overshoot, 2 * base.overshoot)
    coarse = run.metrics["kp_doubled"].overshoot
    yield below("overshoot_with_20_substeps_m", doubled.overshoot, coarse / 2)
    yield at_most("overshoot_with_a_ramp_m", ramp.overshoot, ramp.final_distance)


def limits_cause_the_swing(run: Experiment) -> Findings:
    """With ten times the force limits, the hand swings at most a tenth as far past its target."""
    free, limited = (
        run.metrics[name].overshoot for name in ("unlimited", "kp_doubled")
    )
    yield at_most("overshoot_m", free, limited / 10)


def solver_ignores_the_floor(run: Experiment) -> Findings:
    """The solver's answer for the low target is within both tolerances, and has the
    fingertips more than 5 cm below the ground.
    """
    found = run.readings[study.GROUP]
    for name, most in zip(
        ("residual_m", "residual_rad"), spec.IK.tolerances, strict=True
    ):
        yield at_most(f"low_{name}", found[f"low_{name}"], most)
    yield below("low_tip_m", found["low_tip_m"], -0.05)


def tolerance_costs_little(run: Experiment) -> Findings:
    """For a tolerance of 5 µm the solver needs at most two iterations more than for 0.5 mm."""
    needed = run.readings[study.ITERATIONS]
    yield at_most("iterations_more", needed["at_5_um"] - needed["at_500_um"], 2)
    yield at_most("residual_m", run.readings[study.PRECISE]["at_5_um"], 5e-6)


def repeatable(run: Experiment) -> Findings:
    """From the common start, without restarts, equal questions get equal answers: the
    runs with KP unchanged and doubled have equal commands.
    """
    first, second = (run.traces[name].target for name in ("baseline", "kp_doubled"))
    yield equal("entries_that_differ", (first != second).sum(), 0)


def first_start_fails(run: Experiment) -> Findings:
    """From the first of the random starts, the solver without restarts finds no answer."""
    yield equal("accepted", study.answers_of(run, "many_starts")["accepted"][0], False)


def restarts_rescue_few(run: Experiment) -> Findings:
    """With up to 50 starts, more targets of the vertical plane are accepted, and fewer
    than half of the refused ones.
    """
    one, many = (
        study.answers_of(run, name)["accepted"]
        for name in ("vertical", "vertical_restarted")
    )
    rescued = (many & ~one).sum()
    yield above("rescued", rescued, 0)
    yield below("rescued_of_the_refused", rescued, (~one).sum() / 2)


def map_has_targets_in_the_floor(run: Experiment) -> Findings:
    """The residual accepts targets of the vertical plane with the fingertips below the ground."""
    found = study.answers_of(run, "vertical")
    yield above("in_the_floor", found["accepted"] @ (found["tip"] < 0), 0)


def unreachable_refused(run: Experiment) -> Findings:
    """Beyond reach, all answers are refused for their residuals."""
    found = study.answers_of(run, "unreachable")
    yield above("residual_m", found["position"].min(), spec.IK.position_tolerance)
    yield equal("accepted", found["accepted"].sum(), 0)


def nearest_is_nearer(run: Experiment) -> Findings:
    """Another posture is nearer than each of the 20 answers, where 0.5 m counts as 1 rad."""
    found = study.answers_of(run, "unreachable")
    of_engine = study.weighted(found["position"], found["rotation"])
    of_nearest = study.weighted(*kinematics.distances(study.nearest()[1]))
    nearer = of_engine.min() - of_nearest
    yield above("nearest_answer_farther_by_m", nearer, spec.BEYOND_NEAREST)


def marker(run: Experiment) -> Marker:
    """Return the sphere at the target as the camera must see it."""
    return Marker(
        int(run.readings[SEGMENTS]["marker"]), spec.TARGET, spec.MARKER_RADIUS
    )


def camera_matrix(run: Experiment) -> Findings:
    """Matrix, pose and limits of each camera are those that it was given."""
    for name in (view for view in spec.VIEWS if f"view_{view}" in run.readings):
        yield from camera_checks.camera_matrix(
            name, view_of(run, name), spec.VIEWS[name]
        )


def projection(run: Experiment) -> Findings:
    """The centroid of the marker is within 0.15 pixels of the silhouette's centre."""
    view, trace = view_of(run, spec.VIEWED), run.traces["baseline"]
    yield from camera_checks.projection(spec.VIEWED, view, marker(run))
    ends = (
        kinematics.hand_pose(trace.target[-1]).position,
        measured_hand(trace, -1).position,
    )
    pixels = cameras.project(np.array(ends), view.intrinsics, view.transform)
    yield noted(f"{spec.VIEWED}.sag_px", np.linalg.norm(pixels[1] - pixels[0]))


def sphere_surface(run: Experiment) -> Findings:
    """Each pixel of the marker, back-projected, is within 0.6 % of the radius of its surface."""
    return camera_checks.sphere_surface(
        spec.VIEWED, view_of(run, spec.VIEWED), marker(run)
    )


def plane_surface(run: Experiment) -> Findings:
    """Each ground pixel within 3 m, back-projected, is within 0.1 mm of height 0."""
    number = int(run.readings[SEGMENTS]["plane"])
    yield from camera_checks.plane_surface(
        spec.VIEWED, view_of(run, spec.VIEWED), number
    )
    if "view_hand" in run.readings:  # the camera on the hand has a page of its own
        yield from camera_checks.plane_surface("hand", view_of(run, "hand"), number)


def mounted_camera(run: Experiment) -> Findings:
    """The camera on the hand is at the pose of the hand times the offset."""
    hand, offset = measured_hand(run.traces["baseline"], -1), np.array(spec.ON_HAND)
    return camera_checks.mounted_camera("hand", view_of(run, "hand"), *hand, offset)


def laws_of_motion(run: Experiment) -> Findings:
    """At each sample links and control forces are those of the driven or assigned robot."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            laws = assigned_run(trace, run.links, case.start.model)
        else:
            command = command_path(case, trace.target[-1])
            laws = driven_run(trace, case.commanding(command), run.links)
        yield from kept(name, laws)


# Checks of every page that has the runs of the lab.
WITHOUT_CAMERA = (
    mapping,
    stamps,
    acceptance,
    forward_kinematics,
    second_engine,
    arrived,
    sag_explains,
    smaller_angles_explain_more,
    kp_has_a_price,
    solver_ignores_the_floor,
    tolerance_costs_little,
    repeatable,
    laws_of_motion,
)

VIEW = (camera_matrix, projection, sphere_surface, plane_surface)
CHECKS = (*WITHOUT_CAMERA, posture, *VIEW)
CAMERAS = (mapping, *VIEW, mounted_camera, laws_of_motion)
LECTURE = (*CHECKS, price_at_finer_step, limits_cause_the_swing)
JACOBIAN = (
    mapping,
    stamps,
    forward_kinematics,
    jacobians_agree,
    stretched_is_singular,
    laws_of_motion,
)

# Checks of the page about many solutions, beyond those of the lab.
SOLUTIONS = (
    first_start_fails,
    restarts_rescue_few,
    map_has_targets_in_the_floor,
    unreachable_refused,
    nearest_is_nearer,
)
