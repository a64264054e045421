"""Refusals, and JSON that can be read in one way only."""

import json
import math
import re
from typing import Any

AGAIN = "Record the bundle again."
LONGEST_SHOWN = 160


class BundleRefused(ValueError):  # noqa: N818 - the word of the domain: accepted or refused
    """A bundle that must not become evidence. `code` is stable; the message says what to do."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(f"{code}: {message}")
        self.code = code


def shown(value: object) -> str:
    """Return a value as Python writes it, cut where it is long: a message is read by people."""
    text = repr(value)
    if re.fullmatch("'[0-9a-f]{64}'", text):
        return f"{text[:13]}…'"
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}…"


def expect(
    code: str, file: str, what: str, found: object, expected: object, mend: str = AGAIN
) -> None:
    """Raise BundleRefused with `code` unless `found` equals `expected`.

    Args:
        code: stable name of the refusal.
        file: where in the bundle the value stands.
        what: the value's name.
        found: the bundle's.
        expected: the right one.
        mend: what to do about it.
    """
    if found != expected:
        raise BundleRefused(
            code, f"{file}: {what} is {shown(found)}, expected {shown(expected)}. {mend}"
        )


def parse_strict(text: str, where: str) -> Any:
    """Parse JSON: no key twice, no byte order mark, every number finite, every character whole.

    Raises:
        BundleRefused: `bad-json`, naming `where` and what was found.
    """
    try:
        value = json.loads(
            text,
            object_pairs_hook=_no_duplicates,
            parse_constant=_no_constant,
            parse_float=_finite,
        )
        json.dumps(value, ensure_ascii=False).encode()  # a lone surrogate has no UTF-8
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


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is no JSON number")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is too large for a number")
    return value
