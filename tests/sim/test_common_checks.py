"""The checks that lessons share: which runs they judge, and which frames."""

from dataclasses import replace

import pytest
from lessons.changed_runs import failed, trace

from robo_genesis.core.check_spec import TIME_TOLERANCE
from robo_genesis.core.experiment import Run
from robo_genesis.sim import common_checks


def problems(findings):
    return [finding.label for finding in findings if not finding.passed]


def test_the_times_of_every_run_are_judged(experiment):
    """A page of L04 has runs beside the four that its lab compares."""
    longer = replace(experiment.cases["G1"], steps=2 * experiment.cases["G1"].steps)
    page = replace(
        experiment.page, runs={**experiment.page.runs, "longer": Run(longer, False)}
    )
    traces = {**experiment.traces, "longer": experiment.traces["G1"]}
    run = replace(experiment, page=page, traces=traces)
    assert problems(common_checks.stamps(run)) == ["longer.steps"]
    assert failed(run) == {"stamps"}
    shifted = trace("G1", t=lambda t: (1 + 2 * TIME_TOLERANCE) * t)(experiment)
    assert problems(common_checks.stamps(shifted)) == ["G1.time_error_s"]


@pytest.mark.parametrize(
    ("names", "declared", "rendered", "found"),
    [
        (("initial", "final", "view"), ("view",), True, []),
        (("initial", "final", "view"), (), True, ["frames"]),
        ((), ("view",), False, []),
        (("view",), ("view",), False, ["frames"]),
    ],
)
def test_frames_are_both_ends_and_the_declared_views(
    experiment, names, declared, rendered, found
):
    pictures = {
        name: experiment.frames.get(name, experiment.frames["final"]) for name in names
    }
    page = replace(experiment.page, frames=("initial", "final", *declared))
    run = replace(experiment, page=page, frames=pictures, rendered=rendered)
    assert problems(common_checks.posture(run)) == found
