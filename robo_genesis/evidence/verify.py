"""Accept or refuse a bundle: its own words are not believed where they can be recomputed."""

import json
from pathlib import Path, PurePosixPath

import numpy as np
from PIL import Image

from robo_genesis import l04, project
from robo_genesis.checks import CHECKS
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused, Manifest
from robo_genesis.evidence.record import COMPUTING_MODULES, PACKAGE
from robo_genesis.evidence.traces import read_trace
from robo_genesis.runtime import FrameError, require_frame

AGAIN = "Record the bundle again."


def verify_bundle(folder: Path, run_id: str | None = None) -> Manifest:
    """Check one bundle against its files, the checkout and the pin.

    Args:
        folder: the bundle, named by its actual backend.
        run_id: the run that it must belong to, where that is known.

    Returns:
        The accepted manifest.

    Raises:
        BundleRefused: with a code, and a message that names what was expected and found.
    """
    manifest = bundle.read_manifest(folder)
    _check_identity(folder, manifest, run_id)
    _check_files(folder, manifest)
    _check_current(manifest)
    _check_backend(folder, manifest)
    _check_frames(folder, manifest)
    _check_metrics(folder)
    _check_outcomes(manifest)
    return manifest


def _expect(code: str, what: str, found: object, expected: object, mend: str) -> None:
    if found != expected:
        raise BundleRefused(code, f"{what} is {found!r}, expected {expected!r}. {mend}")


def _check_identity(folder: Path, manifest: Manifest, run_id: str | None) -> None:
    predicate = manifest.predicate
    _expect("schema", "schema_version", predicate.schema_version, bundle.SCHEMA_VERSION, AGAIN)
    if run_id is not None:
        _expect("run-id", "run_id", predicate.run_id, run_id, "Execute the page again.")
    _expect("lesson", "lesson", predicate.lesson, l04.LESSON, "File it under its own lesson.")
    key = bundle.evidence_key(predicate.model_dump())
    _expect("key", "evidence_key", predicate.evidence_key, key, AGAIN)


def _check_files(folder: Path, manifest: Manifest) -> None:
    listed = {subject.name: subject.digest.sha256 for subject in manifest.subject}
    if len(listed) != len(manifest.subject):
        raise BundleRefused("files", f"a file is listed twice. {AGAIN}")
    for name in listed:
        path = PurePosixPath(name)
        if path.is_absolute() or ".." in path.parts or (folder / name).is_symlink():
            raise BundleRefused("path", f"{name!r} leads out of the bundle. Record it again.")
    present = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if not p.is_dir()}
    present.discard("manifest.json")
    if present != set(listed):
        raise BundleRefused(
            "files",
            f"listed but absent: {sorted(set(listed) - present)}; present but not listed: "
            f"{sorted(present - set(listed))}. Record the bundle again.",
        )
    for name, digest in listed.items():
        _expect("digest", f"sha256 of {name}", bundle.sha256(folder / name), digest, "Run again.")


def _check_current(manifest: Manifest) -> None:
    predicate = manifest.predicate
    refresh = "It is stale: execute the lesson again."
    _expect("stale", "engine version", predicate.engine.version, project.engine_pin(), refresh)
    parameters = json.loads(json.dumps(l04.parameters()))
    _expect("stale", "parameters", predicate.parameters, parameters, refresh)
    for name in COMPUTING_MODULES:
        current = bundle.sha256(PACKAGE / f"{name}.py")
        found = predicate.source.modules.get(name)
        _expect("stale", f"source of robo_genesis.{name}", found, current, refresh)
    _expect(
        "engine-files", "files_match_wheel", predicate.engine.files_match_wheel, True,
        "The installed engine was changed: install it anew from requirements.lock.",
    )  # fmt: skip


def _check_backend(folder: Path, manifest: Manifest) -> None:
    backend = manifest.predicate.backend
    _expect("backend", "folder", folder.name, backend.actual, "Nothing is relabelled.")
    _expect("backend", "backend at the end", backend.actual_at_end, backend.actual, "Run again.")


def _check_frames(folder: Path, manifest: Manifest) -> None:
    camera = manifest.predicate.render.mode == "camera"
    found = sorted(path.name for path in (folder / "frames").glob("*"))
    expected = ["final.png", "initial.png"] if camera else []
    _expect(
        "frames", f"frames with render {manifest.predicate.render.mode}", found, expected, AGAIN
    )
    for name in found:
        try:
            with Image.open(folder / "frames" / name) as picture:
                stamp, pixels = picture.info.get("run_id"), np.array(picture)
            require_frame(pixels)
        except (OSError, FrameError) as error:
            raise BundleRefused("frames", f"{name}: {error}. {AGAIN}") from error
        _expect("frames", f"run id of {name}", stamp, manifest.predicate.run_id, AGAIN)


def _check_metrics(folder: Path) -> None:
    arrays = bundle.read_arrays(folder)
    missing = set(l04.CASES) - set(arrays.cases)
    dofs = arrays.coords.get("dof", [])
    if missing or l04.STEPPED_JOINT not in dofs:
        raise BundleRefused(
            "cases",
            f"no arrays for {sorted(missing)}, or no {l04.STEPPED_JOINT} in {dofs}. {AGAIN}",
        )
    traces = {case: read_trace(folder, arrays, case) for case in arrays.cases}
    measured = l04.measure(traces, dofs.index(l04.STEPPED_JOINT))
    expected = l04.metric_records(measured, l04.EXPECTED_MODEL)
    found = {
        group: {name: metric.model_dump(by_alias=True) for name, metric in metrics.items()}
        for group, metrics in bundle.read_metrics(folder).items()
    }
    _expect("metrics", "groups of metrics", sorted(found), sorted(expected), AGAIN)
    for group in expected:
        here, there = found[group], expected[group]
        for name in sorted(here.keys() | there.keys()):
            _expect("metrics", f"{group}.{name}", here.get(name), there.get(name), AGAIN)


def _check_outcomes(manifest: Manifest) -> None:
    checks = manifest.predicate.checks
    names = [check.__name__ for check in CHECKS]
    _expect("checks", "list of checks", [check.name for check in checks], names, AGAIN)
    failed = [f"[{c.name}] {c.detail}" for c in checks if not c.passed]
    if failed:
        raise BundleRefused("checks", " ".join(failed))
