"""What students practise: functions that they write, and mistakes made on purpose.

A test of a student's function judges what the function returns; a mistake is judged by its symptom.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import wraps
from inspect import signature
from typing import Any, ParamSpec

import numpy as np

from robo_genesis.core.checks import Check, Finding, at_most, equal, evaluate
from robo_genesis.core.scene import FloatArray

MEASURES = False

Curves = Mapping[str, tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Mistake:
    """The result of one deliberate mistake.

    `shown` is whether its symptom appeared; `evidence` describes the measurement in either case;
    `curves` by label are two arrays (n,); `axis` and `quantity` name what is drawn to the right and
    what is drawn upwards, with their units.
    """

    name: str
    shown: bool
    evidence: str
    curves: Curves = field(default_factory=dict)
    quantity: str = "position [m]"
    axis: str = "time [s]"

    @property
    def check(self) -> Check:
        """The named check that fails if the symptom did not appear."""
        return Check(f"gallery_{self.name}", self.shown, self.evidence)


def refused(call: Callable[[], Any]) -> Exception | None:
    """Return the exception that a call raises, None if it raises none."""
    try:
        call()
    except Exception as error:  # the caller checks its type
        return error
    return None


def quoted(error: Exception | None) -> str:
    """Quote an exception by type and message, or say that there was none."""
    return f"`{type(error).__name__}`: {error}" if error else "No exception was raised."


Given = ParamSpec("Given")


def as_test(findings: Callable[Given, Iterable[Finding]]) -> Callable[Given, list[Check]]:
    """Make a test of a function that yields findings about a student's function.

    The test raises TypeError if it is called with wrong arguments. Other exceptions are those of
    the student's function and fail the check.
    """

    @wraps(findings)
    def judge(*given: Given.args, **named: Given.kwargs) -> list[Check]:
        signature(findings).bind(*given, **named)

        def of_function(_: None) -> Iterable[Finding]:
            """The function does what its docstring says."""
            return findings(*given, **named)

        of_function.__name__ = findings.__name__
        try:
            return list(evaluate((of_function,), None))
        except Exception as error:  # whatever a student's function raises
            return [Check(findings.__name__, False, f"it raised {type(error).__name__}: {error}")]

    return judge


def same_array(label: str, found: Any, expected: np.ndarray, tiny: float) -> Iterator[Finding]:
    """Require an array of the shape of the expected one, which differs from it by rounding.

    Args:
        label: the beginning of the labels.
        found: what the student's function returned.
        expected: the right result.
        tiny: largest difference that rounding explains.
    """
    values = np.asarray(found, dtype=float)
    yield equal(f"{label}.shape", list(values.shape), list(expected.shape))
    if values.shape == expected.shape:
        yield at_most(f"{label}.largest_error", float(np.abs(values - expected).max()), tiny)


def compared(
    run: str, names: Sequence[str], found: Sequence[Any], expected: Sequence[Any], tiny: float
) -> Iterator[Finding]:
    """Require returned values that are None, or differ by rounding, as the expected ones.

    Args:
        run: the beginning of the labels.
        names: of the values.
        found: what the student's function returned.
        expected: of the same length as `names`.
        tiny: largest difference that rounding explains.
    """
    yield equal(f"{run}.number_of_values", len(found), len(expected))
    for name, value, right in zip(names, found, expected, strict=False):
        label = f"{run}.{name}"
        if value is None or right is None:
            yield equal(label, value, right)
        else:
            yield at_most(f"{label}.error", abs(float(value) - float(right)), tiny)
