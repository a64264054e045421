import numpy as np
import pytest

from robo_genesis.lessons.l04.metrics import StepMetrics, step_metrics

STEP = 0.25


def test_every_number_of_a_small_run(make_trace):
    trace = make_trace(
        [0.0, 0.5, 1.125, 1.0],
        1.0,
        dt=0.5,
        qd=[1.0, -2.0, 0.25],
        control_force=[8.0, -4.0, 2.0],
        effort_limit=8.0,
    )
    assert step_metrics(trace, 0) == StepMetrics(
        initial_error=1.0,
        rise_time=1.0,
        overshoot=0.125,
        settling_time=1.5,
        final_error=0.0,
        final_velocity=0.25,
        peak_speed=2.0,
        peak_control=8.0,
        saturation_samples=1,
        saturation_duration=0.5,
    )


@pytest.mark.parametrize(
    ("q", "target", "rise", "settled"),
    [
        (np.linspace(0, 0.2, 21), STEP, None, None),  # the window ends before either
        ([0, 0.9 * STEP], STEP, 0.01, None),  # exactly on the threshold of the rise
        ([0, np.nextafter(0.9 * STEP, 0)], STEP, None, None),
        (
            [0, 0.25, 0.25, 0.28, 0.25, 0.25],
            STEP,
            0.01,
            0.04,
        ),  # leaves the band once more
        (
            [0, 0.25, 0.25, 0.28],
            STEP,
            0.01,
            None,
        ),  # outside the band at the last sample
        ([0, 0.002, 0.004], 0.005, None, 0),  # a step within the band
        ([-STEP, 0.01], 0, 0.01, 0.01),  # the band includes its edges
        ([-STEP, np.nextafter(-0.01, -1)], 0, 0.01, None),
    ],
)
def test_rise_and_settling_at_their_edges(make_trace, q, target, rise, settled):
    m = step_metrics(make_trace(q, target), 0)
    assert m.rise_time == rise
    assert m.settling_time == (None if settled is None else pytest.approx(settled))


@pytest.mark.parametrize(
    ("force", "samples"), [(99.0, 1), (-99.0, 1), (98.9999, 0), (-100.0, 1)]
)
def test_saturation_counts_either_sign_from_the_threshold_on(
    make_trace, force, samples
):
    trace = make_trace([0, 0, 0], STEP, control_force=[0.0, force], effort_limit=100.0)
    m = step_metrics(trace, 0)
    assert (m.saturation_samples, m.saturation_duration) == (
        samples,
        samples * trace.dt,
    )


def test_a_step_that_does_not_rise_is_refused(make_trace):
    with pytest.raises(ValueError, match="positive"):
        step_metrics(make_trace([0, 0, 0], 0.0), 0)
