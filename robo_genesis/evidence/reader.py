"""Read the experiment of a bundle from its files."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from robo_genesis.core.experiment import Experiment, MeasuringPage
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.evidence import trace_files
from robo_genesis.evidence.bundle import (
    Arrays,
    Manifest,
    Metric,
    Predicate,
    read_arrays,
)
from robo_genesis.evidence.picture_file import read_picture
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect, expect_equal
from robo_genesis.lessons import find_page


def from_bundle(
    folder: Path, manifest: Manifest, metrics: Mapping[str, Mapping[str, Metric]]
) -> Experiment:
    """Return the experiment whose arrays, readings and frames are in a bundle.

    Of its `metrics`, as `bundle.read_metrics` returns them, only the readings of the
    engine are part of it: the experiment computes its own metrics and checks.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `frames`, or as `read_run`.
    """
    predicate = manifest.predicate
    page, rendered = (
        find_page(predicate.lesson, predicate.page),
        predicate.render.mode == "camera",
    )
    arrays = read_arrays(folder)
    check_cases(folder, arrays, page)
    check_labels(arrays, page)
    kinds = {name: run.kind or page.kind for name, run in page.runs.items()}
    return Experiment(
        page=page,
        traces={
            n: trace_files.read_run(folder, arrays, n, of) for n, of in kinds.items()
        },
        links=arrays.coords["link"],
        frames=read_frames(folder, predicate, page.frames),
        rendered=rendered,
        joints=trace_files.read_joints(arrays) if page.joints else None,
        readings=readings(metrics, page, rendered),
    )


def check_cases(folder: Path, arrays: Arrays, page: MeasuringPage) -> None:
    """Require the declared runs with their notes, and no others.

    Raises:
        BundleRefused: `cases`.
    """
    found = {name: case.note for name, case in arrays.cases.items()}
    declared = {name: run.note for name, run in page.runs.items()}
    expect_equal("cases", "arrays.json", "note of the case {}", found, declared)
    present = sorted(path.stem for path in (folder / "arrays").glob("*.npz"))
    expect("cases", "arrays/", "list of archives", present, sorted(declared))


def check_labels(arrays: Arrays, page: MeasuringPage) -> None:
    """Require the declared labels of the axes.

    Raises:
        BundleRefused: `labels`.
    """
    found = dict(arrays.coords)
    if not page.links:
        links = found.get("link", [])
        expect(
            "labels",
            "arrays.json",
            "number of different links",
            len(set(links)),
            len(links),
        )
    labels = {"link": list(page.links) or found.get("link")}
    if page.joints:
        labels["dof"] = list(page.joints)
    expect("labels", "arrays.json", "coords", found, labels)


def readings(
    metrics: Mapping[str, Mapping[str, Metric]], page: MeasuringPage, rendered: bool
) -> dict[str, dict[str, float]]:
    """Return the values that the engine reported, by group and name; no array contains them.

    Raises:
        BundleRefused: `metrics` if a group lacks a value or has another one, or if a
            value is beyond its limits or a count that is not an integer.
    """
    found = {}
    for group, declared in page.groups(rendered).items():
        recorded = metrics.get(group, {}).items()
        values = {
            name: metric.value for name, metric in recorded if metric.value is not None
        }
        what = f"list of values in {group}"
        expect("metrics", "metrics.json", what, sorted(values), sorted(declared.units))
        wrong = [
            name for name, value in values.items() if not declared.possible(name, value)
        ]
        expect(
            "metrics",
            "metrics.json",
            f"list of impossible values in {group}",
            wrong,
            [],
        )
        found[group] = values
    return found


def read_frames(
    folder: Path, predicate: Predicate, names: Iterable[str]
) -> dict[str, np.ndarray]:
    """Return the camera frames by name, each of this run.

    Args:
        folder: the bundle.
        predicate: of its manifest.
        names: the frames of a run with a camera.

    Raises:
        BundleRefused: `frames`.
    """
    present = sorted(path.name for path in (folder / "frames").glob("*"))
    with_camera = predicate.render.mode == "camera"
    expected = sorted(f"{name}.png" for name in names) if with_camera else []
    what = f"list of frames with render mode {predicate.render.mode}"
    expect("frames", "frames/", what, present, expected)
    frames = {}
    for name in present:
        file = f"frames/{name}"
        try:
            run_id, pixels = read_picture(folder / file, CAMERA_RES)
        except ValueError as error:
            message = (
                f"{file}: expected a camera frame of size {CAMERA_RES}. {error} {AGAIN}"
            )
            raise BundleRefused("frames", message) from error
        expect("frames", file, "its run_id", run_id, predicate.run_id)
        frames[Path(name).stem] = pixels
    return frames
