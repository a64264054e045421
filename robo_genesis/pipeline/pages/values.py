"""Measured values of a bundle by name, and the numbers in a page that are such values.

A cell with the option `prints: {2: baseline.drop mm}` says that the second decimal
number in its text is this value, in the words of the role `{measured}`.
"""

import re
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

from nbformat import NotebookNode

from robo_genesis.core.text import DIGITS, MICRO, SCALED, SCALES, quoted
from robo_genesis.evidence import bundle

from .book import code_cells

OPTION = "prints"  # The option of a cell that names the measured values which it prints

DECIMAL = re.compile(r"(?<![\w.])[-+−]?\d+\.\d+(?:e[-+]?\d+)?(?!\.?\d)")
LOG = re.compile(r"^\[Genesis\].*", re.MULTILINE)

# Relative difference of a printed value from the recorded one: a float32 has seven
# digits.
ROUNDED = 1e-7


def value_of(folder: Path, name: str, unit: str = "") -> tuple[Any, str | None, str]:
    """Return a measured value of a bundle, its unit, None for a finding, and words on its origin.

    Args:
        folder: of the bundle.
        name: `group.metric` of its metrics, or `check:label` of what a check found.
        unit: in which it will be shown, such as mm or %; without one, its own.

    Raises:
        LookupError: the bundle lacks the value, or the value cannot have the unit; the
            message lists what is valid.
        BundleRefused: the bundle cannot be read.
    """
    found: Mapping[str, Mapping[str, Any]] = bundle.read_metrics(folder)
    kind, by = "metric", "."
    if ":" in name:
        checks = bundle.read_manifest(folder).checks
        kind, by, found = "finding", ":", {check.name: check.found for check in checks}
    group, _, label = name.partition(by)
    if label not in found.get(group, {}):
        known = ", ".join(f"{g}{by}{n}" for g, of in found.items() for n in of)
        raise LookupError(f"no {kind} {name!r}. Known: {known}.")
    value = record = found[group][label]
    given, origin = None, f"found by the check {group}"
    own = unit_of_label(label)
    if isinstance(record, bundle.Metric):
        value, own, origin = (
            record.value,
            record.unit,
            f"from {', '.join(record.source)}",
        )
        given = own
    valid = {own, SCALED.get(own, own), MICRO.get(own, own)} - {""}
    if unit and not (isinstance(value, int | float) and unit in valid):
        raise LookupError(
            f"{name} = {quoted(value)} in {own or 'no unit'}, which cannot be shown in {unit!r}. "
            f"Valid is {' or '.join(sorted(valid)) or 'no unit'}."
        )
    return value, given, origin


def unit_of_label(label: str) -> str:
    """Return the unit in which a finding's label ends, as in `lost_m_s`, or an empty text."""
    units = {re.sub("[/·]", "_", unit): unit for unit in DIGITS}
    units |= {"px": "pixel", "share": "1"}
    ends = [end for end in units if label.endswith(f"_{end}")]
    return units[max(ends, key=len)] if ends else ""


def prints(page: NotebookNode) -> list[dict[int, str]]:
    """Return the option `prints` of each code cell of a page, an empty one if it has none."""
    return [cell.metadata.get(OPTION, {}) for cell in code_cells(page)]


def contradiction(
    values: Mapping[int, str], cell: NotebookNode, folder: Path
) -> str | None:
    """Return which number that a cell printed is not the value that its option names, or None.

    Args:
        values: the option, value by the place of the number, counted from 1.
        cell: with its outputs.
        folder: the bundle of its page.
    """
    text = "".join(out.text for out in cell.outputs if out.output_type == "stream")
    numbers = dict(enumerate(DECIMAL.findall(LOG.sub("", text)), start=1))
    if not isinstance(values, dict) or not values.keys() <= numbers.keys():
        return (
            f"it has `{OPTION}: {values}`, and prints the numbers {', '.join(numbers.values())}. "
            f"Valid is `{OPTION}: {{1: baseline.drop mm}}` for the first number"
        )
    for place, asked in values.items():
        name, _, unit = str(asked).partition(" ")
        try:
            value = value_of(folder, name, unit)[0] * SCALES.get(unit, 1.0)
        except (LookupError, TypeError) as error:
            return f"its option `{OPTION}` has {asked!r}: {error}"
        number = Decimal(numbers[place].replace("−", "-"))
        step = 10.0 ** int(number.as_tuple().exponent)
        if abs(float(number) - value) > step / 2 + ROUNDED * abs(value):
            return f"it prints {numbers[place]} as {asked}, which is {value:.9g}"
    return None
