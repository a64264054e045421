"""Free fall: the loop, its sum and the continuous fall agree as they must."""

import numpy as np
import pytest

from robo_genesis.sim.bodies.free_fall import (
    ahead_of_continuous,
    continuous_drop,
    stepped_drop,
    summed_drop,
)


@pytest.mark.parametrize(("h", "n"), [(0.1, 1), (0.005, 40), (0.0005, 400)])
def test_three_formulas_of_free_fall_agree(h, n):
    drops = stepped_drop(h, n)
    assert drops[1] == pytest.approx(9.81 * h**2)
    assert summed_drop(h, np.arange(n + 1)) == pytest.approx(drops, rel=1e-12)
    ahead = drops - continuous_drop(h * np.arange(n + 1))
    assert ahead_of_continuous(h, h * np.arange(n + 1)) == pytest.approx(ahead, abs=1e-12)
