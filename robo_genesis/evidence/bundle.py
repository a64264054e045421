"""The evidence bundle: one folder with all that a page measured on one backend.

manifest.json   what ran where, what the checks found, and the SHA-256 of each other file
metrics.json    value, unit, class and source array of each metric; null = not observed
arrays.json     the joint behind each DOF; dims, dtype, unit and long name of every array
arrays/<case>.npz
frames/*.png    camera frames only
shape.npz       the visual geometry, if the page wrote one
log.txt         the engine's own log
printed.json    what the page's cells put out; none of a notebook that was run by hand
"""

import hashlib
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from robo_genesis.core.files import json_digest

from .refusals import AGAIN, BundleRefused, expect

SCHEMA_VERSION = 3
MANIFEST, METRICS, ARRAYS = "manifest.json", "metrics.json", "arrays.json"
PRINTED, LOG = "printed.json", "log.txt"
KEYED = ("schema_version", "lesson", "page", "source", "parameters", "seed")
KEYED_OF_ENGINE = ("version", "quadrants_version", "precision")

Value = TypeVar("Value")
Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
RunId = Annotated[str, Field(pattern="^[0-9a-f]{32}$")]
BackendName = Literal["cpu", "cuda", "amdgpu", "metal"]


class Strict(BaseModel):
    """A frozen record that refuses unknown fields and converts no types."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, allow_inf_nan=False
    )


class EngineRecord(Strict):
    """The engine that computed the runs."""

    version: str
    quadrants_version: str
    precision: str
    files_match_wheel: bool


class BackendRecord(Strict):
    """The backend: requested, found after `gs.init`, and found again at the end of the run."""

    requested: Literal["auto", "cpu"]
    actual: BackendName
    actual_at_end: BackendName
    arch: str
    torch_device: str
    torch_version: str
    hip_version: str | None
    cuda_version: str | None
    device_name: str
    driver: str | None


class RenderRecord(Strict):
    """The renderer of the frames; with mode `skip`, the other fields are None."""

    mode: Literal["camera", "skip"]
    vendor: str | None = None
    renderer: str | None = None
    software: bool | None = None


class HostRecord(Strict):
    """The machine and its packages."""

    os: str
    machine: str
    cpu: str
    cores: int
    python: str
    packages: dict[str, str]


class GitRecord(Strict):
    """State of the checkout."""

    commit: str
    dirty: bool


class SourceRecord(Strict):
    """Digests of the syntax of what computed: code cells and modules; and of data files."""

    page: Sha256 | None
    modules: dict[str, Sha256]


class CheckRecord(Strict):
    """Outcome of one named check: what it found, and whether it passed when it was recorded."""

    name: str
    passed: bool
    found: dict[str, bool | int | float | str | None]


class Manifest(Strict):
    """The circumstances and outcomes of a run. `files` has the digest of each other file."""

    schema_version: int
    lesson: str
    page: str
    run_id: RunId
    started: str
    ended: str
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
    files: dict[str, Sha256]

    @property
    def passed(self) -> str:
        """How many checks passed: `14 of 14`."""
        return f"{sum(check.passed for check in self.checks)} of {len(self.checks)}"


class Metric(Strict):
    """One number of `metrics.json`; null means not observed."""

    value: int | float | None
    unit: str
    kind: Literal["exact", "value", "performance"] = Field(alias="class")
    source: list[str] = Field(alias="from")


class Variable(Strict):
    """One array of `arrays.json`. `unit` is a list if each DOF has its own unit."""

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
    """The joint of one DOF of the arrays; a limit is null if the model has none."""

    name: str
    type_: Literal["REVOLUTE", "PRISMATIC"] = Field(alias="type")
    dof_idx_local: int
    q_idx_local: int
    lower: float | None
    upper: float | None
    unit: str


class Arrays(Strict):
    """`arrays.json`: labels of the dimensions, the joints, and the arrays of each case."""

    coords: dict[str, list[str]]
    joints: list[JointRecord]
    cases: dict[str, CaseArrays]


class _Version(BaseModel):
    """The version of a manifest of any form; those before the third are 0 here."""

    schema_version: int = 0


def sha256(path: Path) -> str:
    """Return the hexadecimal SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def evidence_key(facts: Mapping[str, Any]) -> str:
    """Return the SHA-256 of what decides the results of a bundle.

    It covers schema, lesson and page, the code that computes, engine versions,
    parameters, seed and precision. It does not cover commit, time, host, driver or
    prose.

    Args:
        facts: the fields of a manifest as JSON values.
    """
    engine = {name: facts["engine"][name] for name in KEYED_OF_ENGINE}
    return json_digest({name: facts[name] for name in KEYED} | {"engine": engine})


def list_files(folder: Path, record: str = MANIFEST) -> dict[str, str]:
    """Return the digest of each file of a folder by name, but of the file that lists them."""
    return {
        path.relative_to(folder).as_posix(): sha256(path)
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path != folder / record
    }


def check_files(folder: Path, manifest: Manifest) -> None:
    """Require that the files are exactly the listed ones, with the listed digests.

    Raises:
        BundleRefused: `files` or `digest`, with the names.
    """
    present, listed = list_files(folder), manifest.files
    for what, names in (
        ("listed, but absent", listed.keys() - present),
        ("not listed", present.keys() - listed),
    ):
        expect("files", MANIFEST, f"list of files that are {what},", sorted(names), [])
    for name, digest in listed.items():
        expect("digest", name, "sha256", present[name], digest)


def write_json(path: Path, value: Any) -> None:
    """Write a value as UTF-8, one item on each line.

    Raises:
        TypeError, ValueError: JSON cannot hold it.
    """
    text = json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False)
    path.write_text(f"{text}\n", "utf8")


def read_manifest(folder: Path) -> Manifest:
    """Return the manifest of a bundle; only its form is checked.

    Raises:
        BundleRefused: `older-schema` for a version that this form replaced, `schema`
            for a later one; `missing-file` or `bad-schema` otherwise.
    """
    version = _read(_Version, folder, MANIFEST).schema_version
    code = "older-schema" if version < SCHEMA_VERSION else "schema"
    expect(code, MANIFEST, "version of its form", version, SCHEMA_VERSION)
    return _read(Manifest, folder, MANIFEST)


def read_metrics(folder: Path) -> dict[str, dict[str, Metric]]:
    """Return metrics by group (a case, or `model`) and name."""
    return _read(dict[str, dict[str, Metric]], folder, METRICS)


def read_arrays(folder: Path) -> Arrays:
    """Return the description of the arrays of a bundle."""
    return _read(Arrays, folder, ARRAYS)


def read_printed(folder: Path) -> list[list[dict[str, Any]]]:
    """Return what each code cell of the page put out."""
    return _read(list[list[dict[str, Any]]], folder, PRINTED)


def by_full_name(metrics: Mapping[str, Mapping[str, Value]]) -> dict[str, Value]:
    """Return metrics by `group.name`."""
    return {
        f"{group}.{name}": metric
        for group, named in metrics.items()
        for name, metric in named.items()
    }


_adapter = cache(TypeAdapter[Any])


def _read(form: Any, folder: Path, name: str) -> Any:
    try:
        return _adapter(form).validate_json((folder / name).read_bytes())
    except OSError as error:
        message = f"{name} cannot be read in {folder.name}: {error.strerror}. {AGAIN}"
        raise BundleRefused("missing-file", message) from error
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, (name, *first["loc"])))
        message = f"{place}: {first['msg']}. {AGAIN}"
        raise BundleRefused("bad-schema", message) from error
