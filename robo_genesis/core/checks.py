"""Named checks: the values that they find, and the error that names each check that failed.

A check is a function that yields findings. Its name is that of the function, and its
docstring is its claim: what it requires. Each finding pairs a measured value with a
judgement.
"""

import math
import operator
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Any

from .check_spec import MASS_SHARE
from .text import quoted

Value = bool | int | float | str | None


FAILED = "failed"  # The code of the refusal of a bundle in which a check fails


class CheckFailed(AssertionError):  # noqa: N818 - read aloud: check failed
    """At least one named check did not pass."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One value that a check found, and its judgement.

    `expected` describes the allowed values in a message. A finding that is not
    `recorded` is about the configuration, repeats metrics, or judges arrays by a law: a
    bundle has these elsewhere.
    """

    label: str
    found: Any
    passed: bool
    expected: str
    recorded: bool = True

    @property
    def problem(self) -> str:
        """The message about a value that is not allowed."""
        found = quoted(plain(self.found))
        if found in (
            self.expected,
            *self.expected.split(),
        ):  # "1" and 1, 0.5 and 0.50000001
            found = f"{self.found!r} ({type(self.found).__name__})"
        return f"{self.label} is {found}, expected {self.expected}"


@dataclass(frozen=True, slots=True)
class Check:
    """Outcome of one check.

    `detail` names the problems if it failed, else what the check requires. `found` has
    the recorded values by label; neither `detail` nor the allowed values are in a
    bundle.
    """

    name: str
    passed: bool
    detail: str
    found: Mapping[str, Value] = field(default_factory=dict)

    def record(self) -> dict[str, Any]:
        """Return the outcome as JSON values for a bundle."""
        return {"name": self.name, "passed": self.passed, "found": dict(self.found)}


def of_python(value: Any) -> Any:
    """Return numbers of NumPy and Torch as those of Python, which are judged in float64."""
    return value.tolist() if hasattr(value, "tolist") else value


def plain(value: Any) -> Value:
    """Return a value as JSON can hold it: numbers that are not finite, and all else, as text."""
    value = of_python(value)
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, list | tuple):
        return ", ".join(map(str, value))
    return value if isinstance(value, bool | int | float | str | None) else repr(value)


Findings = Iterator[Finding]  # What a check yields


def noted(label: str, found: Any) -> Finding:
    """Record a value without a judgement of its own."""
    return Finding(label, found, True, "any value")


def equal(label: str, found: Any, expected: Any, recorded: bool = True) -> Finding:
    """Require exactly the expected value."""
    required = plain(expected)
    return Finding(label, found, plain(found) == required, quoted(required), recorded)


def within(label: str, found: Any, expected: float, tolerance: float) -> Finding:
    """Require a value that differs from the expected one by no more than the tolerance."""
    found = of_python(found)
    passed = found is not None and abs(found - expected) <= tolerance
    return Finding(label, found, bool(passed), f"{expected:.10g} ± {tolerance:g}")


def nearly(
    label: str, found: Any, expected: float, share: float, room: float = 0.0
) -> Finding:
    """Require a value that differs from the expected one by a share of it and some room at most."""
    return within(label, found, expected, share * abs(expected) + room)


def _limited(
    order: Callable[[Any, Any], Any], words: str, label: str, found: Any, limit: float
) -> Finding:
    """Require a value that has this order to the limit."""
    found = of_python(found)
    passed = found is not None and order(found, limit)
    return Finding(label, found, bool(passed), f"{words} {limit:g}")


at_most = partial(_limited, operator.le, "at most")
below = partial(_limited, operator.lt, "less than")
above = partial(_limited, operator.gt, "more than")


def model_counts(found: Mapping[str, float], expected: Mapping[str, float]) -> Findings:
    """Require the engine's counts of a model."""
    for name in dict.fromkeys([*found, *expected]):
        yield equal(name, found.get(name), expected.get(name))


def masses(found: Mapping[str, float], expected: Mapping[str, float]) -> Findings:
    """Require of each body the engine's mass to be density times volume.

    Args:
        found: the engine's mass of each body [kg].
        expected: density times volume of each body [kg].
    """
    for body, mass in expected.items():
        yield nearly(f"{body}.mass_kg", found.get(body), mass, MASS_SHARE)


def factors(
    cases: Mapping[str, Any], allowed: Mapping[tuple[str, str], Collection[str]]
) -> Findings:
    """Require of each pair of cases, which are dataclasses, to differ in the given fields alone."""
    for (first, second), fields in allowed.items():
        a, b = (asdict(cases[name]) for name in (first, second))
        differ = sorted(name for name in a if a[name] != b[name])
        label = f"difference of {first} and {second}"
        yield equal(label, differ, sorted(fields), recorded=False)


def claim_of(check: Callable[..., Any]) -> str:
    """Return what a check requires: its docstring as one line."""
    return " ".join((check.__doc__ or "").split())


def conclude(
    name: str, claim: str, findings: Sequence[Finding], error: Exception | None = None
) -> Check:
    """Return the outcome of a check from its findings; a check without any fails.

    Args:
        name: of the check.
        claim: what the check requires.
        findings: with different labels; the check fails otherwise.
        error: the exception that ended the check.
    """
    broken = [finding for finding in findings if not finding.passed]
    problems = [finding.problem for finding in broken]
    labels = [finding.label for finding in findings]
    if repeated := sorted({label for label in labels if labels.count(label) > 1}):
        problems.append(
            f"labels are repeated: {', '.join(repeated)}. Give each finding its own"
        )
    if error is not None:
        problems.append(f"cannot be evaluated: {error!r}")
    elif not findings:
        problems.append("nothing was found")
    found = {
        finding.label: plain(finding.found) for finding in findings if finding.recorded
    }
    return Check(name, not problems, "; ".join(problems) or claim, found)


def evaluate(
    named: Iterable[Callable[[Any], Iterable[Finding]]], run: Any
) -> tuple[Check, ...]:
    """Run checks on a subject.

    Args:
        named: the checks.
        run: what they check.
    """
    outcomes = []
    for check in named:
        findings: list[Finding] = []
        failure = None
        try:
            findings.extend(check(run))  # keeps those before an error
        except (ValueError, LookupError, ArithmeticError) as error:
            # Arrays that do not fit together, or values beyond what floats can hold.
            failure = error
        outcomes.append(conclude(check.__name__, claim_of(check), findings, failure))
    return tuple(outcomes)


def require(lesson: str, outcomes: Sequence[Check]) -> str:
    """Return the line that says that all checks passed.

    Raises:
        CheckFailed: naming every check that failed, with what it found.
    """
    failed = [f"[{c.name}] {c.detail}" for c in outcomes if not c.passed]
    if failed or not outcomes:
        raise CheckFailed(
            f"{lesson.upper()} CHECK: FAILED " + " ".join(failed or ["no check ran"])
        )
    return f"{lesson.upper()} CHECK: PASSED"
