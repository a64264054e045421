"""The step experiments of a bundle, recomputed from its arrays, joints and frames."""

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
    """Return metrics and checks from the runs of a bundle; the lecture's has the studies as well.

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
    """Return the experiment of the page, with metrics computed again from the arrays.

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
        end_state=files.end_state,
        frames=frames,
    )


def read_traces(files: BundleReader) -> dict[str, Trace]:
    """Return the traces of a bundle by case, each of them a possible run.

    Raises:
        BundleRefused: `cases`, `labels`, `stamps`, `constant`, or as `read_trace`.
    """
    traces = files.traces(spec.CASES, _check_coords)
    for name, case in spec.CASES.items():
        file, trace = f"arrays/{name}.npz", traces[name]
        expect("stamps", file, "number of steps", trace.steps, case.steps)
        if not np.allclose(trace.t, np.arange(case.steps + 1) * case.dt, rtol=0, atol=1e-9):
            expect("stamps", file, "dt of the stamps [s]", trace.dt, case.dt)
        _check_motion(file, trace)
    return traces


def _check_coords(coords: Mapping[str, list[str]]) -> None:
    expect("labels", "arrays.json", "names of coords", sorted(coords), ["dof", "link"])
    expect("labels", "arrays.json", "coords.dof", tuple(coords["dof"]), JOINT_NAMES)
    links = coords["link"]
    expect("labels", "arrays.json", "number of different links", len(set(links)), len(links))


def _check_motion(file: str, trace: Trace) -> None:
    """Refuse an array of one constant: a stepped joint moves and is driven."""
    for name, values in (
        (f"position of {spec.STEPPED_JOINT}", trace.q[:, ENTRY]),
        (f"velocity of {spec.STEPPED_JOINT}", trace.qd[:, ENTRY]),
        ("control force", trace.control_force),
        ("internal force", trace.internal_force),
    ):
        if (values == values.flat[0]).all():
            raise BundleRefused(
                "constant",
                f"{file}: {name} is {values.flat[0]:g} at every sample, expected one "
                f"that changes. {AGAIN}",
            )


def read_studies(files: BundleReader, traces: Mapping[str, Trace]) -> study.Studies:
    """Return the studies as their page measured them.

    Readings of the engines without a run are in no array. They come from metrics.json, and the
    checks compare them with the runs.

    Raises:
        BundleRefused: `cases` or `metrics`, where a run or a reading is missing.
    """
    missing = sorted(set(study.STUDY_RUNS) - set(traces))
    expect("cases", "arrays.json", "list of missing study runs", missing, [])
    engines = ("Genesis", "MuJoCo")
    groups = {"inertia": engines, "gravity_at_start": engines, "gravity": tuple(spec.CASES)}
    names = [f"{group}_{name}" for group, members in groups.items() for name in members]
    readings = files.readings("readings", ["passive_damping", *names])
    inertia, gravity_at_start, gravity = (
        {name: readings[f"{group}_{name}"] for name in members} for group, members in groups.items()
    )
    return study.Studies(
        files.joints(), traces, inertia, gravity_at_start, readings["passive_damping"], gravity
    )
