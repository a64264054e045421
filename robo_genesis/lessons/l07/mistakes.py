"""Mistakes made on purpose with cameras, masks, friction and segmentations, and their symptoms.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding, above, equal
from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l07 import spec, study
from robo_genesis.lessons.l07.metrics import scene_metrics
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.bodies import table
from robo_genesis.sim.camera.views import look, segment_number

MEASURES = False

NEAR = (0.1001, 0.0999)  # Distances beyond a near limit and within it [m]

SLIPPERY, HEAVY = 0.3, 1.08  # Friction coefficient; the cylinder of scene A in steel [kg]


def near_limit(world: table.World, render: bool) -> Mistake:
    """Look down on the object of scene A from both distances."""
    if not render:
        return Mistake("near_limit", True, "SKIP: this run has no camera.")
    world.scene.reset()
    (x, y, z), camera, found = spec.GOOD.centre, world.cameras["world"], []
    for distance in NEAR:
        top = z + spec.GOOD.size[2] / 2
        camera.set_pose(pos=(x, y, top + distance), lookat=(x, y, 0), up=(0, 1, 0))
        view: Any = look(camera)
        mine = view.segmentation == segment_number(world.scene, world.body.links[0])
        found.append((int(mine.sum()), float(view.depth[tuple(np.array(mine.shape) // 2)])))
    (drawn, _), (left, depth) = found
    text = (
        f"At {1000 * NEAR[0]:g} mm the object has {drawn} pixels. At {1000 * NEAR[1]:g} mm it has "
        f"{left}, and the depth in the middle of the picture is {1000 * depth:.1f} mm."
    )
    return Mistake("near_limit", drawn > 1000 and not left and depth > 0.16, text)


def list_of_bools(scene: Any, ball: Any, torch: Any) -> Mistake:
    """Reset two of four falling balls with a list of bools, then with a Torch mask."""
    found, mask = [], [False, False, True, True]
    for given in (mask, torch.tensor(mask, device=ball.get_pos().device)):
        scene.reset()
        for _ in range(10):
            scene.step()
        before = to_numpy(ball.get_pos())[:, 2].copy()
        scene.reset(envs_idx=given)
        found.append(np.flatnonzero(before != to_numpy(ball.get_pos())[:, 2]).tolist())
    text = (
        f"The list of bools {mask} reset the environments {found[0]}. The Torch mask of the same "
        f"values reset {found[1]}."
    )
    return Mistake("list_of_bools", found == [[0, 1], [2, 3]], text)


def one_sided_friction(world: table.World, joints: JointMap) -> Mistake:
    """Lift a heavy object as it is, with less friction of its own, and with that of both.

    This changes the world.
    """
    world.body.set_mass(HEAVY)
    case, rises = spec.lift_of(spec.GOOD), []
    for changed in (None, world.body, world.robot):
        if changed:
            changed.set_friction(SLIPPERY)
        rises.append(1000 * (scene_metrics(study.lift(world, joints, case)[0], case).rise or 0))
    before, alone, both = rises
    text = (
        f"With its own coefficient of {case.friction:g} the object rises {before:.1f} mm, and with "
        f"{SLIPPERY:g} it rises {alone:.1f} mm. After `robot.set_friction({SLIPPERY:g})` as well, "
        f"it rises {both:.1f} mm."
    )
    return Mistake("one_sided_friction", abs(alone - before) < 1 and both < 5 < alone, text)


def background_key(scene: Any, body: Any) -> Mistake:
    """Take the entity of each number of a segmentation as the first item of its key."""
    keys = scene.segmentation_idx_dict
    error = refused(lambda: [key[0] for key in keys.values()])  # the mistake
    number = segment_number(scene, body.links[0])
    text = (
        f"`{{key[0] for key in keys.values()}}`: {quoted(error)}. The key of number 0 is "
        f"`{keys[0]!r}`. The object is entity {body.idx} of the scene, and its pixels have the "
        f"number {number}."
    )
    shown = isinstance(error, TypeError) and keys[0] == -1 and number != body.idx
    return Mistake("background_key", shown, text)


def symptoms(found: Experiment) -> Iterator[Finding]:
    """No camera has a pixel of scene D's object. The solver accepts both postures of scene E, and
    the way to them touches something. In scene F the open hand touches the box.
    """
    for camera, pixels in found.readings.get("pixels", {}).items():
        if camera.startswith("outside"):
            yield equal(camera, pixels, 0)
    yield equal("below.accepted", found.readings["reach"]["below_accepted"], 2)
    yield above("below.touches", found.readings["reach"]["below_touches"], 0)
    yield above("wide.descending", found.readings["contacts"]["wide_descending"], 0)
