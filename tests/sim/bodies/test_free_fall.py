"""Free fall: the formula of the steps is the loop of the steps, and is ahead of g t² / 2."""

import numpy as np
import pytest

from robo_genesis.sim.bodies.free_fall import ahead_of_continuous, continuous_drop, summed_drop


def test_the_formulas_of_free_fall_agree_with_the_loop():
    h, v, drops = 0.005, 0.0, [0.0]
    for _ in range(40):
        v += 9.81 * h
        drops.append(drops[-1] + v * h)  # the new velocity moves the body
    t = h * np.arange(41)
    assert summed_drop(h, np.arange(41)) == pytest.approx(drops, rel=1e-12)
    assert ahead_of_continuous(h, t) == pytest.approx(drops - continuous_drop(t), abs=1e-12)
