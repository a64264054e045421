"""Named checks: all pass, or the exact invariant that failed is named."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

Subject = TypeVar("Subject")


class CheckFailed(AssertionError):  # noqa: N818 - read aloud: check failed
    """At least one named check did not pass."""


@dataclass(frozen=True, slots=True)
class Check:
    """Outcome of one check; `detail` says what was found where it failed, else what was held."""

    name: str
    passed: bool
    detail: str


def evaluate(named: Sequence[Callable[[Subject], list[str]]], run: Subject) -> tuple[Check, ...]:
    """Run checks on what they look at; each function's name and docstring are the check's own."""
    outcomes = []
    for check in named:
        try:
            problems = check(run)
        except (ValueError, KeyError, IndexError) as error:  # arrays that do not fit together
            problems = [f"cannot be evaluated: {error!r}"]
        held = (check.__doc__ or "").strip()
        outcomes.append(Check(check.__name__, not problems, "; ".join(problems) or held))
    return tuple(outcomes)


def require(lesson: str, outcomes: Sequence[Check]) -> str:
    """Return the line that says that all passed.

    Raises:
        CheckFailed: naming every check that did not, with what it found.
    """
    failed = [f"[{c.name}] {c.detail}" for c in outcomes if not c.passed]
    if failed or not outcomes:
        raise CheckFailed(f"{lesson.upper()} CHECK: FAILED " + " ".join(failed or ["no check ran"]))
    return f"{lesson.upper()} CHECK: PASSED"
