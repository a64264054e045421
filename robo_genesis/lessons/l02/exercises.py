"""Checks of the four functions that a student writes in L02's lab; see `core/exercises.py`."""

from typing import Any

import numpy as np

from robo_genesis.core.checks import Findings, equal, nearly, within
from robo_genesis.core.exercises import Written, as_test, same_array
from robo_genesis.core.scene import FRAME_SHAPE
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.bodies.free_fall import summed_drop
from robo_genesis.sim.bodies.rigid_bodies import Drop

from . import spec

MEASURES = False

TINY = 1e-6  # Largest difference of a height [m] that rounding explains

FAST = 1e-5  # Largest difference of a speed [m/s] that rounding explains

UNTIL_REST = 100  # Outer steps after which a dropped box lies on the ground


@as_test
def scene(make: Written, gs: Any, case: Drop) -> Findings:
    """Check `make(gs)`: a built scene with a ground, and the box of a case, which falls on it."""
    built, box = make(gs)
    yield within("dt_s", built.dt, case.dt, 1e-9)
    yield equal("substeps", built.substeps, case.substeps)
    yield nearly("mass_kg", float(box.get_mass()), case.mass, 1e-3)
    yield within("start_height_m", _height(box), case.height, TINY)
    for _step in range(case.steps):
        built.step()
    fallen = case.height - _height(box)
    expected = summed_drop(case.h, case.steps * case.substeps, case.gravity)
    yield within("distance_fallen_m", fallen, expected, TINY)
    for _step in range(UNTIL_REST):
        built.step()
    yield within("height_at_rest_m", _height(box), case.size / 2, spec.RESTING)


@as_test
def record(read: Written, built: Any, box: Any, trace: BodyTrace) -> Findings:
    """Check `read(scene, box, steps)`: heights [m] and speeds along z [m/s] of a run.

    Args:
        read: the student's function.
        built: the scene, in any state.
        box: the box.
        trace: a run of this scene, from its reset.
    """
    heights, speeds = read(built, box, trace.steps)
    expected = trace.link_pos[:, 0, 2], trace.link_vel[:, 0, 2]
    yield from same_array("heights_m", heights, expected[0], TINY)
    yield from same_array("speeds_m_s", speeds, expected[1], FAST)
    again, _speeds = read(built, box, trace.steps)
    yield from same_array("second_run.heights_m", again, expected[0], TINY)


@as_test
def usable_frame(usable: Written) -> Findings:
    """Check `usable(rgb)`: whether a frame has the course's shape and type and shows something."""
    background = np.empty(FRAME_SHAPE, np.uint8)
    background[:] = (20, 30, 40)
    box = background.copy()
    box[200:300, 300:400] = (200, 120, 30)
    pixel = background.copy()
    pixel[-1, -1] = (21, 30, 40)
    frames = {
        "a_box": (box, True),
        "one_pixel": (pixel, True),
        "background_alone": (background, False),
        "floats": (box / 255, False),
        "rows_and_columns_exchanged": (box.swapaxes(0, 1), False),
    }
    for name, (rgb, expected) in frames.items():
        yield equal(name, usable(rgb), expected)


@as_test
def stepped(fall: Written) -> Findings:
    """Check `fall(g, h, n)`: distances by semi-implicit Euler, before and after each step."""
    for name, g, h, n in (
        ("baseline", spec.BASELINE.gravity, spec.BASELINE.h, 40),
        ("on_the_moon", spec.MOON, 0.02, 7),
    ):
        expected = summed_drop(h, np.arange(n + 1), g)
        yield from same_array(f"{name}_m", fall(g, h, n), expected, 1e-9)


def _height(body: Any) -> float:
    return float(to_numpy(body.get_pos())[2])
