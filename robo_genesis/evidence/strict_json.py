"""The JSON files of a bundle: written in one exact form, and read in no other.

Reading writes the value again and compares every byte: a key that is repeated, another
    spelling of
a number or a byte order mark is refused.
"""

import json
from pathlib import Path
from typing import Any

from robo_genesis.core.text import quoted
from robo_genesis.evidence.refusals import AGAIN, BundleRefused

# The largest magnitude of a number: up to here, a float holds every integer.
LARGEST = 2**53 - 1

DEEPEST = 32  # Levels of lists and objects. Those of a bundle have fewer than 10.


def write_json(path: Path, value: Any) -> None:
    """Write a value as UTF-8, one item on each line.

    Raises:
        TypeError, ValueError: JSON cannot hold it, or `read_json` would refuse it.
    """
    path.write_bytes(_content(value))


def read_json(folder: Path, name: str) -> Any:
    """Return the content of one JSON file of a bundle.

    Raises:
        BundleRefused: `missing-file`; `bad-json` if it is not what `write_json` writes.
    """
    path = folder / name
    if not path.is_file():
        raise BundleRefused("missing-file", f"{name} is not in {folder.name}. {AGAIN}")
    try:
        found = path.read_bytes()
        value = json.loads(found.decode())
        if _content(value) != found:
            raise ValueError("the same value, written again, gives other bytes")
    except (ValueError, RecursionError) as error:
        raise BundleRefused(
            "bad-json",
            f"{name}: {error}, expected the recorder's JSON in UTF-8. {AGAIN}",
        ) from error
    return value


def _content(value: Any) -> bytes:
    _require_bounds(value)
    text = json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False)
    return f"{text}\n".encode()


def _require_bounds(value: Any, depth: int = 0) -> None:
    """Raise ValueError for a number beyond `LARGEST`, not finite ones included, or deep nesting."""
    if depth > DEEPEST:
        raise ValueError(f"lists and objects are nested in more than {DEEPEST} levels")
    if isinstance(value, int | float) and not abs(value) <= LARGEST:
        raise ValueError(f"{quoted(value)} is not a number within ±2⁵³")
    if isinstance(value, dict | list | tuple):
        for inner in value.values() if isinstance(value, dict) else value:
            _require_bounds(inner, depth + 1)
