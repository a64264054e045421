"""The step explorer: the grid as compact data for a script, and as a table.

The script shows a chosen run beside the last one.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from robo_genesis.core import maps
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.tables import as_table
from robo_genesis.core.text import decimal, format_value

from .metrics import StepMetrics
from .spec import ENTRY, STEPPED_JOINT
from .study_spec import CASE_POINTS, KP, KV, POINTS, STEP_SIZES, GridPoint
from .tables import share_text

MEASURES = False

# Value of one unit of the packed integers [rad, N·m]. Metrics come from the full
# arrays.
PACKED = {"q": 1e-4, "force": 1e-2}

# End of the time axis of the curves [s]; after it, no run of the grid moves visibly
UNTIL = 0.6

# The metrics shown for a run. The initial error is left out: it equals the step.
LABELS = {
    n: label for n, label in StepMetrics.about("label").items() if n != "initial_error"
}

# Not in the table, because it is the number of saturated samples times the time step.
REPEATED = "saturation_duration"

# Factor, digits and unit of the number in a cell of the map, by metric
CELLS = {
    "saturation_samples": (1, 0, "samples"),
    "rise_time": (1000, 0, "ms"),
    "overshoot": (1000, 1, "mrad"),
    "peak_speed": (1, 2, "rad/s"),
}

NAMES = {point: name for name, point in CASE_POINTS.items()}


def written(measured: StepMetrics) -> dict[str, str]:
    """Return the metrics shown for a run as texts."""
    return {
        n: format_value(value, unit)
        for n, value, unit in measured.items()
        if n in LABELS
    }


def sentence(point: GridPoint, measured: StepMetrics, samples: int) -> str:
    """Describe a point, its overshoot, and whether it saturated."""
    name = f" (the case {NAMES[point]})" if point in NAMES else ""
    overshoot, force = "none", "Not saturated: no sample"
    if measured.overshoot:
        overshoot = f"{share_text(measured.overshoot / point.step)} of the step"
    if count := measured.saturation_samples:
        force = f"Saturated: {count} of {samples} samples"
    return (
        f"KP {point.kp:g}, KV {point.kv:g}, step {point.step:g} rad{name}. "
        f"Overshoot: {overshoot}. {force} at the force limit."
    )


def explored(run: Experiment) -> dict[str, Any]:
    """Return the grid for the explorer: a map for each step, with curves packed as integers."""
    first = run.traces[POINTS[0].name]
    start, limit = float(first.q[0, ENTRY]), float(first.effort_limit[ENTRY])
    return {
        "choices": (f"Step of {STEPPED_JOINT}", "Map shows"),
        "maps": [_map(run, step, start, limit) for step in STEP_SIZES],
        "measures": [
            {"label": f"{LABELS[name]} [{unit}]"} for name, (*_, unit) in CELLS.items()
        ],
        "columns": [*LABELS.values()],
        "notes": {"–": "A dash: not observed."},
        "curves": {
            "of": STEPPED_JOINT,
            "dt": first.dt,
            "until": UNTIL,
            "drawn": [
                {
                    "key": "q",
                    "name": "Position",
                    "title": "Position [rad], target dotted",
                    "unit": PACKED["q"],
                    "zero": start,
                    "first": 0,
                },
                {
                    "key": "force",
                    "name": "Control force",
                    "unit": PACKED["force"],
                    "zero": 0,
                    "title": "Control force [N·m], limits dashed",
                    "first": 1,
                },
            ],
        },
        "without_script": "The explorer needs JavaScript. The table of all runs on the page about "
        "the grid shows the same.",
    }


def _map(run: Experiment, step: float, start: float, limit: float) -> dict[str, Any]:
    """Return the runs of one step: KP upwards, KV to the right, and the axes of their curves."""
    cells = [_cell(run, point) for point in POINTS if point.step == step]
    target, room, end = start + step, 0.08 * step, 1.15 * limit
    highest = max(start + PACKED["q"] * max(max(cell["q"]) for cell in cells), target)
    ends = (start - room, highest + room)
    axes = {
        "q": _axis(*ends, (start, start + step / 2, target), 3, "target", target),
        "force": _axis(-end, end, (-limit, 0.0, limit), 0, "limit", -limit, limit),
    }
    return maps.grid(
        "Map of the runs: KP upwards, KV to the right.",
        [f"{kv:g}" for kv in KV],
        [f"{kp:g}" for kp in KP],
        cells,
        label=f"{step:g} rad",
        setting=f"step {step:g} rad",
        axes=axes,
    )


def _axis(
    low: float, high: float, ticks: Sequence[float], digits: int, mark: str, *at: float
) -> dict[str, Any]:
    """Return the value axis of a curve: its ends, ticks, and levels with a mark."""
    return {
        "low": low,
        "high": high,
        "ticks": [{"value": value, "label": decimal(value, digits)} for value in ticks],
        "levels": [{"value": value, "mark": mark} for value in at],
    }


def _cell(run: Experiment, point: GridPoint) -> dict[str, Any]:
    """Return one run of the grid as JSON values; positions are from the start."""
    trace, measured = run.traces[point.name], run.metrics[point.name]
    drawn, q = round(UNTIL / trace.dt), trace.q[:, ENTRY].astype(float)
    numbers = [getattr(measured, name) for name in CELLS]
    return {
        "name": f"KP {point.kp:g}, KV {point.kv:g}",
        "tag": NAMES.get(point, ""),
        "opens": point == CASE_POINTS["G2"],
        "sentence": sentence(point, measured, trace.steps),
        "values": [*written(measured).values()],
        "numbers": numbers,
        "texts": [
            "–" if value is None else decimal(value * factor, digits)
            for value, (factor, digits, _) in zip(numbers, CELLS.values(), strict=True)
        ],
        "q": _integers(q[: drawn + 1] - q[0], "q"),
        "force": _integers(trace.control_force[:drawn, ENTRY].astype(float), "force"),
    }


def _integers(values: FloatArray, name: str) -> Any:
    return np.rint(values / PACKED[name]).astype(int).tolist()


@as_table
def table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return all runs of the grid, one row a point, with the metrics of the explorer."""
    for point in POINTS:
        measured = run.metrics[point.name]
        yield {
            "step [rad]": f"{point.step:g}",
            "KP": f"{point.kp:g}",
            "KV": f"{point.kv:g}",
            "case": NAMES.get(point, ""),
            "overshoot, share": share_text(measured.overshoot / point.step),
        } | {LABELS[n]: text for n, text in written(measured).items() if n != REPEATED}
