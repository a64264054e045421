"""The evidence bundle: one folder with everything that one page measured on one backend.

manifest.json   in-toto Statement: every other file with its sha256, one strict predicate
metrics.json    value, unit, class and source array of each metric; null = not observed
arrays.json     the joint behind each DOF; dims, dtype, unit and long name of every array
arrays/<case>.npz
frames/*.png    camera frames only
log.txt         the engine's own log
"""

import hashlib
import re
from pathlib import Path
from typing import Annotated, Any, Literal

import rfc8785
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.strict_json import parse_strict

STATEMENT_TYPE = "https://in-toto.io/Statement/v1"
PREDICATE_TYPE = "urn:robo-genesis:evidence:v1"
SCHEMA_VERSION = 1

Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
RunId = Annotated[str, Field(pattern="^[0-9a-f]{32}$")]
Index = Annotated[int, Field(ge=0, lt=2**31)]
Timestamp = Annotated[str, Field(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z$")]


class Strict(BaseModel):
    """A record that refuses unknown fields, converted types and later changes."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class Digest(Strict):
    """Digests of one file."""

    sha256: Sha256


class Subject(Strict):
    """One file of the bundle, path relative to its folder."""

    name: str
    digest: Digest


class EngineRecord(Strict):
    """The engine that computed."""

    version: str
    quadrants_version: str
    precision: str
    files_match_wheel: bool


class BackendRecord(Strict):
    """Where it computed: asked for, found after init, found again at the end."""

    requested: Literal["auto", "cpu"]
    actual: Literal["cpu", "cuda", "amdgpu", "metal"]
    actual_at_end: Literal["cpu", "cuda", "amdgpu", "metal"]
    arch: str
    torch_device: str
    torch_version: str
    hip_version: str | None
    cuda_version: str | None
    device_name: str
    driver: str | None


class RenderRecord(Strict):
    """Who drew the frames, or that none were asked for."""

    mode: Literal["camera", "skip"]
    vendor: str | None
    renderer: str | None
    software: bool | None


class HostRecord(Strict):
    """The machine and its packages."""

    os: str
    machine: str
    cpu: str
    cores: int
    python: str
    packages: dict[str, str]


class GitRecord(Strict):
    """State of the checkout, where there is one."""

    commit: str
    dirty: bool


class SourceRecord(Strict):
    """Digests of the code that computed: the page's code cells and the package's modules."""

    page: Sha256 | None
    modules: dict[str, Sha256]


class CheckRecord(Strict):
    """Outcome of one named check."""

    name: str
    passed: bool
    detail: str


class Predicate(Strict):
    """What is said about the files."""

    schema_version: int
    lesson: str
    page: str
    run_id: RunId
    started: Timestamp
    ended: Timestamp
    command: str
    engine: EngineRecord
    backend: BackendRecord
    render: RenderRecord
    host: HostRecord
    environment: dict[str, str]
    parameters: dict[str, Any]
    seed: int
    checks: list[CheckRecord]
    warnings: list[str]
    git: GitRecord | None
    source: SourceRecord
    evidence_key: Sha256


class Manifest(Strict):
    """`manifest.json`, in the shape of an in-toto Statement."""

    type_: Literal["https://in-toto.io/Statement/v1"] = Field(alias="_type")
    subject: list[Subject]
    predicate_type: Literal["urn:robo-genesis:evidence:v1"] = Field(alias="predicateType")
    predicate: Predicate


class Metric(Strict):
    """One number of `metrics.json`; null where it was not observed."""

    value: int | float | None
    unit: str
    kind: Literal["exact", "value", "performance"] = Field(alias="class")
    source: list[str] = Field(alias="from")


class Variable(Strict):
    """One array of `arrays.json`. `unit` has one entry a DOF where DOFs have different units."""

    dims: list[str]
    shape: list[int]
    dtype: str
    unit: str | list[str]
    long_name: str


class CaseArrays(Strict):
    """The arrays of one case."""

    file: str
    note: str
    variables: dict[str, Variable]


class JointRecord(Strict):
    """The joint behind one DOF of the arrays; a limit is null where the model has none."""

    name: str
    type_: str = Field(alias="type")
    dof_idx_local: Index
    q_idx_local: Index
    lower: float | None
    upper: float | None
    unit: str


class Arrays(Strict):
    """`arrays.json`: labels of the dimensions, the joints, and every array of every case."""

    coords: dict[str, list[str]]
    joints: list[JointRecord]
    cases: dict[str, CaseArrays]


def sha256(path: Path) -> str:
    """Return the hexadecimal SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def canonical_sha256(value: Any) -> str:
    """Return the SHA-256 of a value's canonical JSON (RFC 8785)."""
    try:
        return hashlib.sha256(rfc8785.dumps(value)).hexdigest()
    except (rfc8785.CanonicalizationError, RecursionError) as error:
        raise BundleRefused(
            "bad-json", f"manifest.json: {error}, expected numbers that JSON can carry. {AGAIN}"
        ) from error


def evidence_key(predicate: dict[str, Any]) -> str:
    """Return the key that says which question a bundle answers.

    It covers schema, lesson and page, the code that computes, engine versions, parameters, seed
    and precision; not commit, time, host, driver or prose.
    """
    engine = predicate["engine"]
    keyed = {name: predicate[name] for name in ("schema_version", "lesson", "page", "source")}
    keyed |= {name: predicate[name] for name in ("parameters", "seed")}
    keyed["engine"] = {n: engine[n] for n in ("version", "quadrants_version", "precision")}
    return canonical_sha256(keyed)


def read_json(folder: Path, name: str) -> Any:
    """Return the strictly parsed content of one JSON file of a bundle."""
    path = folder / name
    if not path.is_file():
        raise BundleRefused("missing-file", f"{name} is not in {folder.name}. {AGAIN}")
    try:
        return parse_strict(path.read_text(encoding="utf-8"), name)
    except UnicodeDecodeError as error:
        raise BundleRefused("bad-json", f"{name} is not UTF-8: {error}. {AGAIN}") from error


def read_manifest(folder: Path) -> Manifest:
    """Return a bundle's manifest after checking its form, and its form only.

    Raises:
        BundleRefused: for another version of the form, which comes before all else, since what its
            fields mean is not known here: `older-schema` for one that this form followed, `schema`
            for any other.
    """
    found = read_json(folder, "manifest.json")
    _check_version(found)
    return _validated(Manifest, found, "manifest.json")


def _check_version(found: Any) -> None:
    """What an older version of the course wrote is honest; any other form is unknown here."""
    predicate = found.get("predicate") if isinstance(found, dict) else None
    kind = found.get("predicateType") if isinstance(found, dict) else None
    version = predicate.get("schema_version") if isinstance(predicate, dict) else None
    stated: list[tuple[str, str | int, str | int]] = []
    if isinstance(kind, str):
        stated.append(("predicateType", kind, PREDICATE_TYPE))
    if type(version) is int:  # True is no version
        stated.append(("schema_version", version, SCHEMA_VERSION))
    for field, value, today in stated:
        if _version(value) not in range(_version(today)):
            expect("schema", "manifest.json", field, value, today)
    for field, value, today in stated:
        expect("older-schema", "manifest.json", field, value, today)


def _version(stated: str | int) -> int:
    """Return the number of a version or of a predicate type, -1 where it has none."""
    if isinstance(stated, int):
        return stated
    match = re.fullmatch(r"urn:robo-genesis:evidence:v(\d{1,9})", stated)
    return int(match[1]) if match else -1


def read_metrics(folder: Path) -> dict[str, dict[str, Metric]]:
    """Return metrics by group (a case, or `model`) and name."""
    found = read_json(folder, "metrics.json")
    if not isinstance(found, dict) or not all(isinstance(v, dict) for v in found.values()):
        raise BundleRefused("bad-schema", f"metrics.json is not groups of metrics. {AGAIN}")
    return {
        group: {
            n: _validated(Metric, value, f"metrics.json {group}.{n}") for n, value in items.items()
        }
        for group, items in found.items()
    }


def read_arrays(folder: Path) -> Arrays:
    """Return the description of a bundle's arrays."""
    return _validated(Arrays, read_json(folder, "arrays.json"), "arrays.json")


def _validated(model: type, value: Any, where: str) -> Any:
    try:
        return model.model_validate(value)  # type: ignore[attr-defined]
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise BundleRefused("bad-schema", f"{where}: {place}: {first['msg']}. {AGAIN}") from error
