"""Mistakes made on purpose with phases, places, masses, contacts and starts, and their symptoms.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

from dataclasses import replace
from typing import Any, NamedTuple

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


class Seen(NamedTuple):
    """What a batch shows: numbers of episodes, and medians over them.

    `opening` [m] and `press` [N] are those when the lift begins, `pushed` is how far the object
    is from its start when the fingers begin to close [m].
    """

    finished: int
    late: int
    success: int
    carried: int
    opening: float
    press: float
    pushed: float


def seen(world: World, joints: JointMap, case: picking.PickCase) -> Seen:
    """Run a batch."""
    trace, rows = picking.run(world, joints, case)[0], range(len(case.starts))
    close, lift = ((trace.phase >= of).argmax(0) for of in (picking.CLOSE, picking.LIFT))
    pushed = trace.object_pos[close, rows] - trace.object_pos[0]
    limit = picking.LIMIT // case.commands
    return Seen(
        int((trace.phase[-1] == picking.DONE).sum()),
        int(((trace.phase == picking.DESCEND).sum(0) >= limit).sum()),
        int(edge.good(trace, case).sum()),
        int(ladder.rungs(trace, case)["carried"].sum()),
        float(np.median(trace.q[lift, rows, -2:].sum(1))),
        float(np.median(trace.force[lift, rows].sum(1))),
        float(np.median(np.linalg.norm(pushed, axis=1))),
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
    return Mistake("empty_hand", shown and not found.late, text)


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
    return Mistake("too_high", shown and after.finished == len(STARTS), text)


def pushed(world: World, joints: JointMap) -> Mistake:
    """Believe the object 5 cm off across the pads."""
    found = seen(world, joints, edge.batch(STARTS, np.array([0.0, FAR])))
    text = (
        f"The descent took its limit in {found.late} of {len(STARTS)} episodes. When the fingers "
        f"begin to close, the cylinder is {1000 * found.pushed:.0f} mm from its start. "
        f"{found.success} cylinders end in the bowl."
    )
    shown = found.late > len(STARTS) / 2 and found.pushed > 0.01 and found.success <= 1
    return Mistake("pushed", shown, text)


def no_mask(world: World) -> Mistake:
    """Count contacts of object and robot before the robot has moved, without the mask."""
    world.scene.reset()
    world.scene.step()
    contacts = world.body.get_contacts(with_entity=world.robot)
    valid, force = (to_numpy(contacts[name]) for name in ("valid_mask", "force_a"))
    listed, real = valid.shape[1], int(valid.sum())
    press = np.linalg.norm(force, axis=2).sum(axis=1).mean()
    text = (
        f"`contacts[\"geom_a\"].shape` is {tuple(contacts['geom_a'].shape)}: {listed} contacts in "
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
