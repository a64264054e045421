"""Checks of the five functions that a student writes in L03's lab; see `core/exercises.py`."""

from collections.abc import Iterable, Mapping
from typing import Any
from unittest.mock import patch

import numpy as np

from robo_genesis.core.checks import Findings, at_most, equal, nearly, within
from robo_genesis.core.exercises import Written, as_test, compared
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.arm.joints import to_numpy
from robo_genesis.sim.bodies.contacts import SURFACE_SIZE, TOP, ContactCase, friction

from .metrics import LandingMetrics, SlideMetrics, clearance, of_body

MEASURES = False

TINY = 1e-6  # Largest difference of a returned length or time that rounding explains

SUNK = 2e-3  # How deep a cube at rest may be in the table [m]


@as_test
def scene(make: Written, gs: Any, case: ContactCase) -> Findings:
    """Check `make(gs)`: a built scene, a fixed table and the cube of a case, which lands on it."""
    built, table, cube = make(gs)
    yield within("dt_s", built.dt, case.dt, 1e-9)
    yield equal("substeps", built.substeps, case.substeps)
    yield nearly("mass_of_the_cube_kg", float(cube.get_mass()), case.mass, 1e-3)
    for name, body, mu in (
        ("cube", cube, case.friction),
        ("table", table, case.surface_friction),
    ):
        yield within(f"friction_of_the_{name}", friction(built, body), mu, 1e-6)
    height = to_numpy(cube.get_pos())[2]
    yield within("start_height_m", height, case.start[2], TINY)
    before = to_numpy(table.get_pos())
    for _step in range(case.steps):
        built.step()
    moved = np.abs(to_numpy(table.get_pos()) - before).max()
    yield at_most("the_table_moved_by_m", moved, TINY)
    top = float(before[2]) + SURFACE_SIZE[2] / 2
    yield within("upper_face_of_the_table_m", top, TOP, TINY)
    resting = to_numpy(cube.get_pos())[2]
    yield within("height_of_the_resting_cube_m", resting, case.rest_height, SUNK)


@as_test
def push(push_cube: Written, built: Any, cube: Any, case: ContactCase) -> Findings:
    """Check `push_cube(scene, cube, speed, settle)`: settle first, then a speed along x alone.

    Args:
        push_cube: the student's function.
        built: a scene with the cube on the table.
        cube: the cube.
        case: gives speed, time to settle and outer step.
    """
    built.reset()
    before = to_numpy(cube.get_pos())
    with patch.object(built, "step", wraps=built.step) as step:
        push_cube(built, cube, case.speed, case.settle)
    yield equal("steps_before_the_push", step.call_count, round(case.settle / case.dt))
    velocity = np.append(to_numpy(cube.get_vel()), to_numpy(cube.get_ang()))
    for name, value in zip(
        ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z"), velocity, strict=True
    ):
        yield within(name, value, case.speed if name == "v_x" else 0.0, 1e-3)
    moved = abs(to_numpy(cube.get_pos())[0] - before[0])
    yield at_most("moved_before_the_push_m", moved, 1e-3)


@as_test
def contact_reading(read: Written) -> Findings:
    """Check `read(cube, table)`: number of contacts with the table alone, and the deepest [m]."""
    table, other = object(), object()
    touching = {
        "four_corners": {table: [0.001, 0.004, 0.002, 0.003]},
        "nothing": {},
        "another_body": {table: [0.002], other: [0.005, 0.006]},
    }
    for name, depths in touching.items():
        expected = depths.get(table, [])
        right = len(expected), max(expected, default=0.0)
        found = read(_Touching(depths), table)
        yield from compared(name, ("count", "deepest"), found, right, TINY)


class _Touching:
    """A body with given penetrations, by the other entity [m]."""

    def __init__(self, depths: Mapping[Any, list[float]]) -> None:
        self.depths = {id(entity): values for entity, values in depths.items()}

    def get_contacts(self, with_entity: Any = None, **_: Any) -> dict[str, Any]:
        import torch

        found = self.depths.get(id(with_entity), [])
        if with_entity is None:
            found = [depth for each in self.depths.values() for depth in each]
        return {"penetration": torch.tensor(found)}


@as_test
def landing(
    measure: Written, runs: Iterable[tuple[ContactTrace, ContactCase, LandingMetrics]]
) -> Findings:
    """Check `measure(clear)`: penetration and rebound [m] of a landing, from its clearance (n,)."""
    names = ("penetration", "rebound")
    for number, (trace, case, of) in enumerate(runs):
        found = measure(clearance(trace, case))
        yield from compared(
            f"run_{number}", names, found, (of.penetration, of.rebound), TINY
        )
    for name, clear, expected in (
        ("never_lands", [0.3, 0.2, 0.1], (0.0, 0.0)),
        ("jumps", [0.2, 0.0, -0.001, 0.003, -0.004, 0.001], (0.004, 0.003)),
    ):
        yield from compared(name, names, measure(np.array(clear)), expected, TINY)


@as_test
def stopping(
    measure: Written, runs: Iterable[tuple[ContactTrace, SlideMetrics]]
) -> Findings:
    """Check `measure(t, x, speed)`: stop time and distance by the rule with a hold, or None."""
    names = ("stop_time", "stop_distance")
    for number, (trace, of) in enumerate(runs):
        x, speed = of_body(trace.link_pos)[:, 0], of_body(trace.link_vel)[:, 0]
        found = measure(trace.t, x, speed)
        expected = of.stop_time, of.stop_distance
        yield from compared(f"run_{number}", names, found, expected, TINY)
    t = np.arange(30) * 0.01
    x = np.linspace(1.0, 1.5, 30)
    back = np.full(30, 0.0)
    back[:2], back[6] = 1.0, -0.5
    found = measure(t, x, back)
    yield from compared("rocks_back", names, found, (t[7], x[7] - x[0]), TINY)
    going = np.append(np.full(25, 0.5), np.zeros(5))
    yield from compared(
        "ends_too_early", names, measure(t, x, going), (None, None), TINY
    )
