"""The worked solution says what a longer record changed, and refuses to compare two experiments."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.lessons.l04.solutions import longer_window, same_beginning, saturated_stretches

DT = 0.01


@pytest.fixture
def run(make_trace):
    """A step of 0.25 rad that ends `low` below its target until `late` samples have passed."""

    def make(samples: int, late: int = 150, wobble: int | None = None):
        k = np.arange(samples)
        q = 0.25 * np.clip(k / 20, 0, 1) - np.where(k < late, 0.02, 0.0) * (k >= 20)
        if wobble is not None:
            q = q + np.where(k == wobble, 0.05, 0.0)
        return make_trace(q, 0.25)

    return make


def measured(trace):
    return trace, step_metrics(trace, 0)


def test_a_longer_record_that_begins_alike_changes_only_what_comes_later(run):
    text = longer_window(measured(run(121)), measured(run(241)))
    assert "bit by bit" in text
    assert "The settling time went from not observed to 1.50 s. It happened after" in text
    assert "The final error went from 0.0200 rad to 0.0000 rad. The last sample" in text
    assert "rise time" in text.split("Unchanged,")[1].split("Could not change")[0]
    assert text.endswith("the first sample's, and the rise time, which had been observed.\n")


def test_a_band_left_again_moves_settling_to_later_and_a_later_peak_moves_overshoot(run):
    text = longer_window(measured(run(121, late=0)), measured(run(241, late=0, wobble=200)))
    assert "The overshoot went from 0.0000 rad to 0.0500 rad. A larger value" in text
    assert "left the band again" in text


def test_a_record_that_settled_and_then_ends_outside_says_so(run):
    text = longer_window(measured(run(121, late=0)), measured(run(241, late=0, wobble=240)))
    assert "The settling time went from 0.20 s to not observed. The response left the band" in text


def test_another_experiment_is_not_explained_by_its_window(run):
    short, long = run(121), run(241, wobble=60)
    assert not same_beginning(short, long)
    text = longer_window(measured(short), measured(long))
    assert "another experiment" in text
    assert "went from" not in text


def test_a_record_of_equal_length_is_no_longer_one(run):
    assert not same_beginning(run(121), run(121))


def test_each_stretch_at_the_limit_is_told_apart_by_what_it_does_to_the_motion(run):
    trace = run(9)
    limit = trace.effort_limit[0]
    force = np.array([[1], [1], [-1], [-1], [0.5], [-1], [1], [1]]) * limit
    speed = np.array([[1], [2], [2], [-1], [-1], [-1], [-0.5], [0.5]])
    told = saturated_stretches(replace(trace, control_force=force, qd=speed), 0)
    assert told == [
        "0.01 s to 0.02 s: positive, drives the motion.",
        "0.03 s to 0.03 s: negative, brakes the motion.",
        "0.04 s to 0.04 s: negative, drives the motion.",
        "0.06 s to 0.06 s: negative, drives the motion.",
        "0.07 s to 0.07 s: positive, brakes the motion.",
        "0.08 s to 0.08 s: positive, drives the motion.",
    ]


def test_a_run_that_is_never_clipped_has_no_stretch(run):
    trace = run(9)
    free = replace(trace, control_force=trace.control_force * 0)
    assert saturated_stretches(free, 0) == ["No sample was at the limit."]
