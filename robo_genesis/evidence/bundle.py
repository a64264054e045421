"""The evidence bundle: one folder with all that a page measured on one backend.

manifest.json   in-toto Statement: every other file with its sha256, one strict predicate
metrics.json    value, unit, class and source array of each metric; null = not observed
arrays.json     the joint behind each DOF; dims, dtype, unit and long name of every array
arrays/<case>.npz
frames/*.png    camera frames only
log.txt         the engine's own log
printed.json    what the page's cells put out; none of a notebook that was run by hand
"""

import hashlib
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypeVar

import rfc8785
from pydantic import Field, TypeAdapter, ValidationError

from robo_genesis.core.text import LONGEST_SHOWN
from robo_genesis.evidence import fields
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.strict_json import read_json
from robo_genesis.sim.camera.frames import Renderer

STATEMENT_TYPE = "https://in-toto.io/Statement/v1"
PREDICATE_TYPE = "urn:robo-genesis:evidence:v2"
SCHEMA_VERSION = 2
PRINTED = "printed.json"
KEYED = ("schema_version", "lesson", "page", "source", "parameters", "seed")
KEYED_OF_ENGINE = ("version", "quadrants_version", "precision")


Value = TypeVar("Value")


class Digest(fields.Strict):
    """The digest of one file."""

    sha256: fields.Sha256


class Subject(fields.Strict):
    """One file of the bundle; the name is relative to the folder of the bundle."""

    name: fields.Line
    digest: Digest


class EngineRecord(fields.Strict):
    """The engine that computed the runs."""

    version: fields.Line
    quadrants_version: fields.Line
    precision: fields.Line
    files_match_wheel: bool


class BackendRecord(fields.Strict):
    """The backend: requested, found after `gs.init`, and found again at the end of the run."""

    requested: Literal["auto", "cpu"]
    actual: Literal["cpu", "cuda", "amdgpu", "metal"]
    actual_at_end: Literal["cpu", "cuda", "amdgpu", "metal"]
    arch: fields.Line
    torch_device: fields.Line
    torch_version: fields.Line
    hip_version: fields.Line | None
    cuda_version: fields.Line | None
    device_name: fields.Line
    driver: fields.Line | None


class RenderRecord(fields.Strict):
    """The renderer of the frames; with mode `skip`, the other fields are None."""

    mode: Literal["camera", "skip"]
    vendor: fields.Line | None
    renderer: fields.Line | None
    software: bool | None


class HostRecord(fields.Strict):
    """The machine and its packages."""

    os: fields.Line
    machine: fields.Line
    cpu: fields.Line
    cores: int = Field(ge=1, lt=2**31)
    python: fields.Line
    packages: dict[fields.Line, fields.Line]


class GitRecord(fields.Strict):
    """State of the checkout."""

    commit: str = Field(pattern="^([0-9a-f]{40}|[0-9a-f]{64})$")
    dirty: bool


class SourceRecord(fields.Strict):
    """Digests of the syntax of what computed: code cells and modules; and of data files."""

    page: fields.Sha256 | None
    modules: dict[fields.Line, fields.Sha256]


class CheckRecord(fields.Strict):
    """Outcome of one named check: what it found, and whether it passed when it was recorded."""

    name: fields.Line
    passed: bool
    found: dict[fields.Line, fields.Found]


class Predicate(fields.Strict):
    """The circumstances and outcomes of the run."""

    schema_version: int
    lesson: fields.Line
    page: fields.Line
    run_id: fields.RunId
    started: fields.Timestamp
    ended: fields.Timestamp
    command: fields.LongLine
    engine: EngineRecord
    backend: BackendRecord
    render: RenderRecord
    host: HostRecord
    environment: dict[fields.Line, fields.LongLine]
    parameters: dict[fields.Line, Any]
    seed: int
    checks: list[CheckRecord]
    warnings: list[fields.Message]
    git: GitRecord | None
    source: SourceRecord
    evidence_key: fields.Sha256


class Manifest(fields.Strict):
    """`manifest.json`, in the shape of an in-toto Statement."""

    type_: Literal["https://in-toto.io/Statement/v1"] = Field(alias="_type")
    subject: list[Subject]
    predicate_type: Literal["urn:robo-genesis:evidence:v2"] = Field(
        alias="predicateType"
    )
    predicate: Predicate


class Metric(fields.Strict):
    """One number of `metrics.json`; null means not observed."""

    value: int | float | None
    unit: fields.Line
    kind: Literal["exact", "value", "performance"] = Field(alias="class")
    source: list[fields.Line] = Field(alias="from")


class Variable(fields.Strict):
    """One array of `arrays.json`. `unit` is a list if each DOF has its own unit."""

    dims: list[fields.Line]
    shape: list[int]
    dtype: fields.Line
    unit: fields.Line | list[fields.Line]
    long_name: fields.Line


class CaseArrays(fields.Strict):
    """The arrays of one case."""

    file: fields.Line
    note: fields.Line
    variables: dict[fields.Line, Variable]


class JointRecord(fields.Strict):
    """The joint of one DOF of the arrays; a limit is null if the model has none."""

    name: fields.Line
    type_: fields.Line = Field(alias="type")
    dof_idx_local: fields.Index
    q_idx_local: fields.Index
    lower: float | None
    upper: float | None
    unit: fields.Line


class Arrays(fields.Strict):
    """`arrays.json`: labels of the dimensions, the joints, and the arrays of each case."""

    coords: dict[fields.Line, list[fields.Line]]
    joints: list[JointRecord]
    cases: dict[fields.Line, CaseArrays]


def sha256(path: Path) -> str:
    """Return the hexadecimal SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def evidence_key(predicate: dict[str, Any]) -> str:
    """Return the SHA-256 of what decides the results of a bundle, as canonical JSON (RFC 8785).

    It covers schema, lesson and page, the code that computes, engine versions,
    parameters, seed and precision. It does not cover commit, time, host, driver or
    prose.

    Raises:
        rfc8785.CanonicalizationError: JSON cannot hold a value, which `read_json` never
            returns.
    """
    engine = {name: predicate["engine"][name] for name in KEYED_OF_ENGINE}
    keyed = {name: predicate[name] for name in KEYED} | {"engine": engine}
    return hashlib.sha256(rfc8785.dumps(keyed)).hexdigest()


def render_record(drawn: Renderer | None) -> dict[str, Any]:
    """Return what a manifest says about the renderer of its frames, None without a camera."""
    if drawn is None:
        return {"mode": "skip", "vendor": None, "renderer": None, "software": None}
    facts = {"vendor": drawn.vendor, "renderer": drawn.name, "software": drawn.software}
    return {"mode": "camera"} | facts


def read_manifest(folder: Path) -> Manifest:
    """Return the manifest of a bundle; only its form is checked.

    Raises:
        BundleRefused: `older-schema` for a version that this form replaced, `schema`
            for any other version; both are raised first, because the fields of another
            version are unknown. `missing-file`, `bad-json` or `bad-schema` otherwise.
    """
    found = read_json(folder, "manifest.json")
    _check_version(found)
    return _validated(Manifest, found, "manifest.json")


def _check_version(found: Any) -> None:
    """Refuse another version of the form. An older one is `stale`, any other is unknown."""
    statement = found if isinstance(found, dict) else {}
    predicate = statement.get("predicate")
    stated = predicate.get("schema_version") if isinstance(predicate, dict) else None
    versions = [stated] if type(stated) is int else []  # True is not a version
    if isinstance(kind := statement.get("predicateType"), str):
        named = re.fullmatch(r"urn:robo-genesis:evidence:v(\d{1,9})", kind)
        versions.append(int(named[1]) if named else -1)
    valid = all(version in range(SCHEMA_VERSION + 1) for version in versions)
    for version in versions:
        if not valid:
            expect(
                "schema",
                "manifest.json",
                "version of its form",
                version,
                SCHEMA_VERSION,
            )
        expect(
            "older-schema",
            "manifest.json",
            "version of its form",
            version,
            SCHEMA_VERSION,
        )


def read_metrics(folder: Path) -> dict[str, dict[str, Metric]]:
    """Return metrics by group (a case, or `model`) and name."""
    content = read_json(folder, "metrics.json")
    return _validated(
        dict[fields.Line, dict[fields.Line, Metric]], content, "metrics.json"
    )


def by_full_name(metrics: Mapping[str, Mapping[str, Value]]) -> dict[str, Value]:
    """Return metrics by `group.name`."""
    return {
        f"{group}.{name}": m for group, of in metrics.items() for name, m in of.items()
    }


def read_arrays(folder: Path) -> Arrays:
    """Return the description of the arrays of a bundle."""
    return _validated(Arrays, read_json(folder, "arrays.json"), "arrays.json")


def read_printed(folder: Path) -> list[list[dict[str, Any]]]:
    """Return what each code cell of the page put out."""
    return _validated(
        list[list[dict[fields.Line, Any]]], read_json(folder, PRINTED), PRINTED
    )


_adapter = cache(TypeAdapter[Any])


def _validated(form: Any, value: Any, file: str) -> Any:
    try:
        return _adapter(form).validate_python(value)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, (file, *first["loc"])))[:LONGEST_SHOWN]
        raise BundleRefused(
            "bad-schema", f"{place}: {first['msg']}. {AGAIN}"
        ) from error
