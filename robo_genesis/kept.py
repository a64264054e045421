"""Figures that are measured apart from a build: kept with the book, read, told stale."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from robo_genesis import project

FOLDER = "performance"
"""Below the book."""


class KeptError(Exception):
    """Figures cannot be measured or read; the message says what to do."""


class Part(BaseModel):
    """Part of a record; nothing that it does not name may stand in it."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Record(Part):
    """One measurement: engine, digest of the lock, date and number of cores."""

    engine: str
    lock: str
    date: str
    cores: int


Kind = TypeVar("Kind", bound=Record)


def surroundings(root: Path = project.ROOT) -> dict[str, Any]:
    """Return the fields of `Record` for a measurement that is made now.

    Raises:
        ProjectError: another engine than the pinned one is installed.
    """
    return {
        "engine": project.require_pinned_engine(root),
        "lock": project.lock_digest(root),
        "date": datetime.now(UTC).date().isoformat(),
        "cores": os.cpu_count() or 1,
    }


def read(path: Path, kind: type[Kind], command: str) -> Kind | None:
    """Return a kept record, None where there is none.

    Args:
        path: the file.
        kind: what it must be.
        command: writes it.

    Raises:
        KeptError: the file is no such record.
    """
    if not path.is_file():
        return None
    try:
        return kind.model_validate_json(path.read_bytes())
    except ValidationError as error:
        raise KeptError(
            f"{path} is no record of {kind.__name__.lower()}: {error}\n`{command}` writes it."
        ) from error


def keep(path: Path, values: Any) -> Path:
    """Put JSON values, or a record, in place of the last ones in one move."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_suffix(".tmp")
    content = values.model_dump() if isinstance(values, BaseModel) else values
    fresh.write_text(json.dumps(content, indent=1) + "\n", "utf8")
    return fresh.replace(path)


def stale(record: Record, root: Path = project.ROOT) -> str | None:
    """Return why a measurement no longer speaks of this checkout, None where it does."""
    pin = project.engine_pin(root)
    if record.engine != pin:
        return f"measured with Genesis {record.engine}, pinned is {pin}"
    if record.lock != project.lock_digest(root):
        return "the lock of all packages has changed since"
    return None
