"""Tables of the lab: functions of the experiment, and rows."""

from collections.abc import Mapping, Sequence

from robo_genesis.core import tables
from robo_genesis.core.quantities import NOT_OBSERVED, format_value
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import checks
from robo_genesis.sim.contacts import ContactCase

SHORT = {"m": ("mm", 0.1), "J": ("mJ", 1.0)}
"""By unit, a unit a thousand times smaller for values below a limit."""


def landings(run: Experiment) -> str:
    """Return the metrics of the dropped cubes."""
    return tables.metric_table(checks.landings(run), readable)


def slides(run: Experiment) -> str:
    """Return the metrics of the pushed cubes."""
    return tables.metric_table(checks.slides(run), readable)


def bounces(run: Experiment) -> str:
    """Return the metrics of the balls."""
    return tables.metric_table(checks.bounces(run), readable)


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
            "case": f"`{name}`",
            "dt [ms]": f"{1000 * case.dt:g}",
            "substeps": str(case.substeps),
            "h [ms]": f"{1000 * case.h:g}",
            "states": str(case.steps + 1),
            "solver steps": str(case.steps * case.substeps),
        }
        for name, case in cases.items()
    ]
