"""Markdown tables of measured values, metrics and checks."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from typing import Any

from . import text
from .checks import Check
from .comparison import Comparison
from .experiment import Experiment
from .metrics import CaseMetrics
from .text import decimal, format_value

MEASURES = False

Rows = Iterable[Mapping[str, Any]]  # What a table is made of


def markdown(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows of equal keys as a Markdown table: numbers right-aligned, floats shortened.

    Raises:
        ValueError: no rows are given, or their keys differ.
    """
    if not rows or any(list(row) != list(rows[0]) for row in rows):
        raise ValueError(
            f"Rows {rows!r} form no table. Give at least one row, with equal keys in equal order."
        )
    head = list(rows[0])
    numeric = [isinstance(rows[0][key], int | float) for key in head]
    lines = [head, ["---:" if right else ":---" for right in numeric]]
    lines += [[_cell(row[key]) for key in head] for row in rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:z.4f}".rstrip("0").rstrip(".").replace("-", "−")
    return str(value)


def as_table(rows: Callable[..., Rows]) -> Callable[..., str]:
    """Make a function that returns a Markdown table of one that yields its rows."""

    @wraps(rows)
    def table(run: Experiment, *arguments: Any) -> str:
        return markdown([*rows(run, *arguments)])

    return table


def number_table(
    first: str, heads: Mapping[str, int], rows: Mapping[str, Iterable[Any]]
) -> str:
    """Return a table of numbers beside a column of words, which all differ.

    Args:
        first: the head of the words.
        heads: by head of another column, the digits of its numbers after the point.
        rows: by word, a number for each of these columns, or a text that stays as it
            is.
    """
    return markdown(
        [
            {first: word}
            | {
                head: cell if isinstance(cell, str) else decimal(cell, digits)
                for (head, digits), cell in zip(heads.items(), cells, strict=True)
            }
            for word, cells in rows.items()
        ]
    )


def timed_table(
    first: str, heads: Mapping[str, int], rows: Mapping[str, Iterable[Any]]
) -> str:
    """Return a `number_table` of times, which nothing recomputes, and say so below it."""
    return (
        number_table(first, heads, rows) + "\nReported by this run, not recomputed.\n"
    )


def six_digits(metrics: Mapping[str, CaseMetrics]) -> str:
    """Return metrics as rows and cases as columns, each value with six digits and its unit."""
    return metric_table(
        metrics, lambda *value: text.six_digits(*value).replace("-", "−")
    )


def metric_table(
    metrics: Mapping[str, CaseMetrics],
    write: Callable[[float | None, str], str] = format_value,
) -> str:
    """Return metrics as rows and cases as columns, each value with its unit.

    Args:
        metrics: by case; all cases have the same metrics.
        write: returns the text of a value and its unit.
    """
    labels = next(iter(metrics.values())).about("label")
    found = {
        case: {n: write(v, unit) for n, v, unit in m.items()}
        for case, m in metrics.items()
    }
    return markdown(
        [
            {"metric": label} | {case: values[name] for case, values in found.items()}
            for name, label in labels.items()
        ]
    )


@as_table
def checks_of_run(run: Experiment) -> Rows:
    """Return the table of the named checks: name, outcome and detail."""
    for check in run.outcomes():
        outcome = "passed" if check.passed else "**FAILED**"
        yield {"check": f"`{check.name}`", "outcome": outcome, "what": check.detail}


def comparison_sentence(names: tuple[str, str], comparison: Comparison) -> str:
    """Return a sentence that compares one metric of two cases."""
    label, unit = comparison.label, comparison.unit
    first, second = (
        format_value(v, unit) for v in (comparison.first, comparison.second)
    )
    values = f"{names[0]} {first}, {names[1]} {second}"
    if comparison.order is None:
        return f"The {label} was not observed in either case, so this window cannot rank them."
    if None in (comparison.first, comparison.second):
        seen, unseen = names if comparison.second is None else names[::-1]
        return (
            f"The {label} was observed for {seen} alone ({values}); within this window "
            f"{unseen} is the slower one, by how much is unknown."
        )
    if comparison.order == "equal" and comparison.margin and first != second:
        margin = f"{comparison.margin:g} {'samples' if unit == '1' else unit}"
        return f"The {label} is too close to call: {values}, within the margin of {margin}."
    verb = {
        "lower": "goes down",
        "higher": "goes up",
        "equal": "does not change measurably",
    }
    return f"The {label} {verb[comparison.order]} ({values})."


def sentence_of(
    check: Check, sentence: str, values: Mapping[str, Any], advice: str
) -> str:
    """Return the sentence on a check that passed, else why it failed, with advice."""
    if check.passed:
        return sentence.format(**values)
    return f"The check `{check.name}` failed: {check.detail}. {advice}"
