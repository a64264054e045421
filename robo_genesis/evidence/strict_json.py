"""JSON that can be read in one way only."""

import json
import math
from typing import Any

from robo_genesis.core.refusals import AGAIN, BundleRefused, shown


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
