"""JSON values: read without ambiguity, and compared."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from robo_genesis.core.refusals import AGAIN, BundleRefused, shown


def read_json(folder: Path, name: str) -> Any:
    """Return the strictly parsed content of one JSON file of a bundle."""
    path = folder / name
    if not path.is_file():
        raise BundleRefused("missing-file", f"{name} is not in {folder.name}. {AGAIN}")
    try:
        return parse_strict(path.read_text(encoding="utf-8"), name)
    except UnicodeDecodeError as error:
        raise BundleRefused("bad-json", f"{name} is not UTF-8: {error}. {AGAIN}") from error


def parse_strict(text: str, where: str) -> Any:
    """Parse JSON without repeated keys, byte order marks, infinite numbers or lone surrogates.

    Raises:
        BundleRefused: `bad-json`, naming `where` and what was found.
    """
    try:
        value = json.loads(text, object_pairs_hook=_no_duplicates)
        # Infinity and NaN cannot be written as JSON, nor a lone surrogate as UTF-8.
        json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError) as error:
        raise BundleRefused(
            "bad-json", f"{where}: {error}, expected strict JSON in UTF-8. {AGAIN}"
        ) from error
    return value


def _no_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    keys = [key for key, _ in pairs]
    if len(set(keys)) != len(keys):
        raise ValueError(f"duplicate key among {shown(keys)}")
    return dict(pairs)


def differences(found: Any, expected: Any, path: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Yield (path, found, expected) where two JSON values differ; `absent` is a missing entry."""
    if isinstance(found, dict) and isinstance(expected, dict):
        for name in sorted(found.keys() | expected.keys()):
            inner = f"{path}.{name}" if path else name
            yield from differences(found.get(name, "absent"), expected.get(name, "absent"), inner)
    elif found != expected:
        yield path, found, expected
