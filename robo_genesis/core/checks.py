"""Named checks, and the error that names each check that failed."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from robo_genesis.core.trace import TimeSeries

Subject = TypeVar("Subject")

MASS_SHARE = 1e-5
"""Relative tolerance of an engine's mass against density times volume: float32."""


class CheckFailed(AssertionError):  # noqa: N818 - read aloud: check failed
    """At least one named check did not pass."""


@dataclass(frozen=True, slots=True)
class Check:
    """Outcome of one check; `detail` says what was found if it failed, else what it requires."""

    name: str
    passed: bool
    detail: str

    def record(self) -> dict[str, Any]:
        """Return its form in a bundle, which does not repeat what the check requires."""
        detail = "" if self.passed else self.detail
        return {"name": self.name, "passed": self.passed, "detail": detail}


def evaluate(
    named: Sequence[Callable[[Subject], Iterable[str]]], run: Subject
) -> tuple[Check, ...]:
    """Run checks on a subject; each yields the problems that it finds.

    The name and docstring of a function are those of its check.
    """
    outcomes = []
    for check in named:
        try:
            problems = list(check(run))
        except (ValueError, LookupError, ArithmeticError) as error:
            # Arrays that do not fit together, or values beyond what floats can hold.
            problems = [f"cannot be evaluated: {error!r}"]
        requirement = (check.__doc__ or "").strip()
        outcomes.append(Check(check.__name__, not problems, "; ".join(problems) or requirement))
    return tuple(outcomes)


def wrong_times(cases: Mapping[str, Any], traces: Mapping[str, TimeSeries]) -> Iterator[str]:
    """Yield which runs do not have a state for t = 0 and one for each outer step, at k · dt.

    Args:
        cases: by name, with their outer `steps` and `dt` [s].
        traces: by case.
    """
    for name, case in cases.items():
        t, expected = traces[name].t, np.arange(case.steps + 1) * case.dt
        if len(t) != len(expected) or not np.allclose(t, expected, rtol=0, atol=1e-9):
            yield (
                f"{name} has {len(t) - 1} steps to {t[-1]:g} s, asked for {case.steps} steps of "
                f"{case.dt:g} s"
            )


def wrong_counts(found: Mapping[str, float], expected: Mapping[str, float]) -> Iterator[str]:
    """Yield a message if the engine's counts of a model differ from the expected ones."""
    if dict(found) != expected:
        yield f"the model has {dict(found)}, expected {expected}"


def wrong_masses(found: Mapping[str, float], expected: Mapping[str, float]) -> Iterator[str]:
    """Yield the bodies whose mass is not density times volume, or was not read.

    Args:
        found: the engine's mass of each body [kg].
        expected: density times volume of each body [kg].
    """
    for body, mass in expected.items():
        measured = found.get(body, np.nan)
        if not abs(measured - mass) <= MASS_SHARE * mass:
            yield (
                f"the engine's mass of the {body} is {measured:g} kg, density times volume is "
                f"{mass:g} kg"
            )


def require(lesson: str, outcomes: Sequence[Check]) -> str:
    """Return the line that says that all checks passed.

    Raises:
        CheckFailed: naming every check that failed, with what it found.
    """
    failed = [f"[{c.name}] {c.detail}" for c in outcomes if not c.passed]
    if failed or not outcomes:
        raise CheckFailed(f"{lesson.upper()} CHECK: FAILED " + " ".join(failed or ["no check ran"]))
    return f"{lesson.upper()} CHECK: PASSED"
