"""Measured values as pages display them: Markdown tables, lists in prose, signed numbers."""

from collections.abc import Mapping, Sequence
from typing import Any

from robo_genesis.checks import Check
from robo_genesis.measures import LABELS
from robo_genesis.metrics import NOT_OBSERVED, StepMetrics, format_value
from robo_genesis.records import Metrics


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


def listed(words: Sequence[str]) -> str:
    """Return words as a list in prose: `G1, G2 and G3`."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


def signed(value: float, digits: int) -> str:
    """Return a difference with its sign and a number of digits after the point; `0` if it is 0."""
    return f"{value:+.{digits}f}".replace("-", "−") if value else "0"


def metric_table(metrics: Mapping[str, StepMetrics]) -> str:
    """Return metrics as rows and cases as columns, each value with its unit."""
    cases = list(metrics)
    names = [name for name, _, _ in metrics[cases[0]].items()]
    values = {case: {n: format_value(v, u) for n, v, u in m.items()} for case, m in metrics.items()}
    return markdown(
        [{"metric": LABELS[name]} | {case: values[case][name] for case in cases} for name in names]
    )


def six_digits(metrics: Mapping[str, Metrics]) -> str:
    """Return metrics as rows and cases as columns, six digits of each value.

    Args:
        metrics: of cases that have the same ones.
    """
    found = {case: list(of.items()) for case, of in metrics.items()}
    names = [name for name, _, _ in next(iter(found.values()))]
    return markdown(
        [
            {"metric": LABELS[name]} | {case: _digits(*of[row]) for case, of in found.items()}
            for row, name in enumerate(names)
        ]
    )


def _digits(_: str, value: float | None, unit: str) -> str:
    return NOT_OBSERVED if value is None else f"{value:.6g} {unit}".replace("-", "−")


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
