"""The form of a lesson's declaration in its `__init__.py`."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from robo_genesis.core.channels import Replay
from robo_genesis.core.experiment import MeasuringPage
from robo_genesis.core.metrics import CaseMetrics

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


def on_demand(package: str, **offered: str) -> Callable[[str], Any]:
    """Return the `__getattr__` of a lesson: what a page uses is imported when it is used.

    A module of the lesson's folder needs no argument. The readers of import statements
    know the arguments as well, so each is written out.

    Args:
        package: the `__name__` of the lesson.
        offered: by name, the module that has it, or that it is: `run` of the lesson's
            folder, or a module of another sub-package by its whole name.
    """

    def imported(name: str) -> Any:
        place = offered.get(name, name)
        module = place if "." in place else f"{package}.{place}"
        if name[:1] == "_" or (name not in offered and not find_spec(module)):
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        found = import_module(module)
        return getattr(found, name, found) if name in offered else found

    return imported
