"""Everything that the arrays, joints and frames of a bundle decide, computed again from them."""

from pathlib import Path

import numpy as np
from PIL import Image

from robo_genesis import checks, l04, l04_studies, study_checks
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Arrays, Manifest
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused, expect
from robo_genesis.evidence.traces import read_joints, read_trace
from robo_genesis.metrics import measure, metric_records
from robo_genesis.runtime import require_frame
from robo_genesis.scene_config import CAMERA_RES, JOINT_NAMES
from robo_genesis.studies import Studies, from_readings, records
from robo_genesis.trace import Trace

ENTRY = JOINT_NAMES.index(l04.STEPPED_JOINT)


def read_run(folder: Path, manifest: Manifest) -> checks.StepExperiment:
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
    return checks.StepExperiment(
        joints=read_joints(arrays),
        model=read_counts(folder),
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


def read_frames(folder: Path, manifest: Manifest) -> dict[str, np.ndarray]:
    """Return the camera frames by name, each a picture of this run.

    Raises:
        BundleRefused: `frames`.
    """
    render, run_id = manifest.predicate.render, manifest.predicate.run_id
    found = sorted(path.name for path in (folder / "frames").glob("*"))
    expected = ["final.png", "initial.png"] if render.mode == "camera" else []
    expect("frames", "frames/", f"list of frames with render mode {render.mode}", found, expected)
    frames = {}
    for name in found:
        try:
            with Image.open(folder / "frames" / name, formats=["PNG"]) as picture:
                if picture.size != CAMERA_RES:  # before decoding: the header may lie
                    expect("frames", f"frames/{name}", "size", picture.size, CAMERA_RES)
                stamp, pixels = picture.info.get("run_id"), np.array(picture)
            require_frame(pixels)
        except (OSError, SyntaxError, ValueError) as error:
            if isinstance(error, BundleRefused):
                raise
            raise BundleRefused(
                "frames", f"frames/{name}: {error}, expected a camera frame. {AGAIN}"
            ) from error
        expect("frames", f"frames/{name}", "run_id of the stamp", stamp, run_id)
        frames[Path(name).stem] = pixels
    return frames


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


def read_counts(folder: Path) -> dict[str, int]:
    """Return the engine's counts of links, joints, DOFs and qpos, as they were recorded.

    Raises:
        BundleRefused: `metrics`, where a count is missing or is no count.
    """
    recorded = bundle.read_metrics(folder).get("model", {})
    names = sorted(l04.EXPECTED_MODEL)
    expect("metrics", "metrics.json", "list of counts in model", sorted(recorded), names)
    counts = {}
    for name, metric in recorded.items():
        if not isinstance(metric.value, int):
            raise BundleRefused(
                "metrics",
                f"metrics.json: model.{name} is {metric.value}, expected an integer. {AGAIN}",
            )
        counts[name] = metric.value
    return counts


def check_metrics(folder: Path, run: checks.StepExperiment, studied: Studies | None = None) -> None:
    """Require that metrics.json is what the runs give, with units, classes and sources.

    Raises:
        BundleRefused: `metrics`; `bad-trace` where the arrays of a study give none.
    """
    expected = metric_records(run.metrics, run.model)
    try:
        expected |= records(studied) if studied else {}
    except ValueError as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    found = {
        group: {name: metric.model_dump(by_alias=True) for name, metric in metrics.items()}
        for group, metrics in bundle.read_metrics(folder).items()
    }
    file = "metrics.json"
    expect("metrics", file, "list of groups", sorted(found), sorted(expected))
    for group in expected:
        here, there = found[group], expected[group]
        for name in sorted(here.keys() | there.keys()):
            expect("metrics", file, f"{group}.{name}", here.get(name), there.get(name))


def check_outcomes(
    manifest: Manifest, run: checks.StepExperiment, studied: Studies | None = None
) -> None:
    """Require that the recorded outcomes are those of the run, and that all passed.

    Raises:
        BundleRefused: `checks` where they are not; `failed` where they are, and one failed.
    """
    recorded = manifest.predicate.checks
    outcomes = checks.run_checks(run) + (study_checks.run_checks(studied) if studied else ())
    names = [check.name for check in outcomes]
    expect("checks", "manifest.json", "list of checks", [c.name for c in recorded], names)
    for said, found in zip(recorded, outcomes, strict=True):
        what = f"outcome of check {said.name}, computed again as '{found.detail}',"
        expect("checks", "manifest.json", what, said.passed, found.passed)
        what = f"detail of check {said.name}"
        expect("checks", "manifest.json", what, said.detail, found.detail)
    failed = [f"[{c.name}] {c.detail}" for c in recorded if not c.passed]
    if failed:
        raise BundleRefused(
            "failed",
            f"manifest.json: failed checks {' '.join(failed)}, expected none. Mend the cause in "
            "the lesson or report it to the engine's developers, then record again.",
        )
