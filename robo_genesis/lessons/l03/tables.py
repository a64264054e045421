"""Tables of the lab: functions of the experiment, and rows."""

import re
from collections.abc import Mapping, Sequence

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.quantities import NOT_OBSERVED, format_value
from robo_genesis.lessons.l03 import checks, spec
from robo_genesis.sim.bodies.contacts import ContactCase

MEASURES = False

SHORT = {"m": ("mm", 0.1), "J": ("mJ", 1.0)}
"""By unit, a unit a thousand times smaller for values below a limit."""

BEFORE_UNIT = re.compile(r"(?<=\d) (?=[A-Za-zµ%/]+$)")
"""The space between a number and its unit at the end of a cell."""


def markdown(rows: Sequence[Mapping[str, str]]) -> str:
    """Return rows as a Markdown table in which no line ends between a number and its unit."""
    kept = [{k: BEFORE_UNIT.sub("\u00a0", text) for k, text in row.items()} for row in rows]
    return tables.markdown(kept)


def by_run(metrics: Mapping[str, CaseMetrics], left_out: str = "") -> str:
    """Return one row per run and one column per metric; one may be left out for room."""
    labels = next(iter(metrics.values())).about("label")
    return markdown(
        [
            {"run": spec.LABELS[run]}
            | {labels[n]: readable(v, unit) for n, v, unit in of.items() if n != left_out}
            for run, of in metrics.items()
        ]
    )


def landings(run: Experiment) -> str:
    """Return the metrics of the dropped cubes."""
    return by_run(checks.landings(run), left_out="touchdown")


def slides(run: Experiment) -> str:
    """Return the metrics of the pushed cubes."""
    return by_run(checks.slides(run), left_out="first_speed")


def bounces(run: Experiment) -> str:
    """Return the metrics of the balls."""
    return by_run(checks.bounces(run))


def readable(value: float | None, unit: str) -> str:
    """Write a value with a unit of its size: `6.43 mm` and `0.4104 m`."""
    small, limit = SHORT.get(unit, ("", 0.0))
    if value is None:
        return NOT_OBSERVED
    if value == 0 and small:
        return f"0 {small}"
    if not small or abs(value) >= limit:
        return format_value(value, unit).replace("-", "−")
    text = f"{1000 * value:.3f}" if abs(value) < 1e-3 else f"{1000 * value:.2f}"
    return f"{text} {small}".replace("-", "−")


def landing_rows(cases: Mapping[str, ContactCase]) -> Sequence[dict[str, str]]:
    """Return one row per case: its steps and the resulting numbers of states and solver steps."""
    return [
        {
            "run": spec.LABELS[name],
            "dt [ms]": f"{1000 * case.dt:g}",
            "substeps": str(case.substeps),
            "h [ms]": f"{1000 * case.h:g}",
            "states": str(case.steps + 1),
            "solver steps": str(case.steps * case.substeps),
        }
        for name, case in cases.items()
    ]
