from dataclasses import fields, replace

import numpy as np
import pytest

from robo_genesis.core.trace import Trace, TraceError

FIELDS = [field.name for field in fields(Trace)]


@pytest.fixture
def trace(traces):
    return traces["G1"]


def test_a_run_of_n_steps_has_n_plus_one_states(trace):
    assert (trace.steps, len(trace.t), len(trace.q), len(trace.qd)) == (120, 121, 121, 120)
    assert trace.dt == 0.01
    assert trace.t_step.tolist() == trace.t[1:].tolist()


@pytest.mark.parametrize("name", FIELDS)
def test_arrays_are_read_only(trace, name):
    with pytest.raises(ValueError, match="read-only"):
        getattr(trace, name)[...] = 0


def test_arrays_are_its_own(trace):
    q = np.array(trace.q)
    copy = replace(trace, q=q)
    q[:] = 7
    assert (copy.q == trace.q).all()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", FIELDS)
def test_a_value_that_is_not_finite_is_refused_with_its_place(trace, name, value):
    array = np.array(getattr(trace, name), dtype=float)
    array.flat[1] = value
    place = [int(k) for k in np.unravel_index(1, array.shape)]
    with pytest.raises(TraceError) as caught:
        replace(trace, **{name: array})
    assert str(caught.value) == f"{name} is not finite at index {place}."


@pytest.mark.parametrize("name", FIELDS)
def test_a_wrong_length_is_refused(trace, name):
    with pytest.raises(TraceError, match="shape"):
        replace(trace, **{name: getattr(trace, name)[:-1]})


@pytest.mark.parametrize("name", FIELDS)
def test_a_missing_axis_is_refused(trace, name):
    with pytest.raises(TraceError, match="shape"):
        replace(trace, **{name: getattr(trace, name).ravel()[:0]})


def test_a_state_before_the_first_step_is_required(trace):
    with pytest.raises(TraceError, match=r"qd has shape .* a run of 119 steps has 120 states"):
        replace(
            trace,
            t=trace.t[:-1],
            q=trace.q[1:],
            link_pos=trace.link_pos[1:],
            link_quat=trace.link_quat[1:],
        )


def test_a_run_without_a_step_is_refused(make_trace):
    with pytest.raises(TraceError, match="run of 0 steps"):
        make_trace([0.0], 1.0)


def test_stamps_start_at_zero(trace):
    with pytest.raises(TraceError, match=r"t starts at 0\.01 s, expected 0"):
        replace(trace, t=trace.t + 0.01)


def test_stamps_are_multiples_of_dt(trace):
    t = np.array(trace.t)
    t[60] += 1e-6
    with pytest.raises(TraceError, match=r"t\[60\]"):
        replace(trace, t=t)


@pytest.mark.parametrize("dt", [0.0, -0.01])
def test_time_runs_forward(trace, dt):
    with pytest.raises(TraceError, match="k · dt"):
        replace(trace, t=np.arange(121) * dt)
