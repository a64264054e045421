"""Checks of the functions that a student writes in L01's lab; see `core/exercises.py`."""

from typing import Any

from robo_genesis.core.checks import Findings
from robo_genesis.core.exercises import Written, as_test, same_array
from robo_genesis.sim.bodies.free_fall import summed_drop

from . import spec

MEASURES = False

TINY = 1e-9  # Largest difference that rounding explains in float64 [m]


@as_test
def height_after(height: Written) -> Findings:
    """Check `height(z0, g, h, n)`: the height [m] after n solver steps from rest."""
    case = spec.BASELINE
    for name, z0, g, h, n in (
        ("baseline", case.height, case.gravity, case.h, case.steps * case.substeps),
        ("on_the_moon", 2.0, 1.62, 0.02, 7),
        ("below_the_floor", 0.5, case.gravity, 0.01, 100),
    ):
        expected = z0 - summed_drop(h, n, g)
        yield from same_array(f"{name}_m", height(z0, g, h, n), expected, TINY)


@as_test
def fall(run: Written, scene: Any, sphere: Any) -> Findings:
    """Check `run(scene, sphere, steps)`: the last height [m] after a reset, twice and shorter."""
    case = spec.BASELINE
    for name, steps in (("first", case.steps), ("again", case.steps), ("shorter", 5)):
        expected = case.height - summed_drop(
            case.h, steps * case.substeps, case.gravity
        )
        found = run(scene, sphere, steps)
        yield from same_array(
            f"{name}.height_m", found, expected, spec.FORMULA_TOLERANCE
        )
