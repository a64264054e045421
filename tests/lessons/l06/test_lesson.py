"""The checks of L06 accept a landing and name what is wrong with another run."""

import numpy as np
import pytest

from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06 import LAB, spec


def landing(end: float = 0.05, speed: float = 0.0, steps: int = spec.BASELINE.steps) -> BodyTrace:
    position, velocity, still = (np.zeros((steps + 1, 1, 3)) for _ in range(3))
    position[:, 0, 2] = np.linspace(spec.BASELINE.height, end, steps + 1)
    velocity[-1, 0, 2] = speed
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (steps + 1, 1, 1))
    return BodyTrace(np.arange(steps + 1) * spec.BASELINE.dt, position, upright, velocity, still)


@pytest.mark.parametrize(
    ("trace", "links", "rendered", "failed"),
    [
        (landing(), 1, True, []),
        (landing(), 2, True, ["structure"]),
        (landing(steps=10), 1, True, ["times"]),
        (landing(end=0.055), 1, True, ["lands"]),
        (landing(speed=0.1), 1, True, ["lands"]),
        (landing(), 1, False, ["posture"]),
    ],
)
def test_each_check_fails_on_its_own_fault(trace, links, rendered, failed, frames):
    readings = {"model": spec.EXPECTED_MODEL | {"links": links}}
    run = Experiment(LAB, {"baseline": trace}, [spec.LINK], readings, frames, rendered)
    assert [check.name for check in run.outcomes() if not check.passed] == failed
