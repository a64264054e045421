"""Experiments of a lesson's pages without the engine, and what tests of their checks have alike."""

from dataclasses import replace

from lessons.changed_runs import beginning

from robo_genesis.core.checks import evaluate
from robo_genesis.core.experiment import Experiment


def experiment_of(page, traces, known, links, frames, joints=None) -> Experiment:
    """Return a sound experiment of a page.

    Args:
        page: its declaration; each of its functions passed its test.
        traces: at least its runs, which may be longer.
        known: at least its readings, by group.
        links: names of the links of the traces.
        frames: camera frames; those with a name of the page have this name, others are
            the last.
        joints: of a robot.
    """
    return Experiment(
        page=page,
        traces={
            name: beginning(traces[name], case.steps)
            for name, case in page.cases.items()
        },
        links=links,
        readings={
            group: {
                name: known[group][name] if group in known else 1 for name in of.units
            }
            for group, of in page.readings.items()
        },
        frames={
            name: frames.get(name, frames["final"])
            for name in page.frames * page.camera
        },
        rendered=page.camera,
        joints=joints,
    )


def each(spoilers):
    """Return the pairs (check, spoil) of a table that has for each check functions of a run."""
    return [(check, spoil) for check, spoils in spoilers.items() for spoil in spoils]


def run_with(experiments, check):
    """Return the run of the first page that has a check, with this check alone."""
    for run in experiments.values():
        if found := [one for one in run.page.checks if one.__name__ == check]:
            return replace(run, page=replace(run.page, checks=found))
    raise LookupError(f"No page has the check {check}.")


def checks_of(experiments):
    """Return the names of the checks of all pages; laws and functions have tests of their own."""
    found = {
        check.__name__ for run in experiments.values() for check in run.page.checks
    }
    return found - {"laws_of_motion", "functions"}


def require_spoilers(run, spoilers):
    """Require that all checks but laws pass; and of each, that it fails for a spoiled run.

    `spoilers` are pairs (check, spoil).
    """
    named = {check.__name__: check for check in run.page.checks}
    assert named.keys() - {name for name, _ in spoilers} <= {"laws_of_motion"}
    assert {one.name for one in run.outcomes() if not one.passed} <= {"laws_of_motion"}
    for k, (name, spoil) in enumerate(spoilers):
        assert not evaluate([named[name]], spoil(run))[0].passed, (k, name)
