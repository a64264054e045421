"""Runs of an experiment with one change, and the checks that fail for them."""

from dataclasses import replace


def failed(run):
    """Return the names of the checks that fail; a changed array may break a law of motion too."""
    laws = {"free_fall", "laws_of_motion"}
    return {check.name for check in run.outcomes() if not check.passed} - laws


def with_trace(run, name, **arrays):
    """Return the run with other arrays in one trace."""
    return replace(run, traces={**run.traces, name: replace(run.traces[name], **arrays)})


def with_reading(run, group, name, value):
    """Return the run with another value that the engine reported."""
    readings = run.readings | {group: run.readings[group] | {name: value}}
    return replace(run, readings=readings)
