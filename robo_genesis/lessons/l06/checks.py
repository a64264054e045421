"""Named checks of L06."""

from collections.abc import Mapping

import numpy as np

from robo_genesis.core.check_spec import MASS_SHARE
from robo_genesis.core.checks import (
    Findings,
    above,
    at_most,
    below,
    equal,
    nearly,
    within,
)
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.kinematics import ARM, Pose, distance_and_angle, hand_pose
from robo_genesis.sim.arm.laws import driven_run
from robo_genesis.sim.common_checks import posture, stamps, structure
from robo_genesis.sim.laws import each_run
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

from . import spec, study, throughput


def mapping(run: Experiment) -> Findings:
    """The engine has the expected links, joints and DOFs."""
    return structure(run)


def acceptance_per_row(run: Experiment) -> Findings:
    """By forward kinematics, each command of the runs with metrics is within both
    tolerances and 5 µm and 5 µrad of rounding. The rule refuses the target beyond
    reach, and no other.
    """
    most, angle_most = spec.IK.tolerances
    for name, world in spec.CASES.items():
        for number, position in enumerate(world.positions):
            q = run.traces[name].target[-number]  # the first command, or the last
            apart, angle = distance_and_angle(Pose(position, world.quat), hand_pose(q))
            label = f"{name}.target_{number}.residual"
            yield at_most(f"{label}_m", apart, most + spec.SAME_POSE[0])
            yield at_most(f"{label}_rad", angle, angle_most + spec.SAME_POSE[1])
    for k, (name, residual) in enumerate(run.readings["mixed"].items()):
        expected = study.residual(spec.MIXED[k], run.joints)
        # A float32 has seven digits.
        room = spec.SAME_RESIDUAL * max(1.0, 4 * expected)
        yield within(f"mixed.{name}", residual, expected, room)
        accepted = run.readings["mixed_accepted"][f"env_{k}"]
        yield equal(f"mixed.row_{k}_accepted", accepted, k != spec.REFUSED)
    start = hand_pose(spec.FIRST.q_start).position
    nearer = float(np.linalg.norm(spec.BEYOND_REACH - start))
    refused = run.readings["mixed"][f"row_{spec.REFUSED}_m"]
    yield above("mixed.residual_of_the_refused_row_m", refused, nearer)


def arrived(run: Experiment) -> Findings:
    """Each hand is within 2 cm of its first and last target, and ends within 0.05 rad."""
    for name in spec.CASES:
        m = run.metrics[name]
        yield at_most(f"{name}.first_distance_m", m.first_distance, spec.REACHED[0])
        yield at_most(f"{name}.final_distance_m", m.final_distance, spec.REACHED[0])
        yield at_most(f"{name}.final_angle_rad", m.final_angle, spec.REACHED[1])


def row_equals_alone(run: Experiment) -> Findings:
    """Each row of the batch and the same run alone have commands, positions, velocities
    and control forces within the declared bounds of each other.
    """
    for k in spec.ENVS:
        row, alone = run.traces[f"env_{k}"], run.traces[f"alone_{k}"]
        differ = np.abs(row.target - alone.target).max()
        yield at_most(f"env_{k}.command", differ, spec.SAME_RUN["q"])
        for name, found in study.largest_differences(row, alone).items():
            yield at_most(f"env_{k}.{name}", found, spec.SAME_RUN[name])


def same_to_the_last_bit(run: Experiment, claim: str) -> Findings:
    """Require equal entries in the samples that two runs share."""
    for one, other in study.pairs()[claim]:
        differ, _ = study.entries_that_differ(run.traces[one], run.traces[other])
        yield equal(f"{one}.entries_that_differ_from_{other}", differ, 0)


def permuted_rows(run: Experiment) -> Findings:
    """With the worlds in another order, each gives the same arrays to the last bit."""
    return same_to_the_last_bit(run, "permuted")


def untouched_keep_their_state(run: Experiment) -> Findings:
    """Environments that are not named keep their hand in place while others get a
    second command. While others are reset and commanded in mid-motion, they give the
    same arrays to the last bit.
    """
    yield from same_to_the_last_bit(run, "beside")
    for name, world in spec.WORLDS.items():
        moved = run.metrics[name].moved_later
        if len(world.positions) > 1:
            yield above(f"{name}.moved_later_m", moved, spec.RESOLUTION["m"])
        else:
            yield at_most(f"{name}.moved_later_m", moved, spec.RESOLUTION["m"])


def none_differ(run: Experiment, comparison: str) -> Findings:
    """Require of a comparison without arrays that it had entries, and that none differs."""
    found = run.readings[study.EQUALITY]
    yield above(f"{comparison}.compared", found[f"{comparison}_compared"], 0)
    yield equal(f"{comparison}.differ", found[f"{comparison}_differ"], 0)


def pressed_on_the_floor(run: Experiment) -> Findings:
    """With the hands kept above their targets by the floor, rows in another order and
    rows after a partial reset are equal to the last bit.
    """
    for comparison in ("pressed_permuted", "pressed_again"):
        yield from none_differ(run, comparison)
    height = run.readings[study.EQUALITY]["pressed_height"]
    yield above("lowest_hand_m", height, 0.07)


def old_forces_after_a_reset(run: Experiment) -> Findings:
    """After a partial reset of hands that press on the floor with more than 50 N, the
    engine returns their old contact forces, or zero as newer versions do. One step
    later they are zero. Forces of the joints are the old ones until that step.
    """
    found = run.readings[study.EQUALITY]
    for k in spec.LATER:
        before, after, later = (found[f"force_{k}_{when}"] for when in study.WHEN)
        yield above(f"row_{k}.force_before_N", before, 50.0)
        neither = min(after, abs(after - before))
        yield equal(f"row_{k}.neither_old_nor_zero_N", neither, 0.0)
        yield equal(f"row_{k}.force_one_step_later_N", later, 0.0)
        changed = found[f"joints_{k}_changed"]
        yield equal(f"row_{k}.joint_forces_that_changed", changed, 0)


def answers_depend_on_the_row(run: Experiment) -> Findings:
    """In one call with one start, equal questions have answers that are equal to the
    last bit. With random starts, two of their answers differ by more than 10 mrad.
    """
    yield from none_differ(run, "one_start")
    apart = run.readings[study.EQUALITY]["restarts_apart"]
    yield above("largest_difference_with_restarts_rad", apart, 0.01)


def sweep_repeats_the_runs(run: Experiment) -> Findings:
    """The robots of the sweep that are also recorded end there and pass the target as
    recorded, to 0.01 mm.
    """
    for name, robot in spec.SWEPT.items():
        m, room = run.metrics[name], spec.RESOLUTION["m"]
        end, passed = (sweep[spec.SWEEP[robot]] for sweep in swept(run))
        yield within(f"{name}.final_distance_m", end, m.final_distance, room)
        yield within(f"{name}.overshoot_m", passed, m.overshoot, room)


def swept(run: Experiment) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """Return by robot of the sweep the distance at the end and the overshoot [m]."""
    return run.readings["sweep_end"], run.readings["sweep_overshoot"]


def price_of_stiffness(run: Experiment) -> Findings:
    """With KV unchanged and any load, KP doubled lowers the distance at the end to a
    share between 0.45 and 0.55, and raises the overshoot by more than 20 mm. With 20
    times the limits of the torques, the stiff robot passes its target by less than a
    tenth as far.
    """
    m = run.metrics
    share = m["unlimited_robot"].overshoot / m["stiff_robot"].overshoot
    yield below("share_of_the_overshoot_without_limits", share, 0.1)
    ends, passed = swept(run)
    for load in spec.LOADS:
        plain, stiff = (spec.SWEEP[kp, 1.0, load] for kp in (1.0, 2.0))
        share, added = ends[stiff] / ends[plain], passed[stiff] - passed[plain]
        yield within(f"load_{load:g}.share_of_the_distance", share, 0.5, 0.05)
        yield above(f"load_{load:g}.added_overshoot_m", added, 0.02)


def stiffest_fail(run: Experiment) -> Findings:
    """Without a load, no robot with KP × 8 or × 16 ends within 5 mm of the target and
    passes it by less than 5 mm.
    """
    for (kp, kv, load), name in spec.SWEEP.items():
        if kp >= 8 and load == 0:
            worst = max(sweep[name] for sweep in swept(run))
            yield above(f"kp_{kp:g}_kv_{kv:g}.worse_of_both_m", worst, 5e-3)


def partial_reset(run: Experiment) -> Findings:
    """After a reset in mid-motion, an environment repeats its first run to the last bit."""
    return same_to_the_last_bit(run, "again")


def own_gains_and_mass(run: Experiment) -> Findings:
    """The row without changes equals its run beside equal neighbours to the last bit.
    Each hand has its own mass. At rest each torque equals the gravity torque of the arm
    with its load, and KP times the position error, within 0.05 N·m.
    """
    yield from same_to_the_last_bit(run, "plain")
    for name, world in spec.VARIANTS.items():
        trace, mass = run.traces[name], spec.HAND_MASS + world.load
        found = run.readings["hand_mass"][name]
        yield nearly(f"{name}.hand_mass_kg", found, mass, MASS_SHARE)
        q = trace.q[-1].astype(float)
        gravity = mujoco_kinematics.gravity_effort(q, world.load)
        torques = {"gravity": gravity, "kp": world.kp * (trace.target[-1] - q)}
        for law, torque in torques.items():
            apart = np.abs(trace.control_force[-1] - torque)[:ARM].max()
            yield at_most(f"{name}.torque_not_explained_by_{law}_N_m", apart, spec.HELD)


def equal_work(run: Experiment) -> Findings:
    """In each batch of the table, all arms end near the commanded angles, with joint
    positions that are equal to the last bit in all environments.
    """
    for size, differ in run.readings[throughput.EQUAL].items():
        yield equal(f"{size}_environments.that_missed_the_motion_or_differ", differ, 0)


def laws_of_motion(run: Experiment) -> Findings:
    """At each sample links and control forces are those of its own robot."""
    return each_run(
        run, lambda of, world: driven_run(of, world.commanding(of.target), run.links)
    )


WITHOUT_CAMERA = (
    mapping,
    stamps,
    acceptance_per_row,
    arrived,
    row_equals_alone,
    permuted_rows,
    untouched_keep_their_state,
    partial_reset,
    own_gains_and_mass,
    laws_of_motion,
)
CHECKS = (*WITHOUT_CAMERA, posture)
LECTURE = (
    pressed_on_the_floor,
    old_forces_after_a_reset,
    answers_depend_on_the_row,
    sweep_repeats_the_runs,
    price_of_stiffness,
    stiffest_fail,
)
