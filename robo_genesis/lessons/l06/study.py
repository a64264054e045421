"""What L06 reads beside its runs, and how it compares two of them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment, Readings, counts
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.batch import set_link_mass
from robo_genesis.sim.arm.engine_kinematics import END_EFFECTOR, IkAnswer
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.arm.joints import JointMap, resolve_joints, to_numpy

from . import spec
from .run import ask, reach, reset_some, start

# Counts, residuals and verdicts of a question with a target beyond reach, and masses of
# hands.
READINGS = {
    "model": counts(spec.EXPECTED_MODEL),
    "mixed": Readings({f"row_{k}_m": "m" for k in spec.ENVS}),
    "mixed_accepted": counts(spec.WORLDS),
    "hand_mass": Readings(dict.fromkeys(spec.VARIANTS, "kg")),
}

EQUALITY = "equality"
READ = ("pressed_permuted", "pressed_again", "pressed_alone", "one_start", "restarts")

# Of two runs: numbers that are compared, how many differ, largest difference of an arm
# joint.
COMPARED = {"compared": "1", "differ": "1", "apart": "rad"}

# When contact forces of the pressed hands are read: around a partial reset, and a step
# later.
WHEN = ("before", "after", "next")

# Rounding decides how far runs in contact separate, so that another run need not repeat
# it. Comparisons without arrays, and of each robot of the sweep two distances from the
# target.
LECTURE_READINGS = {
    EQUALITY: Readings(
        {f"{claim}_{what}": unit for claim in READ for what, unit in COMPARED.items()}
        | {"pressed_height": "m"}
        | {f"force_{k}_{when}": "N" for when in WHEN for k in spec.LATER}
        | {f"joints_{k}_changed": "1" for k in spec.LATER},
        "performance",
    ),
    "sweep_end": Readings(dict.fromkeys(spec.SWEEP.values(), "m")),
    "sweep_overshoot": Readings(dict.fromkeys(spec.SWEEP.values(), "m")),
}


def named(
    names: Iterable[str], values: Iterable[Any], kind: Callable[[Any], Any] = float
) -> dict[str, Any]:
    """Return readings by name, each as a number of Python."""
    return dict(zip(names, map(kind, values), strict=True))


def read_mixed(page: Any, robot: Any) -> IkAnswer:
    """Ask a question with a target beyond reach; give a page its residuals and verdicts."""
    world = replace(spec.FIRST, settings=spec.ONE_START)
    worlds = [replace(world, positions=target[None]) for target in spec.MIXED]
    answer = ask(robot, page.joints, worlds)
    apart, _ = kinematics.distances(answer.error)
    verdicts = kinematics.accepted(answer.q, answer.error, *spec.ONE_START.tolerances)
    page.readings["mixed"] = named(READINGS["mixed"].units, apart)
    page.readings["mixed_accepted"] = named(spec.WORLDS, verdicts, int)
    return answer


def residual(position: FloatArray, joints: JointMap) -> float:
    """Return the distance that our damped least squares leaves from a target of `spec.MIXED` [m].

    It has the settings of the engine's solver, and ends where that does.
    """
    settings, target = spec.ONE_START, kinematics.Pose(position, spec.DOWN)
    q, limits = spec.FIRST.q_start[:7], (joints.lower[:7], joints.upper[:7])
    for _ in range(settings.iterations):
        error = kinematics.pose_error(target, kinematics.hand_pose(q))
        if kinematics.accepted(q, error, *settings.tolerances):
            break
        step = kinematics.damped_step(kinematics.jacobian(q), error, settings.damping)
        most = settings.largest_step
        q = np.clip(q + np.clip(step, -most, most), *limits)
    return kinematics.distance_and_angle(target, kinematics.hand_pose(q))[0]


def record(page: Any, scene: Any, robot: Any, camera: Any) -> None:
    """Record the four environments, with a frame before the first step and after the last."""
    worlds = list(spec.WORLDS.values())
    start(scene, robot, page.joints, worlds)
    page.capture(camera, "initial")
    runs = reach(scene, robot, page.joints, worlds)
    page.traces |= dict(zip(spec.WORLDS, runs, strict=True))
    page.capture(camera, "final")


def record_alone(page: Any, scene: Any, robot: Any) -> None:
    """Record each world in a scene without environments."""
    for name, world in spec.ALONE.items():
        (page.traces[name],) = reach(
            scene, robot, resolve_joints(robot, JOINT_NAMES), [world]
        )


def record_copies(page: Any, scene: Any, robot: Any) -> None:
    """Record the permuted batch, and the batch of which some environments are reset."""
    worlds = [spec.WORLDS[f"env_{k}"] for k in spec.ENVS]
    rows = reach(scene, robot, page.joints, [worlds[k] for k in spec.ORDER])
    page.traces |= {f"permuted_{k}": rows[spec.ORDER.index(k)] for k in spec.ENVS}
    envs = list(spec.LATER)
    *_, batch = reset_some(scene, robot, page.joints, worlds, envs, spec.RESET_AFTER)
    page.traces |= {
        f"{'again' if k in envs else 'beside'}_{k}": batch.trace(k) for k in spec.ENVS
    }


def record_variants(page: Any, scene: Any, robot: Any) -> None:
    """Record four robots with one target, own gains and own loads; take the loads off again."""
    worlds = list(spec.VARIANTS.values())
    loaded = [row for row, world in enumerate(worlds) if world.load]
    heavy = np.array([spec.HAND_MASS + worlds[row].load for row in loaded])
    masses = set_link_mass(robot, END_EFFECTOR, heavy, loaded)
    page.readings["hand_mass"] = named(spec.VARIANTS, masses)
    runs = reach(scene, robot, page.joints, worlds)
    page.traces |= dict(zip(spec.VARIANTS, runs, strict=True))
    set_link_mass(robot, END_EFFECTOR, np.full(len(loaded), spec.HAND_MASS), loaded)


def read_equality(page: Any, scene: Any, robot: Any, alone: Any, single: Any) -> None:
    """Give a page the comparisons of `READ`: hands pressed on the floor, and equal questions."""
    worlds, joints = list(spec.PRESSED.values()), resolve_joints(single, JOINT_NAMES)
    rows: list[Trace] = []
    forces, torques, envs = [], [], list(spec.LATER)
    for batch in reset_some(scene, robot, page.joints, worlds, envs, spec.STEPS):
        rows = rows or [batch.trace(k) for k in spec.ENVS]
        each_link = to_numpy(robot.get_links_net_contact_force())
        forces.append(np.linalg.norm(each_link, axis=2).max(axis=1)[envs])
        torques.append(to_numpy(robot.get_dofs_force())[envs])
    again = [(rows[k], batch.trace(k)) for k in envs]
    changed = (torques[1] != torques[0]).sum(axis=1)
    ordered = reach(scene, robot, page.joints, [worlds[k] for k in spec.ORDER])
    permuted = [(rows[k], ordered[j]) for j, k in enumerate(spec.ORDER)]
    each = [(rows[k], reach(alone, single, joints, [worlds[k]])[0]) for k in spec.ENVS]
    values = [*compared(permuted), *compared(again), *compared(each)]
    for settings in (spec.ONE_START, spec.IK):
        question = replace(spec.FIRST, positions=spec.RESTARTED, settings=settings)
        q = ask(robot, page.joints, [question] * len(spec.ENVS)).q
        apart = np.abs(q[1:] - q[0])
        values += [apart.size, int(np.count_nonzero(apart)), float(apart.max())]
    height = min(row.link_pos[-1, kinematics.HAND, 2] for row in rows)
    values += [float(height), *np.ravel(forces[:-1]).tolist(), *changed.tolist()]
    page.readings[EQUALITY] = named(LECTURE_READINGS[EQUALITY].units, values)


def compared(pairs: Sequence[tuple[Trace, Trace]]) -> list[float]:
    """Return the values of `COMPARED` for some pairs of runs."""
    differ, numbers = np.sum([entries_that_differ(*pair) for pair in pairs], axis=0)
    arm = slice(kinematics.ARM)
    apart = max(largest_differences(*pair, arm)["q"] for pair in pairs)
    return [int(numbers), int(differ), apart]


def shared(one: Trace, other: Trace, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return an array of two runs, each cut to the samples that both have."""
    a, b = getattr(one, name), getattr(other, name)
    n = min(len(a), len(b))
    return a[:n], b[:n]


def entries_that_differ(one: Trace, other: Trace) -> tuple[int, int]:
    """Return how many entries differ in the samples that two runs share, and how many these are."""
    names = (field.name for field in fields(Trace) if field.name != "t")
    both = [shared(one, other, name) for name in names]
    return sum(int((a != b).sum()) for a, b in both), sum(a.size for a, _ in both)


def largest_differences(
    one: Trace, other: Trace, joints: slice = slice(None)
) -> dict[str, float]:
    """Return the largest difference of each array of `spec.SAME_RUN` in the samples of two runs.

    `joints` are those of the nine that are compared.

    Returns:
        By array, the difference: of joints of the arm in rad, rad/s and N·m, of fingers
            in m, m/s
        and N.
    """
    found = {}
    for name in spec.SAME_RUN:
        apart = np.subtract(*shared(one, other, name), dtype=np.float64)
        found[name] = float(np.abs(apart[:, joints]).max())
    return found


def pairs() -> Mapping[str, Sequence[tuple[str, str]]]:
    """Return by claim the pairs of runs that are compared; all but `alone` must be equal."""
    groups = {
        "permuted": spec.PERMUTED,
        "beside": spec.BESIDE,
        "again": spec.AGAIN,
        "plain": ("plain_robot",),
        "alone": spec.ALONE,
    }
    worlds = {"plain_robot": "env_0"}
    return {
        claim: [(name, worlds.get(name, f"env_{name[-1]}")) for name in names]
        for claim, names in groups.items()
    }


def compared_runs(run: Experiment, claim: str) -> list[float]:
    """Return the values of `COMPARED` for the pairs of a claim."""
    return compared([(run.traces[a], run.traces[b]) for a, b in pairs()[claim]])
