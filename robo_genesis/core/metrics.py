"""Arrays and metrics as dataclass fields: names, units, labels, and the sources of a metric.

A record in `metrics.json` has value, unit, class and source. A value that was not
observed is None.
"""

from collections.abc import Sequence
from dataclasses import field, fields
from typing import Any, Literal, NamedTuple

import numpy as np

# What another run must do with a value: agree within a tolerance, repeat it, or
# nothing.
Kind = Literal["value", "exact", "performance"]

Record = dict[str, Any]

# The source of a value that the engine reported and that is in no array
ENGINE = ["engine"]


class Stored(NamedTuple):
    """How one array of a run is stored: the name ends with the unit.

    `dims` are `state` (n+1), `step` (n), `env`, `dof`, `link`, `axis` (x, y, z), `wxyz`
    and `finger`. `unit` is None if each DOF has its own. The engine computes in
    float32.
    """

    name: str
    dims: tuple[str, ...]
    unit: str | None
    long_name: str
    dtype: str = "float32"


def array(
    name: str, dims: str, unit: str | None, long_name: str, dtype: str = "float32"
) -> Any:
    """Return a dataclass field for one array; see `Stored`. Spaces separate the `dims`."""
    return field(
        metadata={"stored": Stored(name, tuple(dims.split()), unit, long_name, dtype)}
    )


def metric(unit: str, label: str, *sources: str, noun: str = "") -> Any:
    """Return a dataclass field for one metric.

    Args:
        unit: as readers see it; "1" for counts.
        label: in the head of a table.
        sources: names of the arrays in a bundle that it is computed from.
        noun: its name in a sentence, by default the label.
    """
    about = {"unit": unit, "label": label, "sources": sources, "noun": noun or label}
    return field(metadata=about)


class CaseMetrics:
    """Base of the metrics of one case: a frozen dataclass whose fields are all `metric`.

    Numbers of NumPy become numbers of Python.
    """

    __slots__ = ()

    def __post_init__(self) -> None:
        for name, value, _ in self.items():
            if isinstance(value, np.generic):
                object.__setattr__(self, name, value.item())

    @classmethod
    def about(cls, what: str) -> dict[str, Any]:
        """Return `unit`, `label`, `sources` or `noun` of each metric by its name."""
        declared = fields(cls)  # type: ignore[arg-type]
        return {one.name: one.metadata[what] for one in declared}

    def items(self) -> list[tuple[str, float | None, str]]:
        """Return (name, value, unit) in the order of the table."""
        return [
            (name, getattr(self, name), unit)
            for name, unit in self.about("unit").items()
        ]

    def records(self) -> dict[str, Record]:
        """Return the record of each metric by its name."""
        sources = self.about("sources")
        return {
            name: record(
                value, unit, "exact" if unit == "1" else "value", sources[name]
            )
            for name, value, unit in self.items()
        }


def record(
    value: float | None, unit: str, kind: Kind, sources: Sequence[str]
) -> Record:
    """Return a value as JSON values for `metrics.json`."""
    return {"value": value, "unit": unit, "class": kind, "from": list(sources)}
