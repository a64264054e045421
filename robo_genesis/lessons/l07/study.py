"""What the pages of L07 record of their scenes, one after the other."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, counts
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics, lifting
from robo_genesis.sim.arm.franka import MODEL_COUNTS
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import JointMap, describe, to_numpy
from robo_genesis.sim.bodies import bowl, table
from robo_genesis.sim.bodies.free_fall import GRAVITY
from robo_genesis.sim.camera import record
from robo_genesis.sim.camera.views import View, look, segment_number
from robo_genesis.sim.session import CaseError

from . import rungs, spec
from .metrics import BALL, OBJECT, SceneMetrics, scene_metrics

# Units of the readings of a scene, by group and name.
GROUPS = {
    "object": {
        **dict.fromkeys(("margin", "shape", "depth", "width"), "m"),
        **dict.fromkeys(("open", "friction"), "1"),
        "mass": "kg",
    },
    "support": {"carried": "N", "pushed": "m", "tilt": "rad", "reset": "m"},
    "outline": dict.fromkeys(rungs.CAMERAS, "pixels"),
    "reach": {
        "accepted": "poses",
        **dict.fromkeys(("pregrasp", "grasp", "over"), "m"),
        "touches": "postures",
    },
    "contacts": {"descending": "steps"} | dict.fromkeys(rungs.FINGERS, "points"),
}

UNITS = {name: unit for of in GROUPS.values() for name, unit in of.items()}


def group(name: str, *scenes: str) -> Readings:
    """Return a group of readings of scenes, named by scene and reading."""
    units = GROUPS[name].items()
    lifted = [of for of in scenes if name != "contacts" or spec.is_lifted(of)]
    return Readings(
        {f"{scene}_{what}": unit for scene in lifted for what, unit in units}
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
        lambda: table.arrange(world, case),
        after,
    )
    return trace, counts


class Facts:
    """What one scene shows, each fact measured when it is asked for first; nothing is judged.

    Args:
        page: gets the robot; its `render` decides about pictures.
        gs: the engine after `gs.init`.
        case: the settings.
        world: a built scene of equal `shapes`, to be arranged; without it one is built.

    Raises:
        CaseError: the ball is too thin to test the bowl.
    """

    def __init__(
        self, page: Any, gs: Any, case: table.SceneCase, world: table.World | None = None
    ) -> None:
        if case.ball_radius < spec.THIN:
            raise CaseError(
                f"ball_radius is {case.ball_radius:g} m. A ball thinner than {spec.THIN:g} m "
                "sinks through the floor of the bowl and cannot test it. Choose a larger one."
            )
        self.case, self.render = case, page.render
        self.world = world or table.build(gs, case, spec.VIEW, spec.WRIST)
        if world:
            table.arrange(world, case)
        self.joints = describe(page, self.world.robot)
        page.links = [*page.links, "object", "ball"]
        boxes = {name: of.get_AABB() for name, of in self.world.parts.items()}
        self.boxes = {
            name: to_numpy(of).reshape(2, 3).astype(float) for name, of in boxes.items()
        }

    def run(self, after: Callable[[int], None] | None = None) -> Trace:
        """Let the scene rest from its start, while the robot holds its own."""
        world, held = self.world, self.case.commanding(self.case.q_start)
        bodies = world.body, world.ball
        return run_case(
            world.scene,
            world.robot,
            self.joints,
            held,
            bodies,
            lambda: table.arrange(world, self.case),
            after,
        )

    @cached_property
    def resting(self) -> tuple[Trace, float, float]:
        """The run at rest, the deepest contact after a step [m], and the lift of contacts [N]."""
        depths: list[float] = []

        def after(step: int) -> None:
            contacts = self.world.body.get_contacts()
            depths.append(float(to_numpy(contacts["penetration"]).max(initial=0)))

        trace = self.run(after)
        forces = to_numpy(self.world.body.get_links_net_contact_force())
        return trace, depths[0], float(forces.reshape(-1, 3)[0, 2])

    @cached_property
    def again(self) -> tuple[Trace, Trace, dict[str, View]]:
        """The run at rest in leaning gravity, once more in upright one, and views at its end."""
        lean = np.array([0.0, 0.0, -GRAVITY * np.cos(spec.PUSH)])
        lean[np.argmin(self.case.size[:2])] = GRAVITY * np.sin(spec.PUSH)
        gravity = self.world.scene.sim.set_gravity
        gravity(lean)
        pushed = self.run()
        gravity((0.0, 0.0, -GRAVITY))
        trace, cameras = self.run(), self.world.cameras
        cameras["wrist"].move_to_attach()
        return (
            pushed,
            trace,
            {name: look(of, self.render) for name, of in cameras.items()},
        )

    @cached_property
    def approach(self) -> tuple[FloatArray, FloatArray, np.ndarray, int]:
        """Residuals (3, 6), heights of the fingertips (3,), contacts (33,), accepted answers.

        The answers are for pregrasp and grasp, and over the bowl. The heights are those
        above the support, or above the rim [m]. The robot is assigned to postures on
        the way to the grasp, and on that from the pregrasp to the bowl.
        """
        case, world, joints = self.case, self.world, self.joints
        world.scene.reset()
        table.arrange(world, case)
        rim = (*case.bowl_at, bowl.HEIGHT)
        points = lifting.waypoints(case.place, case.size[2])[:2]
        points += lifting.waypoints(rim, case.size[2])[:1]
        answers = lifting.ask(world.robot, joints, case.q_start, spec.ONE_START, points)
        residuals = np.array([answer.error for answer in answers], dtype=float)
        tips = [kinematics.fingertip(kinematics.hand_pose(a.q))[2] for a in answers]
        within = spec.ONE_START.tolerances
        accepted = sum(int(kinematics.accepted(a.q, a.error, *within)) for a in answers)
        over, at, away = (answer.q for answer in answers)
        way = lifting.line([case.q_start, over, at]) + lifting.line([over, away])
        touches = [lifting.touches(world.robot, joints, world.fixed, q) for q in way]
        z = case.place[2]
        return residuals, np.array(tips) - (z, z, rim[2]), np.array(touches), accepted

    @cached_property
    def lifting(self) -> tuple[Trace, dict[str, int]]:
        """The lift, and its counts."""
        return lift(self.world, self.joints, spec.lift_of(self.case))

    def read(self, group: str) -> dict[str, float]:
        """Return a group of readings by name."""
        return {**getattr(self, group)}

    @property
    def object(self) -> dict[str, float]:
        """How the geometry differs from the meant one, at the start and in the first step."""
        meant, body = self.case.boxes, self.world.body
        apart = [np.abs(meant[name] - of).max() for name, of in self.boxes.items()]
        own, basin, *_, below = self.world.parts.values()
        drawn = [geom.get_trimesh() for geom in (*own.vgeoms, *basin.vgeoms)]
        acts = max(geom.friction for geom in (*own.geoms, *below.geoms))
        return {
            "margin": rungs.margin(self.boxes),
            "shape": float(max(apart)),
            "depth": self.resting[1],
            "width": float(np.ptp(self.boxes["object"], axis=0)[1]),
            "open": float(sum(not one.is_watertight for one in drawn)),
            "friction": float(abs(acts - self.case.friction)),
            "mass": float(body.get_mass()),
        }

    @property
    def support(self) -> dict[str, float]:
        """What carries the object, and how a push moves it."""
        pushed, trace, _ = self.again
        start, end = (pushed.link_pos[k, OBJECT].astype(float) for k in (0, -1))
        _, x, y, _ = pushed.link_quat[-1, OBJECT].astype(float)
        return {
            "carried": self.resting[2],
            "pushed": float(np.linalg.norm(end - start)),
            "tilt": float(np.arccos(np.clip(1 - 2 * (x**2 + y**2), -1, 1))),
            "reset": float(np.abs(trace.link_pos - self.rest.link_pos).max()),
        }

    @property
    def outline(self) -> dict[str, float]:
        """Area of the object's outline in each view [pixel]."""
        corners = self.case.corners(self.rest.link_pos[-1, OBJECT])
        return {name: rungs.outline(corners, of) for name, of in self.views.items()}

    @property
    def pixels(self) -> dict[str, float]:
        """Pixels of the object in each picture."""
        shown = self.segmentations.items()
        return {name: float(np.sum(of == self.number)) for name, of in shown}

    @property
    def reach(self) -> dict[str, float]:
        """What the hand can reach, and what is in its way."""
        _, tips, touches, accepted = self.approach
        reach = accepted, *tips.tolist(), int((touches > 0).sum())
        return dict(zip(GROUPS["reach"], reach, strict=True))

    @property
    def contacts(self) -> dict[str, int]:
        """Counts of the lift."""
        return self.lifting[1]

    @property
    def rest(self) -> Trace:
        """The run at rest."""
        return self.resting[0]

    @property
    def lift(self) -> Trace:
        """The run of the lift."""
        return self.lifting[0]

    @property
    def rested(self) -> SceneMetrics:
        """Metrics of the run at rest."""
        return scene_metrics(self.rest, self.case)

    @property
    def lifted(self) -> SceneMetrics:
        """Metrics of the lift."""
        return scene_metrics(self.lift, spec.lift_of(self.case))

    @property
    def ball(self) -> FloatArray:
        """Where the ball ends (3,) [m]."""
        return self.rest.link_pos[-1, BALL]

    @property
    def positions(self) -> FloatArray:
        """Centre (n + 1, 3) of the object at rest [m]."""
        return self.rest.link_pos[:, OBJECT].astype(np.float64)

    @property
    def pairs(self) -> list[tuple[table.Footprint, table.Footprint]]:
        """Footprints that must not overlap, as `rungs.pairs` explains."""
        return rungs.pairs(self.boxes)

    @property
    def views(self) -> dict[str, View]:
        """What each camera sees of the scene at rest."""
        return self.again[2]

    @property
    def segmentations(self) -> dict[str, np.ndarray]:
        """Segmentation (H, W) of each camera, none without pictures."""
        found = {name: view.segmentation for name, view in self.views.items()}
        return {name: picture for name, picture in found.items() if picture is not None}

    @property
    def number(self) -> int:
        """Number of the object in the segmentations."""
        return segment_number(self.world.scene, self.world.body.links[0])

    @property
    def values(self) -> dict[str, dict[str, float]]:
        """The values that decide about the scene, by rung."""
        return {rung: values(self) for rung, values in rungs.LADDER.items()}


def keep(page: Any, scene: str, found: Facts) -> None:
    """Give a page what a scene of the specification showed, of the good one its views as well."""
    page.traces[f"{scene}_at_rest"] = found.rest
    groups = ["object", "support", "outline", "reach"] + ["pixels"] * page.render
    if spec.is_lifted(scene):
        groups.append("contacts")
        page.traces[scene] = found.lift
    for name in groups:
        note(page, name, scene, **found.read(name))
    if scene == "baseline":
        for name, view in found.views.items():
            page.readings[f"view_{name}"] = record.numbers(view)
            page.frames |= record.frames(name, view)


def examine(page: Any, gs: Any, scene: str) -> table.World:
    """Build a scene and give a page everything that its rungs measure; return the scene."""
    found = Facts(page, gs, spec.SCENES[scene])
    keep(page, scene, found)
    return found.world


def attack(page: Any, gs: Any, worlds: Mapping[str, table.World]) -> None:
    """Give a page the first rung that each of `spec.ATTACKS` fails, and the value that shows it.

    A scene of the same shapes as an earlier one is arranged, not built again.

    Args:
        page: gets the readings.
        gs: the engine after `gs.init`.
        worlds: built scenes of the specification by name, which are reset afterwards.
    """
    known = {spec.SCENES[name].shapes: world for name, world in worlds.items()}
    page.readings |= {"attacks": {}, "caught": {}}
    for name, (_, case, quantity) in spec.ATTACKS.items():
        found = Facts(page, gs, case, known.get(case.shapes))
        known[case.shapes] = found.world
        page.readings["attacks"][name], values = rungs.first_failure(found)
        if quantity:
            page.readings["caught"][name] = values.get(quantity, np.nan)
    for world in known.values():
        world.scene.reset()


def record_forced(page: Any, gs: Any) -> None:
    """Give a page the lifts of the wide box with little friction, at two solver steps."""
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
