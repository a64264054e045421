"""What the pages of L07 record of their scenes, one after the other."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Readings, counts
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm import kinematics, lifting
from robo_genesis.sim.arm.franka import MODEL_COUNTS
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import JointMap, describe, to_numpy
from robo_genesis.sim.bodies import bowl, table
from robo_genesis.sim.bodies.contacts import friction
from robo_genesis.sim.bodies.free_fall import GRAVITY
from robo_genesis.sim.camera import record
from robo_genesis.sim.camera.views import look, segment_number
from robo_genesis.sim.session import CaseError

from . import rungs, spec
from .metrics import OBJECT, scene_metrics


def areas(*scenes: str) -> Readings:
    """Return readings of pixels, for each scene and camera."""
    return Readings(
        {f"{scene}_{of}": "pixels" for scene in scenes for of in rungs.CAMERAS}
    )


def readings(*scenes: str) -> dict[str, Readings]:
    """Return the groups of readings of a page with these scenes."""
    units = {
        f"{scene}_{name}": unit for scene in scenes for name, unit in spec.UNITS.items()
    }
    others = {"fails": counts(scenes[1:])} if scenes[1:] else {}
    found = {"ladder": Readings(units), "outline": areas(*scenes)}
    return found | {"model": counts(MODEL_COUNTS)} | others


# What the page records further: lifts that start in contact, and scenes made to fool.
FURTHER = {
    "contacts": counts(f"{name}_{of}" for name in spec.FURTHER for of in spec.CONTACTS),
    "attacks": counts(spec.ATTACKS),
    "caught": Readings(
        {name: spec.UNITS[of] for name, (_, of) in spec.ATTACKS.items() if of}
    ),
}


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
    """What one scene shows. Each rung measures its own facts, in order, and judges nothing.

    | attribute | meaning | measured by |
    |---|---|---|
    | `case`, `world` | its settings, and the built scene | |
    | `boxes`, `pairs` | by name as the engine has them; footprints as in `rungs.pairs` | |
    | `rest`, `positions` | the run at rest; centre (n + 1, 3) of the object [m] | `built` |
    | `views`, `outlines` | by camera; area of the object in each [pixel] | `seen` |
    | `number`, `pixels` | of the object in segmentations; by camera, if rendered | `seen` |
    | `residuals` | (3, 6) of pregrasp, grasp, over the bowl [m], [rad] | `reachable` |
    | `tips` | (3,) of the fingertips above the support, or the rim [m] | `reachable` |
    | `touches` | (33,) contacts on the way to the grasp, and to the bowl | `reachable` |
    | `lift` | its run | `graspable` |

    Args:
        page: gets the robot; its `render` decides about pictures.
        gs: the engine after `gs.init`.
        case: the settings.
        world: a built scene of equal `shapes`, to be arranged; without it one is built.

    Raises:
        CaseError: the ball is too thin to test the bowl.
    """

    def __init__(
        self,
        page: Any,
        gs: Any,
        case: table.SceneCase,
        world: table.World | None = None,
    ) -> None:
        if case.ball_radius < spec.THIN:
            raise CaseError(
                f"ball_radius is {case.ball_radius:g} m. A ball thinner than {spec.THIN:g} m "
                "sinks through the floor of the bowl and cannot test it. Choose a larger one."
            )
        self.case, self.render = case, page.render
        self.world = world or table.build(gs, case, spec.VIEW, spec.WRIST)
        if world:
            world.scene.reset()  # places and orientations
            table.arrange(world, case)
            world.body.set_friction(case.friction)
        self.joints = describe(page, self.world.robot)
        page.links = [*page.links, "object", "ball"]
        self.values: dict[str, dict[str, float]] = {}
        self.boxes = {
            name: to_numpy(of.get_AABB()).reshape(2, 3).astype(float)
            for name, of in self.world.parts.items()
        }
        self.pairs = rungs.pairs(self.boxes)

    def run(self, after: Callable[[int], None] | None = None) -> Trace:
        """Let the scene rest from its start, while the robot holds its own."""
        case, (scene, robot, body, ball, *_) = self.case, self.world
        held = case.commanding(case.q_start)
        begin = partial(table.arrange, self.world, case)
        return run_case(scene, robot, self.joints, held, (body, ball), begin, after)

    def built(self) -> dict[str, Any]:
        """Return how the engine's geometry differs from the meant one, and where the ball is."""
        case = self.case
        depths: list[float] = []
        own, basin, *_, below = self.world.parts.values()

        def after(step: int) -> None:
            contacts = own.get_contacts()
            depths.append(float(to_numpy(contacts["penetration"]).max(initial=0)))

        self.rest = self.run(after)
        self.carried = to_numpy(own.get_links_net_contact_force())[..., 2].item()
        self.positions = self.rest.link_pos[:, OBJECT].astype(float)
        apart = [np.abs(case.boxes[name] - of).max() for name, of in self.boxes.items()]
        acts = max(friction(self.world.scene, body) for body in (own, below))
        return {
            "margin": min(table.gap(*pair) for pair in self.pairs),
            "shape": max(apart),
            "open": not all(one.get_trimesh().is_watertight for one in basin.vgeoms),
            "friction": abs(round(acts, 6) - case.friction),
            "mass": abs(own.get_mass() / (case.density * case.volume) - 1),
            "depth": depths[0],
            "ball": scene_metrics(self.rest, case).ball,
        }

    def stable(self) -> dict[str, Any]:
        """Return what carries the object, and how it moves: at rest, and with leaning gravity."""
        lean = np.array([0.0, 0.0, -GRAVITY * np.cos(spec.PUSH)])
        lean[np.argmin(self.case.size[:2])] = GRAVITY * np.sin(spec.PUSH)
        self.world.scene.sim.set_gravity(lean)
        pushed = self.run().link_pos[:, OBJECT].astype(float)
        self.world.scene.sim.set_gravity((0.0, 0.0, -GRAVITY))
        found: Any = scene_metrics(self.rest, self.case)
        return {
            "carried": self.carried / (self.world.body.get_mass() * GRAVITY),
            "support": abs(found.support),
            "drift": found.drift,
            "moved": found.moved,
            "pushed": np.linalg.norm(pushed[-1] - pushed[0]),
            "reset": np.abs(self.run().link_pos - self.rest.link_pos).max(),
        }

    def seen(self) -> dict[str, float]:
        """Return pixels and share of the camera that is nearest to fulfilling both bounds."""
        self.run()
        cameras, corners = self.world.cameras, self.case.corners(self.positions[-1])
        cameras["wrist"].move_to_attach()
        self.views = {name: look(of, self.render) for name, of in cameras.items()}
        body = self.world.body.links[0]
        self.number = segment_number(self.world.scene, body) if self.render else 0
        self.outlines = {of: rungs.outline(corners, v) for of, v in self.views.items()}
        self.pixels = {
            of: np.sum(v.segmentation == self.number)
            for of, v in self.views.items()
            if self.render
        }
        areas = self.outlines
        views = [(n, n / max(areas[of], 1)) for of, n in (self.pixels or areas).items()]
        return dict(zip(("pixels", "share"), rungs.best(views), strict=True))

    def reachable(self) -> dict[str, Any]:
        """Return the accepted answers, the clearances, and postures that touch something."""
        case, world, joints, z = self.case, self.world, self.joints, self.case.place[2]
        rim = (*case.bowl_at, bowl.HEIGHT)
        points = lifting.waypoints(case.place, case.size[2])[:2]
        points += lifting.waypoints(rim, case.size[2])[:1]
        answers = lifting.ask(world.robot, joints, case.q_start, spec.ONE_START, points)
        self.residuals = np.array([answer.error for answer in answers], dtype=float)
        tips = [kinematics.fingertip(kinematics.hand_pose(a.q))[2] for a in answers]
        self.tips = np.array(tips) - (z, z, rim[2])
        within = spec.ONE_START.tolerances
        accepted = sum(int(kinematics.accepted(a.q, a.error, *within)) for a in answers)
        over, at, away = (answer.q for answer in answers)
        way = lifting.line([case.q_start, over, at]) + lifting.line([over, away])
        touches = [lifting.touches(world.robot, joints, world.fixed, q) for q in way]
        self.touches = np.array(touches)
        found = accepted, *self.tips, (self.touches > 0).sum()
        return dict(zip(spec.QUANTITIES["reachable"], found, strict=True))

    def graspable(self) -> dict[str, Any]:
        """Return the width, what the hand touches, and the share of its rise."""
        case = spec.lift_of(self.case)
        self.lift, contacts = lift(self.world, self.joints, case)
        before, *fingers = contacts.values()
        found: Any = scene_metrics(self.lift, case)
        return {
            "width": np.ptp(self.boxes["object"], axis=0)[1],
            "descending": before,
            "fingers": min(fingers),
            "rise": found.rise / found.hand_rise,
        }

    def measure(self, rung: str) -> dict[str, float]:
        """Measure a rung, after all lower ones, and keep its values."""
        found = {name: float(value) for name, value in getattr(self, rung)().items()}
        self.values[rung] = found
        return found


def facts(page: Any, gs: Any, case: table.SceneCase) -> Facts:
    """Build a scene, measure all rungs, and return what it shows."""
    found = Facts(page, gs, case)
    for rung in spec.RUNGS:
        found.measure(rung)
    return found


def keep(page: Any, scene: str, found: Facts) -> None:
    """Give a page what a scene of the specification showed, of the good one its views as well."""
    page.traces |= {f"{scene}_at_rest": found.rest, scene: found.lift}
    groups = [("ladder", of) for of in found.values.values()]
    for group, of in (*groups, ("outline", found.outlines), ("pixels", found.pixels)):
        for name, value in of.items():
            page.readings.setdefault(group, {})[f"{scene}_{name}"] = float(value)
    if scene == "baseline":
        for name, view in found.views.items():
            page.readings[f"view_{name}"] = record.numbers(view)
            page.frames |= record.frames(name, view)


def examine(page: Any, gs: Any, scene: str) -> table.World:
    """Build a scene and give a page everything that its rungs measure; return the scene."""
    found = facts(page, gs, spec.SCENES[scene])
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
    for name, (changed, quantity) in spec.ATTACKS.items():
        case = replace(spec.GOOD, **changed)
        found = Facts(page, gs, case, known.get(case.shapes))
        known[case.shapes] = found.world
        failing = (of for of in spec.RUNGS if not rungs.passed(found.measure(of)))
        page.readings["attacks"][name] = rungs.NUMBERS.index(next(failing, None))
        if quantity:
            of = found.measure(rungs.rung_of(quantity))
            page.readings["caught"][name] = of[quantity]
    for world in known.values():
        world.scene.reset()


def record_forced(page: Any, gs: Any) -> None:
    """Give a page the lifts of the slippery box, at two solver steps."""
    page.readings["contacts"] = {}
    for name, case in spec.FURTHER.items():
        world = table.build(gs, case, spec.VIEW, spec.WRIST)
        page.traces[name], contacts = lift(world, page.joints, case)
        page.readings["contacts"] |= {
            f"{name}_{of}": contacts[of] for of in spec.CONTACTS
        }


def conclude(page: Any) -> None:
    """Give a page the number of the first rung that each scene fails, 0 for none."""
    found = page.experiment
    page.readings["fails"] = {
        name: rungs.NUMBERS.index(next(iter(rungs.failed(found, name)), None))
        for name in rungs.scenes(found)[1:]
    }
