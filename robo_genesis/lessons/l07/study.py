"""What the pages of L07 record of their scenes, one after the other."""

from typing import Any

from robo_genesis.core.experiment import Readings, counts
from robo_genesis.lessons.l07 import run, rungs, spec
from robo_genesis.sim.arm import kinematics, lifting, reaching
from robo_genesis.sim.arm.franka import MODEL_COUNTS
from robo_genesis.sim.arm.joints import describe
from robo_genesis.sim.camera import record
from robo_genesis.sim.camera.geometry import outline_area
from robo_genesis.sim.camera.views import look, segment_number

COUNTED = ("descending", "closed_left", "closed_right", "held_left", "held_right")


def readings(*scenes: str) -> dict[str, Readings]:
    """Return the groups of readings of a page with these scenes; `pixels` needs a camera."""

    def group(units: dict[str, str]) -> Readings:
        return Readings(
            {f"{scene}_{name}": unit for scene in scenes for name, unit in units.items()}
        )

    return {
        "model": counts(MODEL_COUNTS),
        "object": group({"mass": "kg", "depth": "m"}),
        "outline": group(dict.fromkeys(rungs.CAMERAS, "pixel")),
        "reach": group({"accepted": "poses", "pregrasp": "m", "grasp": "m", "touches": "postures"}),
        "contacts": group(
            {name: "steps" if name == "descending" else "points" for name in COUNTED}
        ),
        "fails": counts(scene for scene in scenes if scene != "baseline"),
    }


def forced_readings() -> dict[str, Readings]:
    """Return the group of readings of the lifts of the wide box with little friction."""
    units = {f"{name}_{what}": "points" for name in spec.FURTHER for what in COUNTED}
    return {"forced_lifts": Readings(units)}


def pixels(*scenes: str) -> dict[str, Readings]:
    """Return the group of readings that needs a camera."""
    units = {f"{scene}_{camera}": "pixel" for scene in scenes for camera in rungs.CAMERAS}
    return {"pixels": Readings(units)}


def note(page: Any, group: str, scene: str, **values: float) -> None:
    """Add readings of a scene to a group of a page."""
    more = {f"{scene}_{name}": value for name, value in values.items()}
    page.readings[group] = {**page.readings.get(group, {}), **more}


def examine(page: Any, gs: Any, scene: str) -> run.World:
    """Build a scene and give a page everything that its rungs measure; return the scene."""
    case, lift = spec.SCENES[scene], spec.lift_of(spec.SCENES[scene])
    world = run.build(gs, case, spec.VIEW, spec.WRIST)
    joints = describe(page, world.robot)
    page.links = [*page.links, "object", "ball"]
    page.traces[f"{scene}_at_rest"], depth = run.rest(world, joints, case)
    mass = float(world.body.get_mass())
    note(page, "object", scene, mass=mass, depth=depth)
    see(page, world, scene, case)
    points = lifting.waypoints(case.place, case.size[2])[:2]
    answers = lifting.ask(world.robot, joints, case.q_start, reaching.ONE_START, points)
    good = [kinematics.accepted(a.q, a.error, *reaching.ONE_START.tolerances) for a in answers]
    tips = [float(kinematics.fingertip(kinematics.hand_pose(a.q))[2]) for a in answers]
    way = lifting.line([case.q_start, *(a.q for a in answers)])
    touched = sum(lifting.touches(world.robot, joints, world.fixed, q) > 0 for q in way)
    note(page, "reach", scene, accepted=sum(map(int, good)), pregrasp=tips[0], grasp=tips[1],
         touches=touched)  # fmt: skip
    page.traces[scene], contacts = run.lift(world, joints, lift)
    note(page, "contacts", scene, **contacts)
    return world


def see(page: Any, world: run.World, scene: str, case: run.SceneCase) -> None:
    """Give a page the pixels of the object in both cameras, and the views of the good scene."""
    centre = page.traces[f"{scene}_at_rest"].link_pos[-1, -2]
    for name, camera in world.cameras.items():
        if name == "wrist":
            camera.move_to_attach()
        view = look(camera, page.render)
        area = outline_area(rungs.corners(case, centre), view.intrinsics, view.transform)
        note(page, "outline", scene, **{name: area})
        if view.segmentation is not None:
            number = segment_number(world.scene, world.body.links[0])
            note(page, "pixels", scene, **{name: float((view.segmentation == number).sum())})
        if scene == "baseline":
            page.readings |= {f"view_{name}": record.numbers(view)}
            page.frames |= record.frames(name, view)


def record_forced(page: Any, gs: Any) -> None:
    """Give a page the lifts of the wide box with little friction, at two solver steps."""
    found: dict[str, float] = {}
    for name, case in spec.FURTHER.items():
        world = run.build(gs, case, spec.VIEW, spec.WRIST)
        page.traces[name], contacts = run.lift(world, page.joints, case)
        found |= {f"{name}_{what}": count for what, count in contacts.items()}
    page.readings["forced_lifts"] = found


def conclude(page: Any) -> None:
    """Give a page the number of the rung that each scene fails, 0 for none or for several."""
    found = page.experiment
    failed = {name: rungs.failed(found, name) for name in rungs.scenes(found)}
    failed.pop("baseline", None)
    page.readings["fails"] = {
        name: spec.RUNGS.index(rung[0]) + 1 if len(rung) == 1 else 0
        for name, rung in failed.items()
    }
