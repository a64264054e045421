"""Tables and sentences of the lecture alone: each number is the run's."""

from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.lessons.l04 import lecture_text, spec, study, study_spec, theory_text
from robo_genesis.lessons.l04.metrics import step_metrics


@pytest.fixture
def run(make_trace):
    """Trace and metrics of a step of 0.25 rad that ends below its target until sample `late`."""

    def make(samples: int, late: int = 150, wobble: int | None = None):
        k = np.arange(samples)
        q = 0.25 * np.clip(k / 20, 0, 1) - np.where(k < late, 0.02, 0.0) * (k >= 20)
        if wobble is not None:
            q = q + np.where(k == wobble, 0.05, 0.0)
        trace = make_trace(q, 0.25)
        return trace, step_metrics(trace, 0)

    return make


@pytest.mark.parametrize(
    ("late", "wobble", "says"),
    [
        (150, None, ["records are bit-identical", "the rise time, which had already been observed.",
         "The settling time went from not observed to 1.50 s. It happened after",
         "The final error went from 0.0200 rad to 0.0000 rad. The last sample is another one.",
         "Unchanged in the digits written here: rise time; "]),
        (0, 200, ["The overshoot went from 0.0000 rad to 0.0500 rad. A larger value",
         "left the band again"]),
        (0, 240, ["The settling time went from 0.20 s to not observed. The response left"]),
    ],
)  # fmt: skip
def test_a_longer_record_changes_only_what_comes_later(run, late, wobble, says):
    text = lecture_text.window_changes(run(121, late), run(241, late, wobble))
    assert [phrase for phrase in says if phrase not in text] == []


def test_another_experiment_is_not_explained_by_its_window(run):
    short, long = run(121), run(241, wobble=60)
    assert not study.same_beginning(short[0], long[0])
    assert not study.same_beginning(short[0], short[0])  # no longer record
    text = lecture_text.window_changes(short, long)
    assert "another experiment" in text
    assert "went from" not in text


def test_each_saturated_stretch_drives_or_brakes(run):
    trace, _ = run(9)
    force = np.array([[1], [1], [-1], [-1], [0.5], [-1], [1], [1]]) * trace.effort_limit[0]
    speed = np.array([[1], [2], [2], [-1], [-1], [-1], [-0.5], [0.5]])
    assert lecture_text.saturated_stretches(replace(trace, control_force=force, qd=speed), 0) == [
        "0.01 s to 0.02 s: the force is positive and drives the motion.",
        "0.03 s to 0.03 s: the force is negative and brakes the motion.",
        "0.04 s to 0.04 s: the force is negative and drives the motion.",
        "0.06 s to 0.06 s: the force is negative and drives the motion.",
        "0.07 s to 0.07 s: the force is positive and brakes the motion.",
        "0.08 s to 0.08 s: the force is positive and drives the motion.",
    ]
    free = replace(trace, control_force=trace.control_force * 0)
    assert lecture_text.saturated_stretches(free, 0) == ["No sample was at the limit."]


def test_force_ranges_are_those_that_were_read_back(study_runs):
    baseline = study_runs.traces["baseline"]
    weaker = replace(baseline, effort_limit=baseline.effort_limit - 1)
    run = replace(study_runs, traces=study_runs.traces | {"baseline": weaker})
    lines = lecture_text.force_ranges(run).splitlines()
    assert lines[5].split(" | ")[0] == "| joint4"
    assert lines[5].endswith(" -86 … 86 N·m |")
    assert lines[-1].endswith(" -99 … 99 N |")


def test_the_first_demand_is_compared_with_what_is_delivered(study_runs):
    rows = [row.split("|")[1:-1] for row in lecture_text.first_demand(study_runs).splitlines()[2:]]
    assert [[cell.strip() for cell in row[:3]] for row in rows] == [
        ["G1", "875 N·m", "87 N·m"], ["G2", "1750 N·m", "87 N·m"], ["G3", "1750 N·m", "87 N·m"],
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("start", "force", "until"),
    [
        (87.0, (87.0, 87.0, 50.0, 87.0), 0.02),
        (87.0, (87.0, -87.0, 87.0, 87.0), 0.01),
        (87.0, (50.0, 87.0, 87.0, 87.0), 0.0),
        (87.0, (87.0, 87.0, 87.0, 87.0), 0.04),
        (50.0, (87.0, 87.0, 87.0, 87.0), None),
    ],
)
def test_the_effort_is_clipped_until_it_leaves_its_first_limit(make_trace, start, force, until):
    trace = make_trace(np.zeros(5), 1.0)
    limit = trace.effort_limit[0]
    run = replace(
        trace,
        control_force=np.array(force)[:, None] * limit / 87.0,
        start_control_force=np.array([start * limit / 87.0]),
    )
    assert lecture_text.clipped_until(run, 0) == until


def test_shared_starts_are_described_for_each_pair(study_runs):
    lines = lecture_text.shared_starts(study_runs).splitlines()
    assert lines[0].startswith("- G1 and G2: Up to ")
    assert lines[1].startswith("- G2 and G3: Up to ")


@pytest.mark.parametrize(
    ("until", "says"),
    [
        ([0.07, 0.09], "G1 leaves the limit before G2: G1 stays there until 0.07 s, G2 until 0.09"),
        ([0.09, 0.07], "G2 leaves the limit before G1: G1 stays there until 0.09 s, G2 until 0.07"),
        ([0.09, 0.09], "Both efforts stay at the limit until 0.09 s."),
        ([None, 0.09], "at least one of the two efforts is below the limit"),
    ],
)
def test_the_effort_that_leaves_its_limit_first_is_named(until, says):
    assert says in lecture_text.leaving_sentence(("G1", "G2"), until)


def test_the_outcome_of_each_prediction_is_given_with_its_margin(study_runs):
    rows = lecture_text.outcomes_of_predictions(study_runs).splitlines()[2:]
    assert len(rows) == len(spec.RELATIONS)
    assert "| 0.015 s |" in rows[0]
    assert "| 1.5 samples |" in rows[3]
    early = replace(study_runs.metrics["G1"], rise_time=0.12)
    late = replace(study_runs.metrics["G2"], rise_time=0.13)
    run = replace(study_runs, accepted=dict(study_runs.metrics) | {"G1": early, "G2": late})
    row = lecture_text.outcomes_of_predictions(run).splitlines()[2]
    assert row.endswith("| 0.12 s → 0.13 s | 0.015 s | too close to call |")
    near = replace(late, rise_time=0.11)
    run = replace(run, accepted=dict(run.metrics) | {"G2": near})
    row = lecture_text.outcomes_of_predictions(run).splitlines()[2]
    assert row.endswith("| 0.015 s | held (too close to call) |")
    late = replace(late, rise_time=0.14)
    run = replace(run, accepted=dict(run.metrics) | {"G2": late})
    assert lecture_text.outcomes_of_predictions(run).splitlines()[2].endswith("**did not hold** |")
    unseen = {name: replace(run.metrics[name], rise_time=None) for name in ("G1", "G2")}
    run = replace(run, accepted=dict(run.metrics) | unseen)
    assert lecture_text.outcomes_of_predictions(run).splitlines()[2].endswith("cannot be judged |")


def test_the_longer_window_is_that_of_the_recorded_run(study_runs):
    text = lecture_text.longer_window(study_runs)
    assert "The first 1.20 s of both records are bit-identical" in text
    assert study_runs.traces[study_spec.LONGER].t[-1] == pytest.approx(2.4)


def test_masses_are_shown_with_and_without_the_integrator_s_term(study_runs):
    rows = theory_text.mass_table(study_runs).splitlines()[2:]
    masses = [float(row.split("|")[2]) for row in rows]
    inertia = study_runs.readings[study.GROUP]["inertia_Genesis"]
    terms = [0, 0.505, 0, 1.505, 0]  # h (d + KV) with h = 5 ms and d = 1 N·m·s/rad
    assert masses == pytest.approx([inertia + term for term in terms], abs=1e-4)


def test_step_cases_name_their_one_change(study_runs):
    rows = theory_text.step_cases(study_runs).splitlines()[2:]
    assert len(rows) == len(study_spec.STEP_CASES)
    assert rows[0].startswith("| G1 → G1_small | q_target[joint4] | ")
