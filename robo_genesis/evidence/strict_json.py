"""JSON values: read without ambiguity, and compared."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from robo_genesis.core.refusals import AGAIN, BundleRefused, shown

LARGEST = 2**53
"""The largest magnitude of a number: up to here, a float holds every integer."""

DEEPEST = 32
"""Levels of lists and objects. Those of a bundle have less than 10."""


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
    """Parse JSON without repeated keys, byte order marks or lone surrogates.

    Numbers are finite and at most `LARGEST`; lists and objects are at most `DEEPEST` levels deep.

    Raises:
        BundleRefused: `bad-json`, naming `where` and what was found.
    """
    try:
        value = json.loads(
            text,
            object_pairs_hook=_no_duplicates,
            parse_int=_integer,
            parse_float=_float,
            parse_constant=_float,
        )
        _require_depth(value)
        if "\\u" in text:  # a lone surrogate cannot be written as UTF-8
            json.dumps(value, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise BundleRefused(
            "bad-json", f"{where}: {error}, expected strict JSON in UTF-8. {AGAIN}"
        ) from error
    return value


def _integer(text: str) -> int:
    if len(text) > len(f"-{LARGEST}") or abs(int(text)) > LARGEST:
        raise ValueError(f"{shown(text)} is a number beyond ±2⁵³")
    return int(text)


def _float(text: str) -> float:
    value = float(text)
    if not abs(value) <= LARGEST:
        raise ValueError(f"{shown(text)} is not a number within ±2⁵³")
    return value


def _require_depth(value: Any) -> None:
    """Raise ValueError if lists and objects are nested too deeply; nothing here is recursive."""
    level: list[Any] = [[value]]
    depth = 0
    while level := [
        inner
        for outer in level
        for inner in (outer.values() if isinstance(outer, dict) else outer)
        if isinstance(inner, (dict, list))
    ]:
        depth += 1
        if depth > DEEPEST:
            raise ValueError(f"lists and objects are nested in more than {DEEPEST} levels")


def _no_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError(f"duplicate key among {shown([key for key, _ in pairs])}")
    return found


def differences(found: Any, expected: Any, path: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Yield (path, found, expected) where two JSON values differ; `absent` is a missing entry."""
    if found == expected:
        return
    if isinstance(found, dict) and isinstance(expected, dict):
        for name in sorted(found.keys() | expected.keys()):
            inner = f"{path}.{name}" if path else name
            yield from differences(found.get(name, "absent"), expected.get(name, "absent"), inner)
    else:
        yield path, found, expected
