"""Write the measurements of a page as one bundle, completely or not at all."""

import base64
import hashlib
import math
import os
import platform
import uuid
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.files import replaced
from robo_genesis.core.git import git_or_none
from robo_genesis.sim import session
from robo_genesis.sim.backends import driver_version
from robo_genesis.sim.camera.frames import Renderer
from robo_genesis.sim.visual_shape import Part, write_shape

from . import bundle
from .reader import write_frame
from .trace_files import write_traces

PACKAGE = Path(__file__).resolve().parents[1]
ENGINE, COMPILER = project.ENGINE, "quadrants"

# The pathspec of git for all files of a checkout that are not in a recorded bundle.
NOT_RECORDED = f":(exclude,glob){project.BOOK.name}/evidence/*/*/**"


class RecordError(ValueError):
    """An experiment cannot be recorded; the message names the runs or values."""


@dataclass
class Recorder:
    """Notes when a page starts, and writes its bundle at the end.

    Args:
        lesson, page: of the bundle; with the actual backend they name its folder.
        contract: names the folder of all outputs.
        engine: as started.
        modules: the digest of each module that measures.
    """

    lesson: str
    page: str
    contract: session.Contract
    engine: session.Engine
    modules: Mapping[str, str]

    def __post_init__(self) -> None:
        self.started = _now()
        self.run_id = os.environ.get(project.RUN_ID) or uuid.uuid4().hex
        self.page_digest = os.environ.get(project.PAGE_SHA256)
        # The engine has many files; the page continues meanwhile.
        reader = ThreadPoolExecutor(1)
        self._match = reader.submit(files_match_wheel, ENGINE, COMPILER)
        reader.shutdown(wait=False)

    @property
    def folder(self) -> Path:
        """The folder of the bundle."""
        return (
            self.contract.outputs / self.lesson / self.page / self.engine.backend.actual
        )

    def facts(self) -> list[dict[str, str]]:
        """Return engine, backend, rendering and folder of the run as rows of a table."""
        engine, backend = self.engine, self.engine.backend
        facts = {
            "Genesis": engine.version,
            "requested backend": backend.requested,
            "actual backend": f"{backend.actual} ({backend.device_name})",
            "rendering": "camera"
            if self.contract.render
            else f"SKIP ({project.RENDER}=0)",
            "precision": f"float{engine.precision}",
            "seed": str(engine.seed),
            "run": self.run_id[:8],
            "outputs": f"{self.lesson}/{self.page}/{backend.actual}",
        }
        return [{"what": name, "value": value} for name, value in facts.items()]

    def write(
        self,
        experiment: Experiment,
        renderer: Renderer | None,
        shape: Sequence[Part] = (),
    ) -> Path:
        """Write the bundle to a temporary folder, then move it to its place in one step.

        Args:
            experiment: what the page measured.
            renderer: of the camera frames, None without a camera.
            shape: the geometry that the page's replay draws.

        Raises:
            RecordError: the experiment has other runs than the page declares, or values
                that are not finite. An earlier bundle is unchanged.

        Returns:
            Its folder. An earlier bundle of the same page and backend is replaced.
        """
        require_complete(experiment)
        with replaced(self.folder) as following:
            following.mkdir(parents=True)
            self._write_files(following, experiment, shape)
            facts = self._facts(experiment, renderer)
            facts["evidence_key"] = bundle.evidence_key(facts)
            facts["files"] = bundle.list_files(following)
            manifest = bundle.Manifest.model_validate(facts)
            bundle.write_json(following / bundle.MANIFEST, manifest.model_dump())
        return self.folder

    def _write_files(
        self, folder: Path, run: Experiment, shape: Sequence[Part]
    ) -> None:
        notes = {name: declared.note for name, declared in run.page.runs.items()}
        write_traces(folder, run.traces, run.joints, run.links, notes)
        bundle.write_json(folder / bundle.METRICS, run.records())
        for name, frame in run.frames.items():
            (folder / "frames").mkdir(exist_ok=True)
            write_frame(folder / "frames" / f"{name}.png", frame)
        if shape:
            write_shape(folder, shape)
        (folder / bundle.LOG).write_text(self.engine.log.text(), encoding="utf-8")

    def _facts(self, run: Experiment, renderer: Renderer | None) -> dict[str, Any]:
        """Return the fields of the manifest but the key and the files."""
        engine, backend = self.engine, self.engine.backend
        keyed = {name: getattr(engine, name) for name in bundle.KEYED_OF_ENGINE}
        drawn = (
            {
                "mode": "camera",
                "vendor": renderer.vendor,
                "renderer": renderer.name,
                "software": renderer.software,
            }
            if renderer
            else {"mode": "skip"}
        )
        return {
            "schema_version": bundle.SCHEMA_VERSION,
            "lesson": self.lesson,
            "page": self.page,
            "run_id": self.run_id,
            "started": self.started,
            "ended": _now(),
            "command": os.environ.get(project.COMMAND, "notebook run by hand"),
            "engine": keyed | {"files_match_wheel": self._match.result()},
            "backend": asdict(backend)
            | {"actual_at_end": session.probe(backend.requested).actual}
            | {"driver": driver_version(backend.actual)},
            "render": drawn,
            "host": host_record(
                backend.device_name if backend.actual == "cpu" else None
            ),
            "environment": {
                name: project.without_folders(value)
                for name, value in engine.switches.items()
            },
            "parameters": run.page.parameters(),
            "seed": engine.seed,
            "checks": [check.record() for check in run.outcomes()],
            "warnings": engine.log.warnings,
            "git": git_record(),
            "source": {"page": self.page_digest, "modules": dict(self.modules)},
        }


def require_complete(run: Experiment) -> None:
    """Raise RecordError unless an experiment has the declared runs and only finite numbers."""
    present, required = sorted(run.traces), sorted(run.page.runs)
    if present != required:
        raise RecordError(
            f"The page has the runs {', '.join(present) or 'none'}; its declaration names "
            f"{', '.join(required)}. Run each declared case, or correct the declaration."
        )
    odd = [
        name
        for name, metric in bundle.by_full_name(run.records()).items()
        if not math.isfinite(metric["value"] or 0)
    ]
    if odd:
        raise RecordError(
            f"Not finite: {', '.join(odd)}. Find out where the run diverges, then run the "
            "page again."
        )


def files_match_wheel(*distributions: str) -> bool:
    """Whether every installed file of the packages has the digest that its wheel recorded.

    A package without recorded digests, such as an editable one, does not match.
    """
    listed = [file for name in distributions for file in metadata.files(name) or ()]
    files = [file for file in listed if file.hash]
    return any(file.suffix == ".py" for file in files) and all(
        map(_is_unchanged, files)
    )


def _is_unchanged(file: metadata.PackagePath) -> bool:
    path = Path(str(file.locate()))
    if file.hash is None or not path.is_file():
        return False
    digest = hashlib.new(file.hash.mode, path.read_bytes()).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode() == file.hash.value


def host_record(cpu: str | None) -> dict[str, Any]:
    """Describe the machine and every installed package."""
    packages = {one.name: one.version for one in metadata.distributions()}
    return {
        "os": platform.platform(),
        "machine": platform.machine(),
        "cpu": cpu or platform.processor() or "unknown",
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
        "packages": dict(sorted(packages.items())),
    }


def git_record() -> dict[str, Any] | None:
    """Return commit and dirty flag of the checkout, None outside a checkout.

    No page reads recorded bundles, so those that were not committed yet do not count.
    """
    commit = git_or_none(PACKAGE.parent, "rev-parse", "HEAD")
    asked = (
        "status",
        "--porcelain",
        "--untracked-files=normal",
        "--",
        ".",
        NOT_RECORDED,
    )
    status = git_or_none(PACKAGE.parent, *asked)
    if commit is None or status is None:
        return None
    return {"commit": commit.strip(), "dirty": bool(status.strip())}


def _now() -> str:
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
