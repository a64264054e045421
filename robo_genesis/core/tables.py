"""Measured values as pages display them: Markdown tables, lists in prose, signed numbers."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from robo_genesis.core import quantities
from robo_genesis.core.checks import Check
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.quantities import format_value


def markdown(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows of equal keys as a Markdown table; numbers to the right, floats shortened.

    Raises:
        ValueError: no rows are given, or their keys differ.
    """
    if not rows or any(list(row) != list(rows[0]) for row in rows):
        raise ValueError("A table takes at least one row, and rows of equal keys in equal order.")
    head = list(rows[0])
    numeric = [isinstance(rows[0][key], int | float) for key in head]
    lines = [head, ["---:" if right else ":---" for right in numeric]]
    lines += [[_cell(row[key]) for key in head] for row in rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def _cell(value: Any) -> str:
    if isinstance(value, float):
        text = f"{value:.4f}".rstrip("0").rstrip(".")
        return "0" if text == "-0" else text.replace("-", "−")
    return str(value)


def metric_table(metrics: Mapping[str, CaseMetrics]) -> str:
    """Return metrics as rows and cases as columns, each value with its unit."""
    return _metric_rows(metrics, format_value)


def six_digits(metrics: Mapping[str, CaseMetrics]) -> str:
    """Return metrics as rows and cases as columns, six digits of each value.

    Args:
        metrics: of cases that have the same ones.
    """
    return _metric_rows(metrics, _six_digits)


def _metric_rows(
    metrics: Mapping[str, CaseMetrics], write: Callable[[float | None, str], str]
) -> str:
    labels = next(iter(metrics.values())).about("label")
    found = {case: {n: write(v, unit) for n, v, unit in m.items()} for case, m in metrics.items()}
    return markdown(
        [
            {"metric": label} | {case: values[name] for case, values in found.items()}
            for name, label in labels.items()
        ]
    )


def _six_digits(value: float | None, unit: str) -> str:
    return quantities.six_digits(value, unit).replace("-", "−")


def check_table(outcomes: Sequence[Check]) -> str:
    """Return one row a check: its name, its outcome and what it found or held."""
    return markdown(
        [
            {
                "check": f"`{check.name}`",
                "outcome": "passed" if check.passed else "**FAILED**",
                "what": check.detail,
            }
            for check in outcomes
        ]
    )
