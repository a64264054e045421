"""Mistakes made on purpose with phases, places, masses, contacts and starts, and their symptoms.

Every function makes one mistake and measures its symptom. Do not copy them.
"""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.lessons.l08 import edge, metrics, spec
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.batch import set_link_mass
from robo_genesis.sim.arm.joints import JointMap, to_numpy
from robo_genesis.sim.bodies.table import World
from robo_genesis.sim.session import CaseError

MEASURES = False

STARTS = spec.starts(4, seed=8)
SOUND = edge.batch(STARTS)
DENSE = replace(SOUND, density=8000.0)
FAR, HIGH = 0.05, 0.04  # Errors of the belief, and of the height of the grasp [m]


def seen(world: World, joints: JointMap, case: picking.PickCase) -> tuple[SimpleNamespace, str]:
    """Run a batch; return numbers of episodes and medians over them, and words for these.

    `late` are those whose descent took its limit. `opening` is that when the lift begins, `pushed`
    how far the object is from its start when the fingers begin to close [mm].
    """
    trace, rows = picking.run(world, joints, case)[0], range(len(STARTS))
    close, lift = ((trace.phase >= of).argmax(0) for of in (picking.CLOSE, picking.LIFT))
    away = trace.object_pos[close, rows] - trace.object_pos[0]
    descent = (trace.phase == picking.DESCEND).sum(axis=0) * case.commands
    of = SimpleNamespace(
        finished=(trace.phase[-1] == picking.DONE).sum(),
        late=(descent >= picking.LIMIT).sum(),
        success=metrics.good(trace, case).sum(),
        opening=1000 * np.median(trace.q[lift, rows, -2:].sum(axis=1)),
        pushed=1000 * np.median(np.linalg.norm(away, axis=1)),
    )
    return of, (
        f"All phases are done in {of.finished} of {len(STARTS)} episodes, and the descent took its "
        f"limit in {of.late}. The cylinder is {of.pushed:.0f} mm from its start when the fingers "
        f"begin to close. They are {of.opening:.1f} mm apart when the lift begins. {of.success} "
        "cylinders end in the bowl."
    )


def empty_hand(world: World, joints: JointMap) -> Mistake:
    """Believe the object 5 cm off along the pads, and count the phases."""
    found, text = seen(world, joints, edge.batch(STARTS, np.array([FAR, 0.0])))
    shown = found.finished == len(STARTS) and not found.success and found.opening < 1
    return Mistake("empty_hand", bool(shown and not found.late), text)


def too_high(world: World, joints: JointMap) -> Mistake:
    """Descend 2 cm less, and 4 cm less."""
    (before, low), (after, high) = (
        seen(world, joints, replace(SOUND, pad=SOUND.pad - less)) for less in (HIGH / 2, HIGH)
    )
    shown = before.success > len(STARTS) - 4 and not after.success and after.opening < 20
    return Mistake("too_high", bool(shown), f"**20 mm too high.** {low}\n\n**40 mm.** {high}")


def pushed(world: World, joints: JointMap) -> Mistake:
    """Believe the object 5 cm off across the pads."""
    found, text = seen(world, joints, edge.batch(STARTS, np.array([0.0, FAR])))
    shown = found.late > len(STARTS) / 2 and found.pushed > 10 and found.success <= 1
    return Mistake("pushed", bool(shown), text)


def no_mask(world: World) -> Mistake:
    """Count contacts of object and robot before the robot has moved, without the mask."""
    world.scene.reset()
    world.scene.step()
    contacts = world.body.get_contacts(with_entity=world.robot)
    valid, force = (to_numpy(contacts[name]) for name in ("valid_mask", "force_a"))
    press = np.linalg.norm(force, axis=2).sum(axis=1).mean()
    text = (
        f"The arrays have {valid.shape[1]} entries for each environment, with {press:.1f} N in "
        f"all. `valid_mask` is true for {valid.sum():.0f} of them."
    )
    return Mistake("no_mask", valid.size > 0 and not valid.any(), text)


def solved(gs: Any) -> Mistake:
    """Draw starts in all of the table, and judge success by the horizontal distance alone."""
    case = replace(SOUND, starts=np.vstack([STARTS[1:], np.add(SOUND.bowl_at, 0.03)]))
    over = int((np.hypot(*(case.starts - case.bowl_at).T) < metrics.CENTRED).sum())
    error = refused(lambda: picking.build(gs, case))
    text = f"Before the first step, {over} of {len(case.starts)} episodes count as a success."
    shown = over == 1 and isinstance(error, CaseError)
    return Mistake("solved", shown, f"{text} The course's own scene refuses: {quoted(error)}")


def spin(world: World) -> float:
    """Return the speed about z after 0.1 N·mm for five steps, high above the table [rad/s]."""
    world.scene.reset()
    world.body.set_pos(np.insert(STARTS, 2, 0.6, axis=1))
    for _ in range(5):
        world.body.control_dofs_force(np.full((len(STARTS), 1), 1e-4), [5])
        world.scene.step()
    return float(to_numpy(world.body.get_ang())[0, 2])


def mass_alone(world: World, dense: World, joints: JointMap) -> Mistake:
    """Give a cylinder of density 400 the mass of one of density 8000; this changes the world."""
    link, rows = world.body.links[0].name, range(len(STARTS))
    mass = np.full(len(STARTS), DENSE.density * DENSE.volume)
    read = set_link_mass(world.body, link, mass, rows)  # the mistake
    changed, built = (
        seen(w, joints, case)[0].success for w, case in ((world, SOUND), (dense, DENSE))
    )
    fast, slow = spin(world), spin(dense)
    text = (
        f"All masses read back as {read[0]:.2f} kg. The same torque for 50 ms turns the changed "
        f"cylinder with {1000 * fast:.0f} mrad/s, and the built one with {1000 * slow:.1f} mrad/s. "
        f"The expert succeeds with {changed} of {len(STARTS)} changed ones, and with {built} of "
        f"{len(STARTS)} built ones."
    )
    return Mistake("mass_alone", fast > 10 * slow > 0, text)
