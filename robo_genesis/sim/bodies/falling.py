"""What arrays of a body that falls freely cannot be, whatever metrics and checks they give.

| tolerance | residual of the CPU runs | value |
|---|---|---|
| `FALLEN`, place | 4e-7 m | 5e-6 m |
| `FALLING`, velocity | 5e-6 m/s | 1e-4 m/s |
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.free_fall import predicted
from robo_genesis.sim.bodies.rigid_bodies import Drop
from robo_genesis.sim.laws import UNTURNED, ZERO, apart, kept, times, unit_quaternions

MEASURES = False

FALLEN, FALLING = 5e-6, 1e-4  # Tolerances of place [m] and velocity [m/s]


def free_fall(run: Any) -> Iterator[Finding]:
    """At each sample place, velocity and orientation are those of a body under gravity alone."""
    for name, case in run.cases.items():
        yield from kept(name, falling(run.traces[name], case))


def falling(trace: BodyTrace, case: Drop) -> Iterator[Finding]:
    """Yield what no run of `rigid_bodies.run_drop` has that ends in the air, upright."""
    yield from times(trace, case.steps, case.dt)
    yield from unit_quaternions(trace.link_quat)
    place, motion = np.zeros((2, trace.steps + 1, 3))
    place[:, 2] = case.height - predicted(trace, case)
    motion[:, 2] = -case.gravity * trace.t
    yield from apart("motion", "link_pos [m]", trace.link_pos[:, 0], place, FALLEN)
    yield from apart("motion", "link_vel [m/s]", trace.link_vel[:, 0], motion, FALLING)
    yield from apart("motion", "link_quat", trace.link_quat[:, 0], UNTURNED, 0.0)
    yield from apart("motion", "link_ang [rad/s]", trace.link_ang[:, 0], ZERO, 0.0)
