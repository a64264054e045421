"""Table scenes without Genesis: arms by MuJoCo's mechanics, bodies that are moved by hand."""

from dataclasses import replace

import numpy as np
import pytest
from robot_runs import LINKS, answer, assigned, driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l07 import metrics, rungs, spec, table_map
from robo_genesis.lessons.l07.pages import LECTURE
from robo_genesis.sim.arm import kinematics, lifting
from robo_genesis.sim.arm.kinematics import HAND
from robo_genesis.sim.bodies import table
from robo_genesis.sim.camera import geometry, record
from robo_genesis.sim.camera.views import View

UPRIGHT, TILTED = np.float32([[1, 0, 0, 0], [1, 0.05, 0, 0]])


def trace_of(name: str, case: table.SceneCase) -> Trace:
    """Return a run whose object keeps its place, sinks in a little, or follows the closed hand."""
    if isinstance(case, table_map.MapCase):
        answers = [answer(target, spec.GOOD.q_start, 20).q for target in case.targets]
        before = driven(spec.GOOD.commanding(spec.GOOD.q_start), LINKS)
        return table_map.with_bodies(
            assigned(case.start, LINKS, before, np.stack(answers))
        )
    lifts = metrics.lifts(case)
    command = case.q_start
    if lifts:
        points = lifting.waypoints(case.place, case.size[2])
        answers = [answer(point, case.q_start, 50) for point in points]
        command = lifting.lift_command(case.q_start, answers)
    arm = driven(case.commanding(command), LINKS)
    body = np.tile(case.centre, (case.steps + 1, 1))
    if lifts and name != "wide":
        held = slice(lifting.ENDS["close"], None)
        body[held, 2] += arm.link_pos[held, HAND, 2] - arm.link_pos[held, HAND, 2][0]
    if not lifts and not case.weightless:
        body[1:, 2] -= 14e-6
    ball = np.tile([*case.bowl_at, table.BALL_HEIGHT], (case.steps + 1, 1))
    ball[1:, 2] = 0.06 if case.bowl == "one_hull" else 0.013
    bodies = np.stack([body, ball], axis=1)
    quat = np.tile(TILTED if name in spec.FURTHER else UPRIGHT, (case.steps + 1, 2, 1))
    return replace(
        arm,
        link_pos=np.concatenate([arm.link_pos, np.float32(bodies)], axis=1),
        link_quat=np.concatenate([arm.link_quat, quat], axis=1),
    )


def wrist_pose() -> np.ndarray:
    """Return the pose of the camera on the hand at home."""
    hand, pose = kinematics.hand_pose(spec.GOOD.q_start), np.eye(4)
    pose[:3, :3] = np.stack(
        [kinematics.rotate(hand.quat, axis) for axis in np.eye(3)], axis=1
    )
    pose[:3, 3] = hand.position
    return pose @ np.array(table.ON_HAND)


def readings() -> dict[str, dict[str, float]]:
    """Return what the engine would report of the lecture's scenes."""
    usual = {
        **dict.fromkeys(("margin", "pregrasp", "over"), 0.136),
        **dict.fromkeys(("carried", "share", "rise"), 1.0),
        **{
            "grasp": 0.036,
            "accepted": 3,
            "fingers": 2,
            "world": 1300.0,
            "wrist": 1700.0,
        },
    }
    wrong = {"hovering_carried": 0.0, "filled_ball": 0.06, "wide_descending": 50}
    usual |= {"pixels": 1300.0, "ball": 0.0044} | wrong
    found = {
        group: {
            name: usual.get(name, usual.get(name.split("_", 1)[-1], 0))
            for name in of.units
        }
        for group, of in LECTURE.groups(rendered=True).items()
    }
    found["contacts"] = dict.fromkeys(found["contacts"], 3)
    for name, (_, quantity) in spec.ATTACKS.items():
        rung = rungs.rung_of(quantity) if quantity else None
        found["attacks"][name] = rungs.NUMBERS.index(rung)
        if quantity:
            found["caught"][name] = spec.LIMITS[quantity][0] - 1
    for name, field, pose in (
        ("world", 42.0, geometry.looking(spec.VIEW["pos"], spec.VIEW["lookat"])),
        ("wrist", 60.0, wrist_pose()),
    ):
        size = spec.VIEW["res"]
        view = View(geometry.intrinsics(field, size), pose, size, (0.01, 20.0))
        found[f"view_{name}"] = record.numbers(view)
    found["fails"] = {"hovering": 2, "filled": 1, "wide": 5}
    return found | {"model": spec.EXPECTED_MODEL}


@pytest.fixture(scope="session")
def scenes(joints) -> Experiment:
    """A run of the lecture, without a camera, that passes its checks."""
    runs = {name: of.case for name, of in LECTURE.runs.items()}
    traces, found = (
        {name: trace_of(name, case) for name, case in runs.items()},
        readings(),
    )
    apart, angle, _ = table_map.residuals(traces["table"])
    good = ((apart <= 5e-4) & (angle <= 5e-3)).reshape(-1, 2).sum(axis=1).tolist()
    for name in table_map.COUNTED:
        found[f"table_{name}"] = {str(cell): count for cell, count in enumerate(good)}
    made = Experiment(
        page=LECTURE,
        traces=traces,
        links=[*LINKS, "object", "ball"],
        readings=found,
        frames={},
        rendered=False,
        joints=joints,
    )
    found["map"] = table_map.totals(made)
    return made
