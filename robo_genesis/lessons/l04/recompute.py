"""The step experiments of a bundle as their page measured them, from arrays, joints and frames."""

from collections.abc import Mapping

import numpy as np

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.core.scene import JOINT_NAMES
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.declaration import BundleReader, Recomputed
from robo_genesis.lessons.l04 import checks, spec, study, study_checks, study_spec
from robo_genesis.lessons.l04.metrics import measure, metric_records

ENTRY = JOINT_NAMES.index(spec.STEPPED_JOINT)


def recompute(files: BundleReader) -> Recomputed:
    """Return what the runs of a bundle give, with the studies where the page has them.

    Raises:
        BundleRefused: `cases`, `labels`, `stamps`, `constant`, `metrics`, `bad-trace`, `frames`,
            or as `read_trace`.
    """
    traces = read_traces(files)
    run = read_run(files, traces)
    found, outcomes = metric_records(run.metrics, run.model), checks.run_checks(run)
    if files.page == study_spec.PAGE:
        studied = read_studies(files, traces)
        try:
            found |= study.records(studied)
        except ValueError as error:
            raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
        outcomes += study_checks.run_checks(studied)
    return Recomputed(found, outcomes)


def read_run(files: BundleReader, traces: Mapping[str, Trace]) -> checks.StepExperiment:
    """Return the experiment as its page had it, with metrics computed again from the arrays.

    Raises:
        BundleRefused: `frames`, `metrics`; `bad-trace` where the arrays give no metrics.
    """
    frames = files.frames()
    try:
        metrics = measure(traces, spec.CASES, ENTRY)
    except ValueError as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    return checks.StepExperiment(
        joints=files.joints(),
        model=files.counts("model", spec.EXPECTED_MODEL),
        cases=spec.CASES,
        traces={case: traces[case] for case in spec.CASES},
        metrics=metrics,
        posture=files.end_state,
        frames=frames,
    )


def read_traces(files: BundleReader) -> dict[str, Trace]:
    """Return the traces of a bundle by case, each of them a run that can have happened.

    Raises:
        BundleRefused: `cases`, `labels`, `stamps`, `constant`, or as `read_trace`.
    """
    traces = files.traces(spec.CASES, _check_coords)
    for case in spec.CASES:
        _check_time(case, traces[case])
        _check_motion(case, traces[case])
    return traces


def _check_coords(coords: Mapping[str, list[str]]) -> None:
    expect("labels", "arrays.json", "names of coords", sorted(coords), ["dof", "link"])
    expect("labels", "arrays.json", "coords.dof", tuple(coords["dof"]), JOINT_NAMES)
    links = coords["link"]
    expect("labels", "arrays.json", "number of different links", len(set(links)), len(links))


def _check_time(case: str, trace: Trace) -> None:
    file, asked = f"arrays/{case}.npz", spec.CASES[case]
    expect("stamps", file, "number of steps", trace.steps, asked.steps)
    if not np.allclose(trace.t, np.arange(asked.steps + 1) * asked.dt, rtol=0, atol=1e-9):
        expect("stamps", file, "dt of the stamps [s]", trace.dt, asked.dt)


def _check_motion(case: str, trace: Trace) -> None:
    """A stepped joint moves and is driven; an array of one constant was not measured."""
    for name, values in (
        (f"position of {spec.STEPPED_JOINT}", trace.q[:, ENTRY]),
        (f"velocity of {spec.STEPPED_JOINT}", trace.qd[:, ENTRY]),
        ("control force", trace.control_force),
        ("internal force", trace.internal_force),
    ):
        if (values == values.flat[0]).all():
            raise BundleRefused(
                "constant",
                f"arrays/{case}.npz: {name} is {values.flat[0]:g} at every sample, expected one "
                f"that changes. {AGAIN}",
            )


def read_studies(files: BundleReader, traces: Mapping[str, Trace]) -> study.Studies:
    """Return the studies as their page measured them.

    What the engines report of a posture is in no array. It is taken from metrics.json, and the
    checks compare it with the runs.

    Raises:
        BundleRefused: `cases` or `metrics`, where a run or a reading is missing.
    """
    wanted = (*study_spec.STEP_CASES, *study_spec.SUBSTEP_CASES, *study_spec.SECOND_RUNS)
    missing = sorted(set(wanted) - set(traces))
    expect("cases", "arrays.json", "list of missing study runs", missing, [])
    try:
        return study.from_readings(files.joints(), traces, files.recorded("readings"))
    except KeyError as error:
        raise BundleRefused(
            "metrics", f"metrics.json: readings lacks {error}, expected a number. {AGAIN}"
        ) from error
