"""What the pages of L07 record of their scenes, one after the other."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, counts
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics, lifting
from robo_genesis.sim.arm.franka import MODEL_COUNTS
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import JointMap, describe, to_numpy
from robo_genesis.sim.bodies import table
from robo_genesis.sim.camera import record
from robo_genesis.sim.camera.views import View, look, segment_number

from . import rungs, spec
from .metrics import BALL, OBJECT, scene_metrics

# Units of the readings of a scene, by group and name.
GROUPS = {
    "object": {"mass": "kg", "depth": "m"},
    "outline": dict.fromkeys(rungs.CAMERAS, "pixels"),
    "reach": {
        "accepted": "poses",
        "pregrasp": "m",
        "grasp": "m",
        "touches": "postures",
    },
    "contacts": {"descending": "steps"} | dict.fromkeys(rungs.FINGERS, "points"),
}


def group(name: str, *scenes: str) -> Readings:
    """Return a group of readings of scenes, named by scene and reading."""
    units = GROUPS[name].items()
    return Readings(
        {f"{scene}_{what}": unit for scene in scenes for what, unit in units}
    )


def readings(*scenes: str) -> dict[str, Readings]:
    """Return the groups of readings of a page with these scenes."""
    found = {name: group(name, *scenes) for name in GROUPS}
    others = {"fails": counts(scenes[1:])} if scenes[1:] else {}
    return found | {"model": counts(MODEL_COUNTS)} | others


def note(page: Any, group: str, scene: str, **values: float) -> None:
    """Add readings of a scene to a group of a page."""
    more = {f"{scene}_{name}": value for name, value in values.items()}
    page.readings.setdefault(group, {}).update(more)


def let_rest(
    world: table.World, joints: JointMap, case: table.SceneCase
) -> tuple[Trace, float]:
    """Let the scene rest while the robot holds its start.

    Returns:
        The run, and the depth of the object's deepest contact after the first step [m].
    """
    depths: list[float] = []

    def after(step: int) -> None:
        contacts = world.body.get_contacts()
        depths.append(float(to_numpy(contacts["penetration"]).max(initial=0)))

    held = case.commanding(case.q_start)
    bodies = (world.body, world.ball)
    trace = run_case(world.scene, world.robot, joints, held, bodies, after=after)
    return trace, depths[0]


def lift(
    world: table.World, joints: JointMap, case: table.SceneCase
) -> tuple[Trace, dict[str, int]]:
    """Lift the object from the place of a lift; return run and counts of `contact_counter`."""
    points = lifting.waypoints(case.place, case.size[2])
    answers = lifting.ask(world.robot, joints, case.q_start, spec.ONE_START, points)
    command = case.commanding(lifting.lift_command(case.q_start, answers))
    counts, after = lifting.contact_counter(world.robot, world.body)
    trace = run_case(
        world.scene,
        world.robot,
        joints,
        command,
        (world.body, world.ball),
        lambda: world.body.set_pos(case.centre),
        after,
    )
    return trace, counts


@dataclass(frozen=True, slots=True)
class Facts:
    """What one scene showed, before anything is judged.

    | field | meaning |
    |---|---|
    | `case`, `world` | its settings, and the built scene |
    | `rest`, `lift` | both runs |
    | `views` | by camera |
    | `number` | of the object in the segmentations |
    | `residuals` | (2, 6) of the solver's answers: translation [m] and rotation vector [rad] |
    | `tips` | heights (2,) of the fingertips at the answers, above the table [m] |
    | `touches` | contacts of the robot at each posture on its way to the answers |
    | `readings` | by group |
    """

    case: table.SceneCase
    world: table.World
    rest: Trace
    lift: Trace
    views: dict[str, View]
    number: int
    residuals: FloatArray
    tips: FloatArray
    touches: np.ndarray
    readings: dict[str, dict[str, float]]

    @property
    def positions(self) -> FloatArray:
        """Centre (n + 1, 3) of the object at rest [m]."""
        return self.rest.link_pos[:, OBJECT].astype(np.float64)

    @property
    def outlines(self) -> dict[str, float]:
        """Area of the object's outline in each view [pixel]."""
        return self.readings["outline"]

    @property
    def segmentations(self) -> dict[str, np.ndarray]:
        """Segmentation (H, W) of each camera, none without pictures."""
        found = {name: view.segmentation for name, view in self.views.items()}
        return {name: picture for name, picture in found.items() if picture is not None}

    @property
    def values(self) -> dict[str, dict[str, float]]:
        """The values that decide about the scene, by rung."""
        lift = spec.lift_of(self.case)
        metrics = scene_metrics(self.rest, self.case), scene_metrics(self.lift, lift)
        return rungs.values(
            self.case, metrics, self.rest.link_pos[-1, BALL], self.readings
        )


def approach(
    world: table.World, joints: JointMap, case: table.SceneCase
) -> tuple[FloatArray, FloatArray, np.ndarray, int]:
    """Ask for pregrasp and grasp, and assign postures on the way to the answers.

    Returns:
        Residuals, heights of the fingertips and contacts as in `Facts`, and how many
        answers are accepted.
    """
    points = lifting.waypoints(case.place, case.size[2])[:2]
    answers = lifting.ask(world.robot, joints, case.q_start, spec.ONE_START, points)
    residuals = np.array([answer.error for answer in answers], dtype=float)
    tips = [kinematics.fingertip(kinematics.hand_pose(a.q))[2] for a in answers]
    within = spec.ONE_START.tolerances
    accepted = sum(int(kinematics.accepted(a.q, a.error, *within)) for a in answers)
    way = lifting.line([case.q_start, *(answer.q for answer in answers)])
    touches = [lifting.touches(world.robot, joints, world.fixed, q) for q in way]
    return residuals, np.array(tips), np.array(touches), accepted


def facts(page: Any, gs: Any, case: table.SceneCase) -> Facts:
    """Build a scene, give a page its robot, and return what the scene shows."""
    world = table.build(gs, case, spec.VIEW, spec.WRIST)
    joints = describe(page, world.robot)
    page.links = [*page.links, "object", "ball"]
    rest, depth = let_rest(world, joints, case)
    world.cameras["wrist"].move_to_attach()
    views = {name: look(camera, page.render) for name, camera in world.cameras.items()}
    corners = case.corners(rest.link_pos[-1, OBJECT])
    residuals, tips, touches, accepted = approach(world, joints, case)
    lifted, contacts = lift(world, joints, spec.lift_of(case))
    reach = accepted, *tips.tolist(), int((touches > 0).sum())
    readings: dict[str, dict[str, float]] = {
        "object": {"mass": float(world.body.get_mass()), "depth": depth},
        "outline": {name: rungs.outline(corners, of) for name, of in views.items()},
        "reach": dict(zip(GROUPS["reach"], reach, strict=True)),
        "contacts": {**contacts},
    }
    number = 0
    if page.render:
        number = segment_number(world.scene, world.body.links[0])
        readings["pixels"] = {
            name: float(np.sum(view.segmentation == number))
            for name, view in views.items()
        }
    return Facts(
        case, world, rest, lifted, views, number, residuals, tips, touches, readings
    )


def keep(page: Any, scene: str, found: Facts) -> None:
    """Give a page what a scene of the specification showed, of the good one its views as well."""
    page.traces |= {f"{scene}_at_rest": found.rest, scene: found.lift}
    for group, of in found.readings.items():
        note(page, group, scene, **of)
    if scene == "baseline":
        for name, view in found.views.items():
            page.readings[f"view_{name}"] = record.numbers(view)
            page.frames |= record.frames(name, view)


def examine(page: Any, gs: Any, scene: str) -> table.World:
    """Build a scene and give a page everything that its rungs measure; return the scene."""
    found = facts(page, gs, spec.SCENES[scene])
    keep(page, scene, found)
    return found.world


def record_forced(page: Any, gs: Any) -> None:
    """Give a page the lifts of the slippery box, at two solver steps."""
    for name, case in spec.FURTHER.items():
        world = table.build(gs, case, spec.VIEW, spec.WRIST)
        page.traces[name], contacts = lift(world, page.joints, case)
        note(page, "contacts", name, **contacts)


def conclude(page: Any) -> None:
    """Give a page the number of the first rung that each scene fails, 0 for none."""
    found = page.experiment
    page.readings["fails"] = {
        name: rungs.NUMBERS.index(next(iter(rungs.failed(found, name)), None))
        for name in rungs.scenes(found)[1:]
    }
