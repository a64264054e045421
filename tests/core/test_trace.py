"""A trace accepts only arrays that form one run, and never changes."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest

from robo_genesis.core.trace import Trace, TraceError

FIELDS = [field.name for field in fields(Trace)]


@pytest.fixture
def trace(traces):
    return traces["G1"]


def test_arrays_are_read_only_and_its_own(trace):
    q = np.array(trace.q)
    copy = replace(trace, q=q)
    q[:] = 7
    assert (copy.q == trace.q).all()
    assert not any(getattr(copy, name).flags.writeable for name in FIELDS)


@pytest.mark.parametrize("name", FIELDS)
def test_a_value_that_is_not_finite_is_refused_with_its_place(trace, name):
    array = np.array(getattr(trace, name), dtype=float)
    array.flat[1] = np.nan
    place = [int(k) for k in np.unravel_index(1, array.shape)]
    with pytest.raises(
        TraceError, match=re.escape(f"{name} is not finite at index {place}.")
    ):
        replace(trace, **{name: array})


@pytest.mark.parametrize("name", FIELDS)
def test_a_wrong_length_and_a_missing_axis_are_refused(trace, name):
    array = getattr(trace, name)
    for wrong in (array[:-1], array.ravel()[:0]):
        with pytest.raises(TraceError, match="shape"):
            replace(trace, **{name: wrong})


def test_a_run_without_a_step_is_refused(make_trace):
    with pytest.raises(TraceError, match="run of 0 steps"):
        make_trace([0.0], 1.0)


@pytest.mark.parametrize(
    ("t", "message"),
    [
        (np.arange(121) * 0.01 + 0.01, r"t\[120\] is"),
        (np.arange(121) * 0.01 + 1e-6 * (np.arange(121) == 60), r"t\[60\]"),
        (np.arange(121) * 0.0, "k · dt"),
    ],
)
def test_times_start_at_zero_and_are_multiples_of_a_positive_dt(trace, t, message):
    with pytest.raises(TraceError, match=message):
        replace(trace, t=t)
