"""The form of a lesson's declaration in its `pages.py`."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from .channels import Replay
from .experiment import MeasuringPage
from .metrics import CaseMetrics

MEASURES = False


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson.

    | field | meaning |
    |---|---|
    | `spec` | its module of data, with the names below |
    | `metrics` | by case, the class of its metrics |
    | `pages` | the measuring pages by name |
    | `replays` | by name; the pictures of its evidence show the first |
    | `spec.MINIMUM_HARDWARE` | the backend whose evidence a release requires |
    | `spec.CASES` | the runs of the lab by name |
    | `spec.RESOLUTION` | by unit, the difference below which two values count as equal |
    | `spec.TOLERANCES` | by unit, metric, group, case or array, (atol, rtol) of a value elsewhere |
    | `spec.RELATIONS` | the orderings that the lesson claims |
    """

    spec: ModuleType
    metrics: Mapping[str, type[CaseMetrics]]
    pages: Mapping[str, MeasuringPage]
    replays: Mapping[str, Replay]

    def about_metrics(self, what: str) -> dict[str, Any]:
        """Return `unit`, `label` or `noun` of each of its metrics by name."""
        return {
            name: v
            for of in self.metrics.values()
            for name, v in of.about(what).items()
        }
