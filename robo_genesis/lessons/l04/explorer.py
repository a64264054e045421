"""The step explorer: the grid as compact data for a script, and as a table.

The script asks what a chosen run will show before it shows the run beside the last one.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.tables import as_table
from robo_genesis.core.text import decimal, format_value
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import ENTRY, MARGINS, RESOLUTION, STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import CASE_POINTS, KP, KV, POINTS, STEP_SIZES, GridPoint
from robo_genesis.lessons.l04.tables import margin_text, share_text

MEASURES = False

PACKED = {"q": 1e-4, "force": 1e-2}
"""Value of one unit of the packed integers [rad, N·m]. Metrics come from the full arrays."""

UNTIL = 0.6
"""End of the time axis of the curves [s]; after it, no run of the grid moves visibly."""

LABELS = StepMetrics.about("label")
SHOWN = tuple(name for name in LABELS if name != "initial_error")
"""The metrics shown for a run. The initial error is left out: it equals the step."""

REPEATED = "saturation_duration"
"""Not in the table, because it is the number of saturated samples times the time step."""

CELLS = {
    "saturation_samples": (1, 0, "samples"),
    "rise_time": (1000, 0, "ms"),
    "overshoot": (1000, 1, "mrad"),
    "peak_speed": (1, 2, "rad/s"),
}
"""Factor, digits and unit of the number in a cell of the map, by metric. These metrics have a
declared margin, so a reader can be asked for the order of two runs."""

NAMES = {point: name for name, point in CASE_POINTS.items()}


def sentence(point: GridPoint, measured: StepMetrics, samples: int) -> str:
    """Describe a point, its overshoot, and whether it saturated."""
    name = f" (the case {NAMES[point]})" if point in NAMES else ""
    overshoot = f"{share_text(measured.overshoot / point.step)} of the step"
    count = measured.saturation_samples
    force = f"Saturated: {count} of {samples} samples" if count else "Not saturated: no sample"
    return (
        f"KP {point.kp:g}, KV {point.kv:g}, step {point.step:g} rad{name}. "
        f"Overshoot: {overshoot if measured.overshoot > 0 else 'none'}. {force} at the force limit."
    )


def explored(run: Experiment) -> dict[str, Any]:
    """Return the grid for the explorer: a map for each step, with curves packed as integers."""
    first = run.traces[POINTS[0].name]
    start, limit = float(first.q[0, ENTRY]), float(first.effort_limit[ENTRY])
    return {
        "choices": (f"Step of {STEPPED_JOINT}", "Map shows"),
        "maps": [_map(run, step, start, limit) for step in STEP_SIZES],
        "measures": [_measure(name) for name in CELLS],
        "columns": [LABELS[name] for name in SHOWN],
        "notes": {"–": "A dash: not observed."},
        "curves": {
            "of": STEPPED_JOINT,
            "dt": first.dt,
            "until": UNTIL,
            "drawn": [
                {"key": "q", "name": "Position", "title": "Position [rad], target dotted",
                 "unit": PACKED["q"], "zero": start, "first": 0},
                {"key": "force", "name": "Control force", "unit": PACKED["force"], "zero": 0,
                 "title": "Control force [N·m], limits dashed", "first": 1},
            ],
        },
        "without_script": "The explorer needs JavaScript. The table of all runs on the page about "
        "the grid shows the same.",
    }  # fmt: skip


def _map(run: Experiment, step: float, start: float, limit: float) -> dict[str, Any]:
    """Return the runs of one step: KP upwards, KV to the right, and the axes of their curves."""
    points = [point for point in POINTS if point.step == step]
    cells = [_cell(run, point, start) for point in points]
    size = len(KV)
    target, room = start + step, 0.08 * step
    highest = max(start + PACKED["q"] * max(max(cell["q"]) for cell in cells), target)
    return {
        "label": f"{step:g} rad",
        "setting": f"step {step:g} rad",
        "caption": "Map of the runs: KP upwards, KV to the right.",
        "columns": [f"{kv:g}" for kv in KV],
        "rows": [
            {"label": f"{kp:g}", "cells": cells[k * size : (k + 1) * size]}
            for k, kp in reversed([*enumerate(KP)])
        ],
        "axes": {
            "q": _axis((start, start + step / 2, target), (start - room, highest + room), 3,
                       {target: "target"}),
            "force": _axis((-limit, 0.0, limit), (-1.15 * limit, 1.15 * limit), 0,
                           {-limit: "limit", limit: "limit"}),
        },
    }  # fmt: skip


def _axis(
    ticks: Sequence[float], ends: Sequence[float], digits: int, levels: Mapping[float, str]
) -> dict[str, Any]:
    """Return the value axis of a curve; `levels` are marks of the palette by their value."""
    return {
        "low": ends[0],
        "high": ends[1],
        "ticks": [{"value": tick, "label": decimal(tick, digits)} for tick in ticks],
        "levels": [{"value": value, "mark": mark} for value, mark in levels.items()],
    }


def _measure(name: str) -> dict[str, Any]:
    """Return a metric that cells show and questions are about."""
    unit, noun = (StepMetrics.about(what)[name] for what in ("unit", "noun"))
    words = ("earlier", "later") if unit == "s" else ("lower", "higher")
    return {
        "label": f"{LABELS[name]} [{CELLS[name][2]}]",
        "column": SHOWN.index(name),
        "noun": noun,
        "lower": words[0],
        "higher": words[1],
        "margin": max(MARGINS[name], RESOLUTION[unit]),
        "within": margin_text(name),
    }


def _cell(run: Experiment, point: GridPoint, start: float) -> dict[str, Any]:
    """Return one run of the grid as JSON values; `start` [rad] is subtracted from positions."""
    trace, measured = run.traces[point.name], run.metrics[point.name]
    drawn = round(UNTIL / trace.dt)
    numbers = {name: getattr(measured, name) for name in CELLS}
    return {
        "name": f"KP {point.kp:g}, KV {point.kv:g}",
        "tag": NAMES.get(point, ""),
        "opens": point == CASE_POINTS["G2"],
        "sentence": sentence(point, measured, trace.steps),
        "values": [v for n, v in _written(measured).items() if n in SHOWN],
        "numbers": list(numbers.values()),
        "texts": [
            "–" if value is None else decimal(value * CELLS[name][0], CELLS[name][1])
            for name, value in numbers.items()
        ],
        "q": _integers(trace.q[: drawn + 1, ENTRY].astype(float) - start, PACKED["q"]),
        "force": _integers(trace.control_force[:drawn, ENTRY].astype(float), PACKED["force"]),
    }


def _integers(values: FloatArray, unit: float) -> list[int]:
    return [int(value) for value in np.rint(values / unit)]


def _written(measured: StepMetrics) -> dict[str, str]:
    return {name: format_value(value, unit) for name, value, unit in measured.items()}


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
        } | {LABELS[name]: _written(measured)[name] for name in SHOWN if name != REPEATED}
