"""The declaration of a page that measures, and the experiment that one run of it is."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from .checks import Check, Finding, evaluate
from .metrics import ENGINE, CaseMetrics, Kind, Record, record
from .trace import TimeSeries


@dataclass(frozen=True, slots=True)
class Run:
    """One recorded run of a page.

    `case` holds its settings. `measured` is whether it has metrics. `note` says how its
    arrays differ from an ordinary run of the engine. `kind` is the class of its trace,
    None for that of the page.
    """

    case: Any
    measured: bool = True
    note: str = ""
    kind: type[TimeSeries] | None = None


def runs_of(cases: Mapping[str, Any], *about: Any, **more: Any) -> dict[str, Run]:
    """Return a `Run` of each case, by default an ordinary one with metrics."""
    return {name: Run(case, *about, **more) for name, case in cases.items()}


def inputs(
    cases: Mapping[str, Any], view: Mapping[str, Any] | None = None, **further: Any
) -> dict[str, Any]:
    """Return configured inputs as JSON values, for the evidence key.

    Args:
        cases: by name, dataclasses.
        view: the arguments of the camera, None without one.
        further: other inputs by name.
    """
    found = {"cases": case_inputs(cases)} | further
    if view is not None:
        found["view"] = {name: value for name, value in view.items() if name != "GUI"}
    return found


def case_inputs(cases: Mapping[str, Any]) -> dict[str, Any]:
    """Return every field of every case, which are dataclasses, as JSON values."""
    return {name: json_value(asdict(case)) for name, case in cases.items()}


def json_value(value: Any) -> Any:
    """Return arrays, numbers of NumPy and tuples as Python's lists and numbers, others as given."""
    return json.loads(json.dumps(value, default=lambda array: array.tolist()))


@dataclass(frozen=True, slots=True)
class Readings:
    """A group of values that the engine reports and that are in no array.

    `units` are by name. Values of kind `exact` are counts, which another run must
    repeat. Those of kind `performance` are elapsed times and memory, which no other run
    has to repeat.
    """

    units: Mapping[str, str]
    kind: Kind = "value"


def counts(names: Iterable[str]) -> Readings:
    """Return a group of counts."""
    return Readings(dict.fromkeys(names, "1"), "exact")


# Yields what it found in an experiment; its docstring is its claim.
CheckFunction = Callable[["Experiment"], Iterable[Finding]]


@dataclass(frozen=True, slots=True)
class MeasuringPage:
    """A page that runs the engine and writes a bundle.

    | field | meaning |
    |---|---|
    | `runs` | by the name of their arrays; a bundle has no others |
    | `kind` | the class of their traces |
    | `links` | labels of the arrays' links, none for any different ones |
    | `joints` | labels of the arrays' DOFs, none for free bodies |
    | `readings` | the groups of values of the engine |
    | `with_camera` | those that a run with a camera has besides or in their place |
    | `measure` | returns the metrics of a case from its trace |
    | `checks` | named checks in the order of their table |
    | `parameters` | returns every configured input as JSON values |
    | `camera` | whether it has camera frames where the environment asks for them |
    | `frames` | the names of these frames |

    The code that measures needs no declaration: `sources.measuring_modules` finds it.
        The `spec` of
    a lesson is not in it, because `parameters` covers it.
    """

    runs: Mapping[str, Run]
    kind: type[TimeSeries]
    readings: Mapping[str, Readings]
    measure: Callable[[Any, Any], CaseMetrics]
    checks: Sequence[CheckFunction]
    parameters: Callable[[], dict[str, Any]]
    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    with_camera: Mapping[str, Readings] = field(default_factory=dict)
    camera: bool = True
    frames: tuple[str, ...] = ("initial", "final")

    @property
    def cases(self) -> dict[str, Any]:
        """The settings of each run."""
        return {name: run.case for name, run in self.runs.items()}

    def groups(self, rendered: bool) -> dict[str, Readings]:
        """Return the groups of values of a run with or without a camera."""
        return {**self.readings, **(self.with_camera if rendered else {})}

    def with_more(
        self,
        parameters: Callable[[], dict[str, Any]] = dict,
        runs: Mapping[str, Run] = MappingProxyType({}),
        readings: Mapping[str, Readings] = MappingProxyType({}),
        checks: Sequence[CheckFunction] = (),
    ) -> "MeasuringPage":
        """Return a page that has all of this one, and more runs, readings, checks and inputs."""
        return replace(
            self,
            runs={**self.runs, **runs},
            readings={**self.readings, **readings},
            checks=(*self.checks, *checks),
            parameters=lambda: self.parameters() | parameters(),
        )

    def metrics(self, traces: Mapping[str, Any]) -> dict[str, Any]:
        """Return the metrics of each run that has a trace and metrics.

        Raises:
            ValueError, IndexError: the arrays of a run give no metrics.
        """
        measured = {
            n: run.case for n, run in self.runs.items() if run.measured and n in traces
        }
        return {
            name: self.measure(traces[name], case) for name, case in measured.items()
        }


@dataclass(frozen=True)
class Experiment:
    """What one run of a page measured; the page and the verification build the same object.

    | field | meaning |
    |---|---|
    | `page` | its declaration |
    | `traces` | by run, in the order of the declaration |
    | `links` | names of the links, in the order of the arrays |
    | `readings` | by group and name |
    | `frames` | camera frames by name, each (height, width, 3); none without a camera |
    | `rendered` | whether the run had a camera |
    | `joints` | the `JointMap` of the arrays' DOFs, None for free bodies |
    | `accepted` | metrics by run that are taken as they were recorded, None to compute them |
    """

    page: MeasuringPage
    traces: Mapping[str, Any]
    links: Sequence[str]
    readings: Mapping[str, Mapping[str, float]]
    frames: Mapping[str, np.ndarray]
    rendered: bool
    joints: Any = None
    accepted: Mapping[str, CaseMetrics] | None = None

    @cached_property
    def cases(self) -> dict[str, Any]:
        """The settings of each run."""
        return self.page.cases

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """The metrics of each run that has some; raises as `MeasuringPage.metrics`."""
        if self.accepted is not None:
            return dict(self.accepted)
        return self.page.metrics(self.traces)

    def records(self) -> dict[str, dict[str, Record]]:
        """Return the content of `metrics.json`: readings of the engine and metrics of each run."""
        of_engine = {
            group: {
                name: record(value, of.units[name], of.kind, ENGINE)
                for name, value in self.readings[group].items()
            }
            for group, of in self.page.groups(self.rendered).items()
        }
        return of_engine | {
            case: found.records() for case, found in self.metrics.items()
        }

    def outcomes(self) -> tuple[Check, ...]:
        """Return the outcomes of the named checks."""
        return evaluate(self.page.checks, self)
