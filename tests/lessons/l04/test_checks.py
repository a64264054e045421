from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import with_trace
from lessons.lesson_bundles import differing_outputs

from robo_genesis.core.checks import Check, CheckFailed, require
from robo_genesis.core.experiment import runs_of
from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l04 import spec
from robo_genesis.lessons.l04.checks import CHECKS

NAMES = [check.__name__ for check in CHECKS]


def changed(values, index, value):
    array = np.array(values)
    array[index] = value
    return array


def with_links(run, count):
    return replace(run, readings={"model": {**run.readings["model"], "links": count}})


def with_joints(run, **fields):
    return replace(run, joints=replace(run.joints, **fields))


def with_case(run, name, **fields):
    cases = {**run.cases, name: replace(run.cases[name], **fields)}
    return replace(run, page=replace(run.page, runs=runs_of(cases)))


def case_value(run, name, field, index, value):
    return with_case(run, name, **{field: changed(getattr(run.cases[name], field), index, value)})


def trace_value(run, name, field, index, value):
    array = changed(getattr(run.traces[name], field), index, value)
    return with_trace(run, name, **{field: array})


def with_metrics(run, name, **fields):
    found = replace(run)  # its metrics are computed at their first use
    vars(found)["metrics"] = {**run.metrics, name: replace(run.metrics[name], **fields)}
    return found


def with_final(run, frame):
    return replace(run, frames={**run.frames, "final": frame})


def swapped(of_cases):
    return {**of_cases, "G1": of_cases["G2"], "G2": of_cases["G1"]}


SPOILERS = {
    "mapping": {
        "a link is missing": lambda run: with_links(run, 10),
        "another name": lambda run: with_joints(run, names=("base", *run.joints.names[1:])),
        "another type": lambda run: with_joints(run, types=("REVOLUTE",) * 9),
        "a shared DOF": lambda run: with_joints(run, dofs_idx_local=np.arange(9) // 2),
    },
    "configuration": {
        "a gain is NaN": lambda run: case_value(run, "baseline", "kp", 0, np.nan),
        "a gain is missing": lambda run: with_case(run, "baseline", kv=spec.BASELINE.kv[:8]),
        "no lower limit": lambda run: with_joints(run, lower=changed(run.joints.lower, 0, -np.inf)),
    },
    "target_limits": {
        "a start outside": lambda run: case_value(run, "baseline", "q_start", 8, 0.05),
        "a narrower model": lambda run: with_joints(run, upper=changed(run.joints.upper, 3, -1.9)),
    },
    "baseline_approaches": {
        "it ends where it began": lambda run: with_metrics(run, "baseline", final_error=0.25),
        "it ends farther": lambda run: with_metrics(run, "baseline", final_error=0.3),
    },
    "stamps": {
        "one step less": lambda run: with_case(run, "baseline", steps=spec.STEPS - 1),
        "another time step": lambda run: with_metrics(
            with_trace(run, "G2", t=run.traces["G2"].t * (1 + 1e-6)),
            "G2",
            saturation_duration=run.metrics["G2"].saturation_duration,
        ),
        "another target on the way": lambda run: trace_value(run, "G1", "target", (5, 0), 0.1),
    },
    "same_start": {
        "a start that moves": lambda run: trace_value(run, "G2", "start_qd", 1, 1e-6),
        "another position": lambda run: trace_value(run, "G3", "q", (0, 0), 1e-6),
        "another pose": lambda run: trace_value(run, "G3", "link_pos", (0, 1, 2), 0.6),
    },
    "one_factor": {
        "two gains": lambda run: case_value(run, "G3", "kp", 0, 4501.0),
        "none": lambda run: with_case(run, "G1", kp=run.cases["G2"].kp),
        "another seed": lambda run: with_case(run, "G2", seed=1),
    },
    "control_law": {
        "the run of another case": lambda run: replace(run, traces=swapped(run.traces)),
        "another gain": lambda run: case_value(run, "baseline", "kv", 3, 349.0),
    },
    "not_observed": {
        "a rise withheld": lambda run: with_metrics(run, "G1", rise_time=None),
        "a rise too late": lambda run: with_metrics(run, "G1", rise_time=1.2),
        "settling withheld": lambda run: with_metrics(run, "G2", settling_time=None),
        "settling too early": lambda run: with_metrics(run, "G2", settling_time=0.01),
    },
    "measurements": {
        "an excessive force": lambda run: trace_value(run, "G1", "control_force", (4, 0), -87.1),
    },
    "saturation": {
        "another count": lambda run: with_metrics(run, "G2", saturation_samples=999),
        "another duration": lambda run: with_metrics(run, "G2", saturation_duration=9.0),
        "another limit read back": lambda run: trace_value(run, "G1", "effort_limit", 0, 90.0),
    },
    "posture": {
        "no frames": lambda run: replace(run, frames={}),
        "one frame": lambda run: replace(run, frames={"final": run.frames["final"]}),
        "an empty frame": lambda run: with_final(run, np.zeros_like(run.frames["final"])),
        "the same frame twice": lambda run: with_final(run, run.frames["initial"]),
        "frames with a schematic": lambda run: replace(run, rendered=False),
        "a schematic that stands still": lambda run: with_trace(
            replace(run, rendered=False, frames={}),
            "baseline",
            link_pos=np.ones_like(run.traces["baseline"].link_pos),
        ),
    },
}  # fmt: skip
SPOILED = [(name, how) for name, spoilers in SPOILERS.items() for how in spoilers]


@pytest.fixture
def outcomes_of(monkeypatch):
    """Run the checks with the cases of the run as those of the lesson."""

    def outcomes(run):
        monkeypatch.setattr(spec, "CASES", run.cases)
        return run.outcomes()

    return outcomes


def test_every_check_has_a_spoiler():
    assert list(SPOILERS) == NAMES


def test_a_sound_run_passes(experiment):
    outcomes = experiment.outcomes()
    assert [(c.name, c.passed) for c in outcomes] == [(name, True) for name in NAMES]
    assert all(c.detail.endswith(".") for c in outcomes)
    assert require("l04", outcomes) == "L04 CHECK: PASSED"
    require("l04", replace(experiment, rendered=False, frames={}).outcomes())


@pytest.mark.parametrize(("name", "how"), SPOILED, ids=[f"{n}-{h}" for n, h in SPOILED])
def test_what_is_spoiled_fails_its_own_check_and_no_other(experiment, outcomes_of, name, how):
    outcomes = outcomes_of(SPOILERS[name][how](experiment))
    failed = {c.name for c in outcomes if not c.passed}
    assert name in failed
    assert failed <= {name, "control_law"}  # it ties gains, limits and forces: it may see more
    with pytest.raises(CheckFailed, match=rf"^L04 CHECK: FAILED .*\[{name}\] \S"):
        require("l04", outcomes)


def test_an_unknown_joint_type_has_no_unit(experiment):
    run = with_joints(experiment, types=("SPHERICAL",) * 9)
    failed = {c.name: c.detail for c in run.outcomes() if not c.passed}
    assert set(failed) == {"mapping", "configuration"}
    assert "SPHERICAL" in failed["configuration"]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda run: with_case(run, "G1", q_start=run.cases["G1"].q_start[:8]),
        lambda run: with_case(run, "G1", kp=run.cases["G1"].kp[:8]),
        lambda run: with_joints(run, upper=run.joints.upper[:8]),
    ],
    ids=["start", "gains", "limits"],
)
def test_a_wrong_length_is_named_and_does_not_stop_the_other_checks(experiment, outcomes_of, spoil):
    outcomes = outcomes_of(spoil(experiment))
    assert [c.name for c in outcomes] == NAMES
    assert "configuration" in {c.name for c in outcomes if not c.passed}


def test_every_failed_check_is_named_and_no_check_is_a_failure():
    outcomes = (Check("a", False, "x"), Check("b", True, "held."), Check("c", False, "y"))
    with pytest.raises(CheckFailed, match=r"^L04 CHECK: FAILED \[a\] x \[c\] y$"):
        require("l04", outcomes)
    with pytest.raises(CheckFailed, match="no check ran"):
        require("l04", ())


def test_what_the_lab_shows_follows_from_its_bundle(pristine, experiment):
    assert differing_outputs(pristine, experiment, BOOK) == []
