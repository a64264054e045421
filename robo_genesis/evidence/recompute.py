"""Everything that the arrays and frames of a bundle decide, computed again from them."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image

from robo_genesis import checks, l04
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Arrays, Manifest
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused, expect
from robo_genesis.evidence.traces import read_trace
from robo_genesis.metrics import StepMetrics
from robo_genesis.robot_model import JointMap
from robo_genesis.runtime import require_frame
from robo_genesis.scene_config import CAMERA_RES, JOINT_NAMES
from robo_genesis.trace import Trace

FROM_THE_MODEL = ("mapping", "configuration", "target_limits")
"""Checks that also look at what no array holds: local DOF indices and the model's limits."""

ENTRY = JOINT_NAMES.index(l04.STEPPED_JOINT)


def read_traces(folder: Path) -> dict[str, Trace]:
    """Return the traces of a bundle by case, each of them a run that can have happened.

    Raises:
        BundleRefused: `cases`, `labels`, `stamps`, `constant`, or as `read_trace`.
    """
    arrays = bundle.read_arrays(folder)
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


def check_metrics(folder: Path, traces: Mapping[str, Trace]) -> dict[str, StepMetrics]:
    """Require that metrics.json is what the arrays give; return the metrics.

    Raises:
        BundleRefused: `metrics`, or `bad-trace` where the arrays give none.
    """
    try:
        measured = l04.measure(traces, ENTRY)
    except ValueError as error:
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    expected = l04.metric_records(measured, l04.EXPECTED_MODEL)
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
    return measured


def check_outcomes(
    manifest: Manifest,
    traces: Mapping[str, Trace],
    metrics: Mapping[str, StepMetrics],
    frames: Mapping[str, np.ndarray],
) -> None:
    """Require that the recorded outcomes are those of the arrays, and that all passed.

    Raises:
        BundleRefused: `checks` where they are not; `failed` where they are, and one failed.
    """
    recorded = manifest.predicate.checks
    names = [check.__name__ for check in checks.CHECKS]
    expect("checks", "manifest.json", "list of checks", [c.name for c in recorded], names)
    posture = "camera" if manifest.predicate.render.mode == "camera" else "schematic"
    again = checks.run_checks(
        checks.StepExperiment(
            joints=_joints(), model=l04.EXPECTED_MODEL, cases=l04.CASES, traces=traces,
            metrics=metrics, posture=posture, frames=frames,
        )
    )  # fmt: skip
    for said, found in zip(recorded, again, strict=True):
        what = f"outcome of check {said.name}, computed again as '{found.detail}',"
        if said.passed or said.name not in FROM_THE_MODEL:
            expect("checks", "manifest.json", what, said.passed, found.passed)
        if said.passed:
            what = f"detail of check {said.name}"
            expect("checks", "manifest.json", what, said.detail, found.detail)
    failed = [f"[{c.name}] {c.detail}" for c in recorded if not c.passed]
    if failed:
        raise BundleRefused(
            "failed",
            f"manifest.json: failed checks {' '.join(failed)}, expected none. Mend the cause in "
            "the lesson or report it to the engine's developers, then record again.",
        )


def _joints() -> JointMap:
    """Return the lesson's joints, with limits that nothing passes: a bundle keeps none."""
    indices, widest = np.arange(len(JOINT_NAMES)), np.full(len(JOINT_NAMES), 1e9)
    return JointMap(JOINT_NAMES, l04.EXPECTED_TYPES, indices, indices, -widest, widest)
