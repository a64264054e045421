"""What a comparison is made of: the lesson's specification, two sides, rows and their states."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from robo_genesis.core.orderings import Relation
from robo_genesis.core.trace import TimeSeries
from robo_genesis.evidence.bundle import Arrays, Manifest, Metric

EQUAL, SHOWN, WITHIN, INCONCLUSIVE, DIFFERS, NOT_COMPARABLE = SEVERITY = (
    "equal", "shown", "within tolerance", "inconclusive", "differs", "not comparable",
)  # fmt: skip
"""States from best to worst; what is only shown decides nothing."""


@dataclass(frozen=True, slots=True)
class Specification:
    """What a lesson declares about its runs, as data of its module.

    `metrics` names those of each case that the page must have; `tolerances` is unit or metric →
    (atol, rtol); `relations` ((first case, second case), metric, order of the second against the
    first, margin).
    """

    lesson: str
    metrics: Mapping[str, tuple[str, ...]]
    tolerances: Mapping[str, tuple[float, float]]
    relations: tuple[Relation, ...]


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two bundles, read."""

    folder: str
    manifest: Manifest
    metrics: Mapping[str, Mapping[str, Metric]]
    arrays: Arrays
    traces: Mapping[str, TimeSeries]

    @property
    def numbers(self) -> dict[str, Metric]:
        """Every metric by `group.name`."""
        return {f"{group}.{n}": m for group, of in self.metrics.items() for n, m in of.items()}

    @property
    def checks(self) -> dict[str, bool]:
        """Whether each check passed; one that stands there twice passed if both did."""
        passed: dict[str, bool] = {}
        for check in self.manifest.predicate.checks:
            passed[check.name] = check.passed and passed.get(check.name, True)
        return passed


@dataclass(frozen=True, slots=True)
class Finding:
    """One row. `weight` orders rows of the same state: a difference as a share of what may be."""

    state: str
    what: str
    old: str
    new: str
    delta: str = ""
    allowed: str = ""
    weight: float = 0.0


@dataclass(frozen=True, slots=True)
class Section:
    """The rows of one kind of question, worst first; `empty` says why there are none."""

    title: str
    findings: tuple[Finding, ...]
    empty: str = ""

    @property
    def state(self) -> str:
        """State of the worst row; without rows nothing differs."""
        return worst([finding.state for finding in self.findings])


def worst(states: Sequence[str]) -> str:
    """Return the worst of some states, `equal` where there is none."""
    return max(states, key=SEVERITY.index, default=EQUAL)


def section(title: str, findings: Iterator[Finding], empty: str = "") -> Section:
    """Return a section with its rows worst first, otherwise in their order."""
    rows = sorted(findings, key=lambda f: (-SEVERITY.index(f.state), -f.weight))
    return Section(title, tuple(rows), empty)
