"""Mistakes made on purpose with scenes: calls on the wrong side of build, bodies that do not fall.

Every function makes one mistake and measures its symptom. None of them is an example to follow.
"""

from typing import Any

import numpy as np

from robo_genesis.core.exercises import Mistake, quoted, refused
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.bodies.free_fall import continuous_drop
from robo_genesis.sim.bodies.rigid_bodies import Drop, read_body, record_states
from robo_genesis.sim.camera.frames import FrameError, require_frame

MEASURES = False

LEAP = 0.5  # Rise from which a box counts as leaping, as a share of its edge

FALL_STEPS = 60  # Steps in which a box without collision geometry falls past the ground


def second_init(gs: Any) -> Mistake:
    """Initialise the engine a second time."""
    error = refused(lambda: gs.init(backend=gs.cpu))
    text = f"The second call of `gs.init` in the process of this page: {quoted(error)}"
    return Mistake("second_init", type(error).__name__ == "GenesisException", text)


def heights(
    scene: Any, case: Drop, steps: int, **bodies: Any
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Reset and step; return times [s] and each body's height [m] at every state, (steps+1,)."""
    scene.reset()

    def read() -> list[float]:
        return [float(read_body(body)[0][0, 2]) for body in bodies.values()]

    z = np.array(record_states(scene.step, steps, read)).T
    return np.arange(steps + 1) * case.dt, dict(zip(bodies, z, strict=True))


def fixed_body(scene: Any, fixed: Any, free: Any, case: Drop) -> Mistake:
    """Drop a free box and a box whose morph has `fixed=True`."""
    t, z = heights(scene, case, case.steps, fixed=fixed, free=free)
    moved, fell = (float(z[name][0] - z[name][-1]) for name in ("fixed", "free"))
    falls = fell > 0.9 * float(continuous_drop(t[-1], case.gravity))
    dofs = fixed.n_dofs, free.n_dofs
    text = (
        f"In {t[-1]:g} s this box fell {moved:.4f} m and the other one {fell:.4f} m. They have "
        f"{dofs[0]} and {dofs[1]} DOFs."
    )
    curves = {"this box": (t, z["fixed"]), "the other one": (t, z["free"])}
    return Mistake("fixed_body", moved == 0 and falls and dofs == (0, 6), text, curves)


def centre_for_underside(scene: Any, sunken: Any, case: Drop) -> Mistake:
    """Place a box 'on' the ground with a height of its centre of zero."""
    t, found = heights(scene, case, case.steps, sunken=sunken)
    z = found["sunken"]
    speed, below = float(np.diff(z).max() / case.dt), 1000 * (case.size / 2 - float(z[0]))
    shown = bool(z[0] < case.size / 2 and z.max() > z[0] + LEAP * case.size)
    text = (
        f"Its centre started at {z[0]:.3f} m, its underside {below:.0f} mm below the ground. The "
        f"centre rose to {z.max():.3f} m; the largest upward speed between two samples was "
        f"{speed:.2f} m/s."
    )
    return Mistake("centre_for_underside", shown, text, {"centre of the box": (t, z)})


def no_collision(scene: Any, ghost: Any, solid: Any, case: Drop) -> Mistake:
    """Drop a box whose morph has `collision=False`, beside an ordinary one."""
    t, z = heights(scene, case, FALL_STEPS, ghost=ghost, solid=solid)
    fallen, landed = (float(z[name][-1]) for name in ("ghost", "solid"))
    text = (
        f"After {t[-1]:g} s the centre of this box is at {fallen:.3f} m and that of the other one "
        f"at {landed:.3f} m. The lists `vgeoms` have {len(ghost.vgeoms)} and {len(solid.vgeoms)} "
        f"entries, the lists `geoms` {len(ghost.geoms)} and {len(solid.geoms)}."
    )
    curves = {"this box": (t, z["ghost"]), "the other one": (t, z["solid"])}
    shown = fallen < -case.size and 0 < landed < case.size
    return Mistake("no_collision", shown, text, curves)


def picture_of_nothing(camera: Any) -> Mistake:
    """Turn the camera away from all bodies of the scene, and render; None means no camera."""
    if camera is None:
        skipped = "SKIP: rendering is off, so no picture was taken."
        return Mistake("picture_of_nothing", True, skipped)
    pose = np.array(camera.transform)
    x, y, z = (float(value) for value in np.asarray(camera.pos).reshape(-1)[:3])
    camera.set_pose(pos=(x, y, z), lookat=(2 * x, 2 * y, z + 2.0))
    rgb = camera.render()[0]
    camera.set_pose(transform=pose)
    error = refused(lambda: require_frame(rgb))
    text = (
        f"`camera.render()` returned an array of shape {np.shape(rgb)}, dtype "
        f"{np.asarray(rgb).dtype}, and raised nothing. The course's test of it: {quoted(error)}"
    )
    shown = isinstance(error, FrameError) and "empty picture" in str(error)
    return Mistake("picture_of_nothing", shown, text)


def kept_reading(scene: Any, box: Any, case: Drop) -> Mistake:
    """Read the state once before the loop and use that value afterwards."""
    scene.reset()
    kept = box.get_pos()
    for _ in range(case.steps):
        scene.step()
    old, new = (float(np.asarray(of.cpu())[2]) for of in (kept, box.get_pos()))
    text = (
        f"`z = box.get_pos()[2]` from before the loop is still {old:.4f} m after {case.steps} "
        f"steps; a new reading is {new:.4f} m."
    )
    return Mistake("kept_reading", old != new, text)
