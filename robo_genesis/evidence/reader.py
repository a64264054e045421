"""Read the files of a bundle for the lesson that recomputes its metrics and checks."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

import numpy as np
from PIL import Image

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.core.trace import BodyTrace, ContactTrace, Trace
from robo_genesis.evidence import bundle, trace_files
from robo_genesis.evidence.bundle import Arrays, Manifest, Metric
from robo_genesis.sim.joints import JointMap
from robo_genesis.sim.session import require_frame

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
        """`camera` if the run was rendered, else `schematic`."""
        return "camera" if self.manifest.predicate.render.mode == "camera" else "schematic"

    @cached_property
    def arrays(self) -> Arrays:
        """The description of the arrays."""
        return bundle.read_arrays(self.folder)

    @cached_property
    def metrics(self) -> dict[str, dict[str, Metric]]:
        """The recorded metrics by group and name."""
        return bundle.read_metrics(self.folder)

    def joints(self) -> JointMap:
        """Return the joint of each DOF of the arrays."""
        return trace_files.read_joints(self.arrays)

    def traces(
        self, required: Iterable[str], check_coords: Callable[[Mapping[str, list[str]]], None]
    ) -> dict[str, Trace]:
        """Return all runs of joints by case, after `check_coords` has accepted their labels.

        Raises:
            BundleRefused: `cases` if a required one is missing; as `read_trace`.
        """
        missing = sorted(set(required) - set(self.arrays.cases))
        expect("cases", "arrays.json", "list of missing cases", missing, [])
        self._check_archives()
        check_coords(self.arrays.coords)
        return {c: trace_files.read_trace(self.folder, self.arrays, c) for c in self.arrays.cases}

    def bodies(self, cases: Iterable[str], link: str) -> dict[str, BodyTrace]:
        """Return the runs of one free body by case; the bundle has no other runs."""
        return self._bodies(cases, link, BodyTrace)

    def contacts(self, cases: Iterable[str], link: str) -> dict[str, ContactTrace]:
        """Return the runs of one free body with its contacts by case; there are no other runs."""
        return self._bodies(cases, link, ContactTrace)

    def _bodies(self, cases: Iterable[str], link: str, kind: type[Body]) -> dict[str, Body]:
        expected = sorted(cases)
        expect("cases", "arrays.json", "list of cases", sorted(self.arrays.cases), expected)
        self._check_archives()
        expect("labels", "arrays.json", "coords", self.arrays.coords, {"link": [link]})
        return {c: trace_files.read_run(self.folder, self.arrays, c, kind) for c in expected}

    def _check_archives(self) -> None:
        present = sorted(path.stem for path in (self.folder / "arrays").glob("*.npz"))
        expect("cases", "arrays/", "list of archives", present, sorted(self.arrays.cases))

    def frames(self) -> dict[str, np.ndarray]:
        """Return the camera frames by name, each of this run.

        Raises:
            BundleRefused: `frames`.
        """
        predicate = self.manifest.predicate
        present = sorted(path.name for path in (self.folder / "frames").glob("*"))
        expected = ["final.png", "initial.png"] if predicate.render.mode == "camera" else []
        what = f"list of frames with render mode {predicate.render.mode}"
        expect("frames", "frames/", what, present, expected)
        frames = {}
        for name in present:
            file = f"frames/{name}"
            try:
                with Image.open(self.folder / file, formats=["PNG"]) as picture:
                    if picture.size != CAMERA_RES:  # before decoding: the header may lie
                        raise ValueError(f"Its size is {picture.size}.")
                    run_id, pixels = picture.info.get("run_id"), np.array(picture)
                require_frame(pixels)
            except (OSError, SyntaxError, ValueError) as error:
                message = f"{file}: expected a camera frame of size {CAMERA_RES}. {error} {AGAIN}"
                raise BundleRefused("frames", message) from error
            expect("frames", file, "its run_id", run_id, predicate.run_id)
            frames[Path(name).stem] = pixels
        return frames

    def counts(self, group: str, names: Iterable[str]) -> dict[str, int]:
        """Return counts that the engine reported; as `readings`, but all are integers."""
        found = self.readings(group, names)
        counts = {name: value for name, value in found.items() if isinstance(value, int)}
        what = f"list of integers in {group}"
        expect("metrics", "metrics.json", what, sorted(counts), sorted(found))
        return counts

    def readings(self, group: str, names: Iterable[str]) -> dict[str, float]:
        """Return values that the engine reported; no array contains them.

        Args:
            group: of metrics.json, `model` for the values of the model.
            names: of the values; the group has no others.

        Raises:
            BundleRefused: `metrics` if a value is missing.
        """
        found = self.recorded(group)
        what = f"list of values in {group}"
        expect("metrics", "metrics.json", what, sorted(found), sorted(names))
        return found

    def recorded(self, group: str) -> dict[str, float]:
        """Return the observed values of a group of metrics.json."""
        found = self.metrics.get(group, {})
        return {name: metric.value for name, metric in found.items() if metric.value is not None}
