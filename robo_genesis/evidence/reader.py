"""Read the experiment of a bundle from its files."""

from collections.abc import Collection, Mapping
from pathlib import Path

import numpy as np
from PIL import Image

from robo_genesis.core.experiment import Experiment, MeasuringPage
from robo_genesis.lessons import find_page
from robo_genesis.sim.camera.frames import require_frame

from .bundle import (
    ARRAYS,
    METRICS,
    Manifest,
    Metric,
    read_arrays,
)
from .refusals import AGAIN, BundleRefused, expect, expect_equal
from .trace_files import describe, read_joints, read_run


def from_bundle(
    folder: Path, manifest: Manifest, metrics: Mapping[str, Mapping[str, Metric]]
) -> Experiment:
    """Return the experiment whose arrays, readings and frames are in a bundle.

    Of its `metrics`, as `bundle.read_metrics` returns them, only the readings of the
    engine are part of it: the experiment computes its own metrics and checks.

    Raises:
        BundleRefused: `cases` for other runs than the declared ones, `labels` if
            arrays.json does not describe them, `metrics`, `frames`, or as `read_run`.
    """
    page = find_page(manifest.lesson, manifest.page)
    rendered = manifest.render.mode == "camera"
    arrays = read_arrays(folder)
    expect("cases", ARRAYS, "list of cases", sorted(arrays.cases), sorted(page.runs))
    joints = read_joints(arrays) if page.joints else None
    dofs = arrays.coords.get("dof", [])
    expect("labels", ARRAYS, "list of DOFs", dofs, list(page.joints))
    traces = {
        name: read_run(folder, name, run.kind or page.kind)
        for name, run in page.runs.items()
    }
    links = list(page.links) or arrays.coords.get("link", [])
    notes = {name: run.note for name, run in page.runs.items()}
    described = describe(traces, joints, links, notes).model_dump()
    expect_equal("labels", ARRAYS, "{}", arrays.model_dump(), described)
    return Experiment(
        page=page,
        traces=traces,
        links=links,
        frames=read_frames(folder, page.frames if rendered else ()),
        rendered=rendered,
        joints=joints,
        readings=readings(metrics, page, rendered),
    )


def readings(
    metrics: Mapping[str, Mapping[str, Metric]], page: MeasuringPage, rendered: bool
) -> dict[str, dict[str, float]]:
    """Return the values that the engine reported, by group and name; no array contains them.

    Raises:
        BundleRefused: `metrics` if a group lacks a value or has another one.
    """
    reported = {}
    for group, declared in page.groups(rendered).items():
        values = {
            name: metric.value
            for name, metric in metrics.get(group, {}).items()
            if metric.value is not None
        }
        what = f"list of values in {group}"
        expect("metrics", METRICS, what, sorted(values), sorted(declared.units))
        reported[group] = values
    return reported


def write_frame(path: Path, frame: np.ndarray) -> None:
    """Write a camera frame, shape (height, width, 3) uint8, as PNG.

    Raises:
        FrameError: the frame is not usable.
    """
    require_frame(frame)
    Image.fromarray(frame).save(path)


def read_frames(folder: Path, names: Collection[str]) -> dict[str, np.ndarray]:
    """Return the camera frames of a bundle by name, each (height, width, 3) uint8.

    Args:
        folder: the bundle.
        names: those that it must have, and no others.

    Raises:
        BundleRefused: `frames`.
    """
    present = sorted(path.stem for path in (folder / "frames").glob("*"))
    expect("frames", "frames/", "list of frames", present, sorted(names))
    frames = {}
    for name in present:
        file = f"frames/{name}.png"
        try:
            with Image.open(folder / file) as picture:
                frames[name] = np.asarray(picture)
        except OSError as error:
            raise BundleRefused("frames", f"{file}: {error} {AGAIN}") from error
    return frames
