"""Mistakes made on purpose with phases, places, masses, contacts and starts, and their symptoms.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.lessons.l08 import edge, ladder, spec
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.batch import set_link_mass
from robo_genesis.sim.arm.joint_control import CaseError
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.bodies.table import World

MEASURES = False

STARTS = spec.starts(4, seed=8)
SOUND = edge.batch(STARTS)
DENSE = replace(SOUND, density=8000.0)
FAR, HIGH = 0.05, 0.04  # Errors of the belief, and of the height of the grasp [m]


def seen(world: World, joints: JointMap, case: picking.PickCase) -> SimpleNamespace:
    """Run a batch; return numbers of episodes, and medians over them.

    `late` are those whose descent took its limit. `opening` is that when the lift begins, `pushed`
    how far the object is from its start when the fingers begin to close [m], and `tilt` its largest
    one in the move [degree].
    """
    trace, rows = picking.run(world, joints, case)[0], range(len(case.starts))
    close, lift = ((trace.phase >= of).argmax(0) for of in (picking.CLOSE, picking.LIFT))
    away = trace.object_pos[close, rows] - trace.object_pos[0]
    lean = 1 - 2 * (trace.object_quat[..., 1:3] ** 2).sum(axis=-1)
    tilt = np.degrees(np.arccos(np.clip(lean, -1, 1))) * (trace.phase == picking.MOVE)
    descent = (trace.phase == picking.DESCEND).sum(axis=0) * case.commands
    return SimpleNamespace(
        finished=(trace.phase[-1] == picking.DONE).sum(),
        late=(descent >= picking.LIMIT).sum(),
        success=edge.good(trace, case).sum(),
        opening=np.median(trace.q[lift, rows, -2:].sum(axis=1)),
        pushed=np.median(np.linalg.norm(away, axis=1)),
        tilt=np.median(tilt.max(axis=0)),
    )


def empty_hand(world: World, joints: JointMap) -> Mistake:
    """Believe the object 5 cm off along the pads, and count the phases."""
    found = seen(world, joints, edge.batch(STARTS, np.array([FAR, 0.0])))
    text = (
        f"All phases are done in {found.finished} of {len(STARTS)} episodes, and the descent took "
        f"its limit in {found.late}. When the lift begins, the fingers are "
        f"{1000 * found.opening:.1f} mm apart. {found.success} cylinders end in the bowl."
    )
    shown = found.finished == len(STARTS) and not found.success and found.opening < 1e-3
    return Mistake("empty_hand", bool(shown and not found.late), text)


def too_high(world: World, joints: JointMap) -> Mistake:
    """Descend 4 cm less."""
    before, after = (
        seen(world, joints, replace(SOUND, pad=SOUND.pad - less)) for less in (HIGH - 0.01, HIGH)
    )
    text = (
        f"30 mm too high, {before.success} of {len(STARTS)} cylinders end in the bowl; the fingers "
        f"are {1000 * before.opening:.1f} mm apart when the lift begins. 40 mm too high it is "
        f"{after.success}, with {1000 * after.opening:.1f} mm. All phases are done in "
        f"{before.finished} and {after.finished} episodes."
    )
    shown = before.success >= len(STARTS) - 1 and not after.success and after.opening < 0.02
    return Mistake("too_high", bool(shown and after.finished == len(STARTS)), text)


def pushed(world: World, joints: JointMap) -> Mistake:
    """Believe the object 5 cm off across the pads."""
    found = seen(world, joints, edge.batch(STARTS, np.array([0.0, FAR])))
    text = (
        f"The descent took its limit in {found.late} of {len(STARTS)} episodes. When the fingers "
        f"begin to close, the cylinder is {1000 * found.pushed:.0f} mm from its start. "
        f"{found.success} cylinders end in the bowl."
    )
    shown = found.late > len(STARTS) / 2 and found.pushed > 0.01 and found.success <= 1
    return Mistake("pushed", bool(shown), text)


def no_mask(world: World) -> Mistake:
    """Count contacts of object and robot before the robot has moved, without the mask."""
    world.scene.reset()
    world.scene.step()
    contacts = world.body.get_contacts(with_entity=world.robot)
    valid, force = (to_numpy(contacts[name]) for name in ("valid_mask", "force_a"))
    listed, real = valid.shape[1], int(valid.sum())
    press = np.linalg.norm(force, axis=2).sum(axis=1).mean()
    text = (
        f'`contacts["geom_a"].shape` is {tuple(contacts["geom_a"].shape)}: {listed} contacts in '
        f"each environment, with {press:.1f} N in all. `valid_mask` marks {real} of them."
    )
    return Mistake("no_mask", listed > 0 and not real, text)


def solved(gs: Any) -> Mistake:
    """Draw starts in all of the table, and judge success by the horizontal distance alone."""
    case = replace(SOUND, starts=np.vstack([STARTS[1:], np.add(SOUND.bowl_at, 0.03)]))
    over = int((np.hypot(*(case.starts - case.bowl_at).T) < ladder.CENTRED).sum())
    error = refused(lambda: picking.build(gs, case))
    text = f"Before the first step, {over} of {len(case.starts)} episodes count as a success."
    shown = over == 1 and isinstance(error, CaseError)
    return Mistake("solved", shown, f"{text} The course's own scene refuses: {quoted(error)}")


def mass_alone(world: World, dense: World, joints: JointMap) -> Mistake:
    """Give a cylinder of density 400 the mass of one of density 8000; this changes the world."""
    mass = DENSE.density * DENSE.volume
    link, rows = world.body.links[0].name, range(len(STARTS))
    read = set_link_mass(world.body, link, np.full(len(STARTS), mass), rows)
    changed, built = seen(world, joints, SOUND), seen(dense, joints, DENSE)
    text = (
        f"Both have {read[0]:.2f} kg. Built with density {DENSE.density:g}, {built.success} of "
        f"{len(STARTS)} cylinders succeed, and in the move they tilt by {built.tilt:.0f}°. With "
        f"the mass set, it is {changed.success}, and they tilt by {changed.tilt:.0f}°."
    )
    shown = changed.success + 4 < built.success and changed.tilt > 20 > built.tilt
    return Mistake("mass_alone", bool(shown), text)
