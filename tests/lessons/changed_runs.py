"""Runs of an experiment with one change, and the checks that fail for them."""

from dataclasses import fields, replace

import numpy as np

from robo_genesis.core.exercises import FUNCTIONS


def failed(run):
    """Return the names of the checks that fail; a changed array may break a law of motion too."""
    laws = {"free_fall", "laws_of_motion"}
    return {check.name for check in run.outcomes() if not check.passed} - laws


def passed(page):
    """Return the readings of a page on which every function passed its test."""
    return {FUNCTIONS: dict.fromkeys(page.readings[FUNCTIONS].units, 1)}


def with_fields(of, fields):
    """Return an object with other fields: values, or changes of a copy of the present array."""
    new = {
        n: v(np.array(getattr(of, n))) if callable(v) else v for n, v in fields.items()
    }
    return replace(of, **new)


def beginning(trace, steps):
    """Return the first steps of a run."""
    arrays = {field.name: getattr(trace, field.name) for field in fields(trace)}
    counts = {trace.steps: steps, trace.steps + 1: steps + 1}
    return replace(
        trace, **{name: a[: counts.get(len(a), len(a))] for name, a in arrays.items()}
    )


# What follows returns a function that changes a run, for tables of spoiled runs.


def put(index, value):
    """Return a change of some elements of an array."""

    def change(array):
        array[index] = value
        return array

    return change


def shift(index, by):
    """Return a change of some elements of an array by a number or by several."""
    return lambda array: put(index, array[index] + by)(array)


def with_trace(name, make):
    """Give one run the trace that a function of the experiment returns."""
    return lambda run: replace(run, traces={**run.traces, name: make(run)})


def trace(name, **arrays):
    """Give one run other arrays."""
    return with_trace(name, lambda run: with_fields(run.traces[name], arrays))


def copied(name, other):
    """Give one run the arrays of another one."""
    return with_trace(name, lambda run: run.traces[other])


def reading(group, name, value):
    """Change a value that the engine reported."""
    return lambda run: replace(
        run, readings=run.readings | {group: run.readings[group] | {name: value}}
    )


def case(name, **fields):
    """Give one run other settings, but the same arrays."""

    def change(run):
        one = run.page.runs[name]
        runs = {**run.page.runs, name: replace(one, case=with_fields(one.case, fields))}
        return replace(run, page=replace(run.page, runs=runs))

    return change


def metric(name, **fields):
    """Give one run other metrics than those of its arrays."""
    return lambda run: replace(
        run, accepted={**run.metrics, name: replace(run.metrics[name], **fields)}
    )


def joints(**fields):
    """Change the map of the robot's joints."""
    return lambda run: replace(run, joints=with_fields(run.joints, fields))


def frames(**names):
    """Take each named camera frame from another one of the run."""
    return lambda run: replace(
        run, frames={n: run.frames[of] for n, of in names.items()}
    )
