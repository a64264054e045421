"""Everything that the arrays and frames of a bundle decide, held against what it says of itself."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from robo_genesis.checks import Check
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused, expect
from robo_genesis.runtime import require_frame
from robo_genesis.scene_config import CAMERA_RES

MetricRecords = Mapping[str, Mapping[str, Mapping[str, Any]]]
"""Group → name → {value, unit, class, from}, the content of metrics.json."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What the runs of a bundle give, computed again: metrics, and outcomes of the named checks."""

    metrics: MetricRecords
    outcomes: Sequence[Check]


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


def read_counts(folder: Path, group: str, names: Iterable[str]) -> dict[str, int]:
    """Return counts that the engine gave and no array holds, as they were recorded.

    Args:
        folder: the bundle.
        group: of its metrics.json, `model` for what the engine says of the model.
        names: those that it must have, and no others.

    Raises:
        BundleRefused: `metrics`, where a count is missing or is no count.
    """
    recorded = bundle.read_metrics(folder).get(group, {})
    expected = sorted(names)
    expect("metrics", "metrics.json", f"list of counts in {group}", sorted(recorded), expected)
    counts = {}
    for name, metric in recorded.items():
        if not isinstance(metric.value, int):
            raise BundleRefused(
                "metrics",
                f"metrics.json: {group}.{name} is {metric.value}, expected an integer. {AGAIN}",
            )
        counts[name] = metric.value
    return counts


def read_readings(folder: Path, group: str, names: Iterable[str]) -> dict[str, float]:
    """Return values that the engine gave and no array holds, as they were recorded.

    The arguments are those of `read_counts`.

    Raises:
        BundleRefused: `metrics`, where one is missing.
    """
    recorded = bundle.read_metrics(folder).get(group, {})
    expected = sorted(names)
    expect("metrics", "metrics.json", f"list of readings in {group}", sorted(recorded), expected)
    values = {}
    for name, metric in recorded.items():
        if metric.value is None:
            raise BundleRefused("metrics", f"metrics.json: {group}.{name} is missing. {AGAIN}")
        values[name] = float(metric.value)
    return values


def check_metrics(folder: Path, expected: MetricRecords) -> None:
    """Require that metrics.json is what the runs give, with units, classes and sources.

    Raises:
        BundleRefused: `metrics`.
    """
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


def check_outcomes(manifest: Manifest, outcomes: Sequence[Check]) -> None:
    """Require that the recorded outcomes are those of the run, and that all passed.

    Raises:
        BundleRefused: `checks` where they are not; `failed` where they are, and one failed.
    """
    recorded = manifest.predicate.checks
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
