"""Functions that students write: tests of what they return, and the check that demands them."""

from collections.abc import Callable, Iterable, Sequence
from copy import deepcopy
from functools import partial, wraps
from inspect import signature
from reprlib import Repr
from traceback import extract_tb
from typing import Any

import numpy as np

from .checks import Check, CheckFailed, Finding, Findings, equal
from .experiment import Experiment, MeasuringPage, counts
from .scene import FloatArray

MEASURES = False


def refused(call: Callable[[], Any]) -> Exception | None:
    """Return the exception that a call raises, None if it raises none."""
    try:
        call()
    except Exception as error:  # the caller checks its type
        return error
    return None


# The group of readings with 1 for each function of a page that passed its test, else 0.
FUNCTIONS = "functions"


def functions(run: Experiment) -> Findings:
    """Each function that the page leaves to write passed its test."""
    for name, passed in run.readings[FUNCTIONS].items():
        yield equal(name, passed, 1)


def with_functions(page: MeasuringPage, *names: str) -> MeasuringPage:
    """Return a page on which a student writes these functions; its check requires them all."""
    return page.with_more(readings={FUNCTIONS: counts(names)}, checks=[functions])


class FunctionFailed(CheckFailed):
    """A student's function did not pass its test. A notebook shows the message alone."""

    def _render_traceback_(self) -> list[str]:
        return str(self).splitlines()


# Arguments that a student's function could change for later tests; robots and scenes are
# given as they are.
DATA = (np.ndarray, list, tuple, dict)


class Watched:
    """A student's function, called with copies, that notes its last call in words."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function, self.call, self.changed = function, "", ""
        self.name = getattr(function, "__name__", "the function")

    def __call__(self, *given: Any) -> Any:
        """Call the function with copies, and note in `changed` which of them it changed."""
        self.call = f"{self.name}({', '.join(map(brief, given))})"
        copies = [deepcopy(of) if isinstance(of, DATA) else of for of in given]
        result = self.function(*copies)
        self.call += f" returned {brief(result)}"
        for number, (before, after) in enumerate(zip(given, copies, strict=True)):
            differ = partial(np.testing.assert_equal, after, before)
            if after is not before and refused(differ):
                names = [*signature(self.function).parameters][: number + 1]
                self.changed = (
                    f"{self.call}\n  It changed its argument {names[-1]}. Use a copy."
                )
        return result

    def raised(self, error: Exception) -> str:
        """Return what an exception says, with the line of the function that raised it."""
        file = getattr(getattr(self.function, "__code__", None), "co_filename", "")
        own = [f for f in extract_tb(error.__traceback__) if f.filename == file]
        line = f"\n  line {own[-1].lineno} of its cell: {own[-1].line}" if own else ""
        return f"{self.call or self.name}: {type(error).__name__}: {error}{line}"


class Brief(Repr):
    """Writes arguments and results on one line.

    Numbers have six digits; the middle of long sequences is left out.
    """

    def __init__(self) -> None:
        super().__init__()
        self.maxlist = self.maxtuple = 20
        self.maxstring = self.maxother = 60

    def repr1(self, x: Any, level: int) -> str:
        """Return a value in words; a number of NumPy as one of Python."""
        return super().repr1(x.item() if isinstance(x, np.generic) else x, level)

    def repr_instance(self, x: Any, level: int) -> str:
        """Return another object; one that draws a picture of itself only by its class."""
        text = super().repr_instance(x, level)
        return text if text.isprintable() else f"<{type(x).__name__}>"

    def repr_float(self, x: float, level: int) -> str:
        """Return a number."""
        return f"{x:.6g}"

    def repr_dict(self, x: dict[Any, Any], level: int) -> str:
        """Return a mapping in its own order."""
        items = (f"{key!r}: {self.repr1(value, level - 1)}" for key, value in x.items())
        return f"{{{', '.join(items)}}}"

    def repr_ndarray(self, x: np.ndarray, level: int) -> str:
        """Return an array."""
        text = np.array2string(
            x,
            separator=", ",
            threshold=60,
            formatter={"float_kind": "{:.6g}".format},
        )
        return " ".join(text.split())


brief = Brief().repr

Written = Callable[..., Any]  # A function that a student wrote


def as_test(findings: Callable[..., Iterable[Finding]]) -> Callable[..., Check]:
    """Make a test from a generator of findings about its first argument, a student's function.

    The test ends with the first value that is not allowed, and the outcome names its
    call. An exception of the student's function and a changed argument fail the test as
    well.
    """

    @wraps(findings)
    def judge(function: Written, /, *given: Any) -> Check:
        watched, judged, problem = Watched(function), 0, ""
        try:
            for judged, finding in enumerate(findings(watched, *given), 1):  # noqa: B007
                if not finding.passed:
                    problem = f"{watched.call}\n  {finding.problem}"
                    break
        except Exception as error:  # whatever a student's function raises
            problem = watched.raised(error)
        problem = watched.changed or problem
        return Check(findings.__name__, judged > 0 and not problem, problem)

    return judge


# Largest error by rounding in float32, as a share of the largest value, or of 1.
FLOAT32 = 1e-6


def same_array(label: str, found: Any, expected: Any, tiny: float) -> Findings:
    """Require numbers of the shape of the expected ones, which differ from them by rounding.

    If some differ, the first such number, or the first row of them along the last axis,
    is named. Neither text nor truth values are numbers.

    Args:
        label: the beginning of the labels.
        found: what the student's function returned.
        expected: the right result, a number or an array.
        tiny: largest difference that rounding explains in float64.
    """
    values, right = np.asarray(found), np.asarray(expected)
    if values.dtype.kind not in "iuf":
        yield Finding(label, brief(found), False, "numbers")
        return
    if right.ndim == 0 and values.size == 1:
        values = values.reshape(())
    yield equal(f"{label}.shape", str(values.shape), str(right.shape))
    if values.dtype == np.float32:
        tiny = max(tiny, FLOAT32 * np.abs(right).max(initial=1.0))
    good = np.abs(values - right) <= tiny
    if not good.all():
        row = tuple(np.argwhere(~good)[0].tolist())[: max(1, values.ndim - 1)]
        place = f"{label}{list(row)}, the first that differs," if row else label
        texts = [row_text(of[row]) for of in (values, right)]
        if texts[0] == texts[1]:
            texts = [row_text(of[row], 17) for of in (values, right)]
        one = texts[0] if values[row].ndim else values[row].item()
        yield Finding(place, one, False, f"{texts[1]} ± {tiny:g}")


def row_text(values: FloatArray, digits: int = 10) -> str:
    """Return a number, or an array (n,), with significant digits."""
    text = ", ".join(f"{value:.{digits}g}" for value in np.ravel(values))
    return f"[{text}]" if np.ndim(values) else text


def compared(
    run: str,
    names: Sequence[str],
    found: Any,
    expected: Sequence[Any],
    tiny: float,
) -> Findings:
    """Require returned values that are None, or differ by rounding, as the expected ones.

    Args:
        run: the beginning of the labels.
        names: of the values.
        found: what the student's function returned.
        expected: of the same length as `names`.
        tiny: largest difference that rounding explains in float64.
    """
    count = len(found) if hasattr(found, "__len__") else 1
    yield equal(f"{run}.number_of_values", count, len(expected))
    for name, value, right in zip(names, found, expected, strict=True):
        label = f"{run}.{name}"
        if right is None:
            yield equal(label, value, None)
        else:
            yield from same_array(label, value, right, tiny)
