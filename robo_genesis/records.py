"""The form of a measured number in `metrics.json`: value, unit, class, and what it comes from."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Protocol

Record = dict[str, Any]

ENGINE = ["engine"]
"""The source of what no array holds: the engine said so."""


class Metrics(Protocol):
    """The metrics of one case."""

    def items(self) -> Iterable[tuple[str, float | None, str]]:
        """Return (name, value, unit) of each."""


def counts(found: Mapping[str, int]) -> dict[str, Record]:
    """Return counts of the engine, which are equal in another run or differ."""
    return {
        name: {"value": count, "unit": "1", "class": "exact", "from": ENGINE}
        for name, count in found.items()
    }


def readings(found: Mapping[str, float], unit: str) -> dict[str, Record]:
    """Return values that the engine gave when it was asked, in one unit."""
    return {
        name: {"value": value, "unit": unit, "class": "value", "from": ENGINE}
        for name, value in found.items()
    }


def cases(
    metrics: Mapping[str, Metrics], sources: Mapping[str, Sequence[str]]
) -> dict[str, dict[str, Record]]:
    """Return the metrics of each case; `sources` names the arrays that each is computed from."""
    return {
        case: {
            name: {
                "value": value,
                "unit": unit,
                "class": "exact" if unit == "1" else "value",
                "from": list(sources[name]),
            }
            for name, value, unit in of.items()
        }
        for case, of in metrics.items()
    }
