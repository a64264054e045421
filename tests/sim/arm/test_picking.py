"""Batches of several cases in one scene."""

import numpy as np
import pytest

from robo_genesis.core.trace import Episodes
from robo_genesis.lessons.l08.rates import CASES
from robo_genesis.sim.arm import picking
from robo_genesis.sim.session import CaseError


def test_cases_together_keep_their_rows():
    timed, paced = CASES["timed"], CASES["paced"]
    both = picking.together([timed, paced])
    for rows, case in ((slice(64), timed), (slice(64, None), paced)):
        for name in picking.OF_ENVIRONMENTS:
            own = getattr(case, name)
            expected = np.broadcast_to(own, (len(case.starts), *np.shape(own)[1:]))
            assert np.array_equal(getattr(both, name)[rows], expected), name


def test_cases_that_differ_in_more_than_rows_are_refused():
    with pytest.raises(
        CaseError, match=r"differ in cone, which .* only starts, .* may"
    ):
        picking.together([CASES["plain"], CASES["elliptic"]])


def test_runs_of_some_environments_keep_the_times():
    t, rows = np.arange(3.0), np.arange(12.0).reshape(3, 4)
    wide = [np.repeat(rows[..., None], k, axis=2) for k in (9, 3, 4, 2)]
    part = Episodes(t, rows, *wide, rows).of(slice(1, 3))
    assert part.t.tolist() == t.tolist()
    assert part.phase.tolist() == part.force[..., 1].tolist() == rows[:, 1:3].tolist()
