"""Everything that the arrays and frames of a bundle decide, compared with its own claims."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from PIL import Image

from robo_genesis.core.checks import Check
from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.core.trace import BodyTrace, ContactTrace, Trace
from robo_genesis.evidence import bundle, trace_files
from robo_genesis.evidence.bundle import Arrays, Manifest
from robo_genesis.sim.joints import JointMap
from robo_genesis.sim.session import require_frame

MetricRecords = Mapping[str, Mapping[str, Mapping[str, Any]]]
"""Group → name → {value, unit, class, from}, the content of metrics.json."""

Body = TypeVar("Body", bound=BodyTrace)


@dataclass(frozen=True)
class Reader:
    """The files of one bundle, as `lessons.declaration.BundleReader` describes them."""

    folder: Path
    manifest: Manifest

    @property
    def page(self) -> str:
        """The page that recorded the bundle."""
        return self.manifest.predicate.page

    @property
    def end_state(self) -> str:
        """`camera` where the run was rendered, else `schematic`."""
        return "camera" if self.manifest.predicate.render.mode == "camera" else "schematic"

    @cached_property
    def arrays(self) -> Arrays:
        """The description of the arrays."""
        return bundle.read_arrays(self.folder)

    def joints(self) -> JointMap:
        """Return the joint behind each DOF of the arrays."""
        return trace_files.read_joints(self.arrays)

    def traces(
        self, required: Iterable[str], check_coords: Callable[[Mapping[str, list[str]]], None]
    ) -> dict[str, Trace]:
        """Return all runs of joints by case, once their labels have passed `check_coords`.

        Raises:
            BundleRefused: `cases` where a required one is missing; as `read_trace`.
        """
        present = sorted(path.stem for path in (self.folder / "arrays").glob("*.npz"))
        missing = sorted(set(required) - set(self.arrays.cases))
        expect("cases", "arrays.json", "list of missing cases", missing, [])
        expect("cases", "arrays/", "list of archives", present, sorted(self.arrays.cases))
        check_coords(self.arrays.coords)
        cases = self.arrays.cases
        return {case: trace_files.read_trace(self.folder, self.arrays, case) for case in cases}

    def bodies(self, cases: Iterable[str], link: str) -> dict[str, BodyTrace]:
        """Return the runs of one free body by case; the bundle holds no others."""
        return trace_files.read_bodies(self.folder, cases, link, trace_files.read_body_trace)

    def contacts(self, cases: Iterable[str], link: str) -> dict[str, ContactTrace]:
        """Return the runs of one free body with its contacts by case; it holds no others."""
        return trace_files.read_bodies(self.folder, cases, link, trace_files.read_contact_trace)

    def frames(self) -> dict[str, np.ndarray]:
        """Return the camera frames by name, each a picture of this run.

        Raises:
            BundleRefused: `frames`.
        """
        render, run_id = self.manifest.predicate.render, self.manifest.predicate.run_id
        found = sorted(path.name for path in (self.folder / "frames").glob("*"))
        expected = ["final.png", "initial.png"] if render.mode == "camera" else []
        expect(
            "frames", "frames/", f"list of frames with render mode {render.mode}", found, expected
        )
        frames = {}
        for name in found:
            try:
                with Image.open(self.folder / "frames" / name, formats=["PNG"]) as picture:
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

    def counts(self, group: str, names: Iterable[str]) -> dict[str, int]:
        """Return counts that the engine gave and no array holds, as they were recorded.

        Args:
            group: of its metrics.json, `model` for what the engine says of the model.
            names: those that it must have, and no others.

        Raises:
            BundleRefused: `metrics`, where a count is missing or is no count.
        """
        recorded = bundle.read_metrics(self.folder).get(group, {})
        expected = sorted(names)
        expect("metrics", "metrics.json", f"list of counts in {group}", sorted(recorded), expected)
        found = {}
        for name, metric in recorded.items():
            if not isinstance(metric.value, int):
                raise BundleRefused(
                    "metrics",
                    f"metrics.json: {group}.{name} is {metric.value}, expected an integer. {AGAIN}",
                )
            found[name] = metric.value
        return found

    def recorded(self, group: str) -> dict[str, float]:
        """Return whatever values a group of metrics.json has, those observed."""
        found = bundle.read_metrics(self.folder).get(group, {})
        return {name: metric.value for name, metric in found.items() if metric.value is not None}

    def readings(self, group: str, names: Iterable[str]) -> dict[str, float]:
        """Return values that the engine gave and no array holds, as they were recorded.

        The arguments are those of `counts`.

        Raises:
            BundleRefused: `metrics`, where one is missing.
        """
        recorded = bundle.read_metrics(self.folder).get(group, {})
        expected = sorted(names)
        expect(
            "metrics", "metrics.json", f"list of readings in {group}", sorted(recorded), expected
        )
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
