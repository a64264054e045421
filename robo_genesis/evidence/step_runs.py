"""The step experiments of a bundle as their page had them, from arrays, joints and frames."""

from pathlib import Path

import numpy as np

from robo_genesis import l04, l04_studies, step_checks, study_checks
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Arrays, Manifest
from robo_genesis.evidence.recompute import Judged, read_counts, read_frames
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused, expect
from robo_genesis.evidence.traces import read_joints, read_trace
from robo_genesis.metrics import measure, metric_records
from robo_genesis.scene_config import JOINT_NAMES
from robo_genesis.studies import Studies, from_readings, records
from robo_genesis.trace import Trace

ENTRY = JOINT_NAMES.index(l04.STEPPED_JOINT)


def judge(folder: Path, manifest: Manifest) -> Judged:
    """Return what the runs of a bundle of L04 give, studies included where its page makes them.

    Raises:
        BundleRefused: as `read_run` and `read_studies`.
    """
    run = read_run(folder, manifest)
    found = metric_records(run.metrics, run.model)
    outcomes = step_checks.run_checks(run)
    studied = read_studies(folder, manifest)
    if studied:
        try:
            found |= records(studied)
        except ValueError as error:
            raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
        outcomes += study_checks.run_checks(studied)
    return Judged(found, outcomes)


def read_run(folder: Path, manifest: Manifest) -> step_checks.StepExperiment:
    """Return the experiment as its page had it, with metrics computed again from the arrays.

    Raises:
        BundleRefused: as `read_traces`, `read_frames` and `read_counts`; `bad-trace` where the
            arrays give no metrics.
    """
    arrays = bundle.read_arrays(folder)
    traces = read_traces(folder, arrays)
    frames = read_frames(folder, manifest)
    try:
        metrics = measure(traces, l04.CASES, ENTRY)
    except ValueError as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    return step_checks.StepExperiment(
        joints=read_joints(arrays),
        model=read_counts(folder, "model", l04.EXPECTED_MODEL),
        cases=l04.CASES,
        traces={case: traces[case] for case in l04.CASES},
        metrics=metrics,
        posture="camera" if manifest.predicate.render.mode == "camera" else "schematic",
        frames=frames,
    )


def read_traces(folder: Path, arrays: Arrays) -> dict[str, Trace]:
    """Return the traces of a bundle by case, each of them a run that can have happened.

    Raises:
        BundleRefused: `cases`, `labels`, `stamps`, `constant`, or as `read_trace`.
    """
    missing = sorted(set(l04.CASES) - set(arrays.cases))
    expect("cases", "arrays.json", "list of missing cases", missing, [])
    present = sorted(path.stem for path in (folder / "arrays").glob("*.npz"))
    expect("cases", "arrays/", "list of archives", present, sorted(arrays.cases))
    _check_coords(arrays)
    traces = {case: read_trace(folder, arrays, case) for case in arrays.cases}
    for case in l04.CASES:
        _check_time(case, traces[case])
        _check_motion(case, traces[case])
    return traces


def _check_coords(arrays: Arrays) -> None:
    expect("labels", "arrays.json", "names of coords", sorted(arrays.coords), ["dof", "link"])
    expect("labels", "arrays.json", "coords.dof", tuple(arrays.coords["dof"]), JOINT_NAMES)
    links = arrays.coords["link"]
    expect("labels", "arrays.json", "number of different links", len(set(links)), len(links))


def _check_time(case: str, trace: Trace) -> None:
    file, asked = f"arrays/{case}.npz", l04.CASES[case]
    expect("stamps", file, "number of steps", trace.steps, asked.steps)
    if not np.allclose(trace.t, np.arange(asked.steps + 1) * asked.dt, rtol=0, atol=1e-9):
        expect("stamps", file, "dt of the stamps [s]", trace.dt, asked.dt)


def _check_motion(case: str, trace: Trace) -> None:
    """A stepped joint moves and is driven; an array that stands still was not measured."""
    for name, values in (
        (f"position of {l04.STEPPED_JOINT}", trace.q[:, ENTRY]),
        (f"velocity of {l04.STEPPED_JOINT}", trace.qd[:, ENTRY]),
        ("control force", trace.control_force),
        ("internal force", trace.internal_force),
    ):
        if (values == values.flat[0]).all():
            raise BundleRefused(
                "constant",
                f"arrays/{case}.npz: {name} is {values.flat[0]:g} at every sample, expected one "
                f"that changes. {AGAIN}",
            )


def read_studies(folder: Path, manifest: Manifest) -> Studies | None:
    """Return the studies as their page had them; None for a page that runs none.

    What the engines said of a posture is in no array: it is taken from metrics.json, and the checks
    hold it against the runs.

    Raises:
        BundleRefused: `cases` or `metrics`, where a run or a reading is missing.
    """
    if manifest.predicate.page != l04_studies.PAGE:
        return None
    arrays = bundle.read_arrays(folder)
    wanted = (*l04_studies.STEP_CASES, *l04_studies.SUBSTEP_CASES, *l04_studies.SECOND_RUNS)
    missing = sorted(set(wanted) - set(arrays.cases))
    expect("cases", "arrays.json", "list of missing study runs", missing, [])
    traces = {case: read_trace(folder, arrays, case) for case in (*l04.CASES, *wanted)}
    recorded = bundle.read_metrics(folder).get("readings", {})
    readings = {name: metric.value for name, metric in recorded.items() if metric.value is not None}
    try:
        return from_readings(read_joints(arrays), traces, readings)
    except KeyError as error:
        raise BundleRefused(
            "metrics", f"metrics.json: readings lacks {error}, expected a number. {AGAIN}"
        ) from error
