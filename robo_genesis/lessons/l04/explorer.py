"""The step explorer: the grid as compact JSON, as a table, and as markup for a script.

The script asks what a chosen run will show before it shows the run beside the last one.
"""

import json
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.quantities import format_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import ENTRY, MARGINS, RESOLUTION, STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import CASE_POINTS, KP, KV, POINTS, STEP_SIZES, GridPoint
from robo_genesis.lessons.l04.tables import margin_text, share_text

MEASURES = False

PACKED = {"q": 1e-4, "force": 1e-2}
"""Value of one unit of the packed integers [rad, N·m]. Metrics come from the full arrays."""

AXES: tuple[tuple[str, Sequence[float], str], ...] = (
    ("step", STEP_SIZES, "rad"),
    ("kp", KP, "N·m/rad"),
    ("kv", KV, "N·m·s/rad"),
)
"""Name, values and unit of each axis, in the order of the grid's points."""

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


def pack(run: Experiment) -> dict[str, Any]:
    """Return the grid as JSON values: traces as integers, metrics as text."""
    first = run.traces[POINTS[0].name]
    start = float(first.q[0, ENTRY])
    return {
        "dt": first.dt,
        "until": UNTIL,
        "start": start,
        "limit": float(first.effort_limit[ENTRY]),
        "resolution": PACKED,
        "axes": [{"name": n, "values": list(v), "unit": u} for n, v, u in AXES],
        "opens": POINTS.index(CASE_POINTS["G2"]),
        "labels": [LABELS[name] for name in SHOWN],
        "measures": [_measure(run, name) for name in CELLS],
        "points": [_packed(run, point, start) for point in POINTS],
    }


def _measure(run: Experiment, name: str) -> dict[str, Any]:
    """Return a metric of the map and of the questions, with its value in each run."""
    factor, digits, shown = CELLS[name]
    unit, noun = (StepMetrics.about(what)[name] for what in ("unit", "noun"))
    words = ("earlier", "later") if unit == "s" else ("lower", "higher")
    return {
        "label": SHOWN.index(name),
        "noun": noun,
        "lower": words[0],
        "higher": words[1],
        "margin": max(MARGINS[name], RESOLUTION[unit]),
        "within": margin_text(name),
        "values": [getattr(run.metrics[point.name], name) for point in POINTS],
        "cell": {"factor": factor, "digits": digits, "unit": shown},
    }


def _packed(run: Experiment, point: GridPoint, start: float) -> dict[str, Any]:
    """Return one run of the grid as JSON values; `start` [rad] is subtracted from positions."""
    trace, measured = run.traces[point.name], run.metrics[point.name]
    drawn = round(UNTIL / trace.dt)
    return {
        "case": NAMES.get(point, ""),
        "q": _integers(trace.q[: drawn + 1, ENTRY].astype(float) - start, PACKED["q"]),
        "force": _integers(trace.control_force[:drawn, ENTRY].astype(float), PACKED["force"]),
        "sentence": sentence(point, measured, trace.steps),
        "metrics": [v for n, v in _written(measured).items() if n in SHOWN],
    }


def _integers(values: FloatArray, unit: float) -> list[int]:
    return [int(value) for value in np.rint(values / unit)]


def _written(measured: StepMetrics) -> dict[str, str]:
    return {name: format_value(value, unit) for name, value, unit in measured.items()}


def table(run: Experiment) -> str:
    """Return all runs of the grid, one row a point, with the metrics of the explorer."""
    rows = []
    for point in POINTS:
        measured = run.metrics[point.name]
        gains = {"step [rad]": point.step, "KP": point.kp, "KV": point.kv}
        rows.append(
            {head: f"{value:g}" for head, value in gains.items()}
            | {
                "case": NAMES.get(point, ""),
                "overshoot, share": share_text(measured.overshoot / point.step),
            }
            | {LABELS[name]: _written(measured)[name] for name in SHOWN if name != REPEATED}
        )
    return tables.markdown(rows)


def markup(run: Experiment) -> str:
    """Return the explorer as HTML. A notice replaces it until `_static/explorer.js` runs.

    The data are an attribute, because a script in Markdown is shown as text.
    """
    packed = pack(run)
    text = json.dumps(packed, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    steps = _options(f"{step:g} rad" for step in STEP_SIZES)
    shown = _options(
        f"{packed['labels'][m['label']]} [{m['cell']['unit']}]" for m in packed["measures"]
    )
    return (
        f'<div class="explorer" data-grid="{escape(text)}" hidden><div class="controls">'
        f'<label>Step of {STEPPED_JOINT} <select name="step">{steps}</select></label>'
        f'<label>Map shows <select name="measure">{shown}</select></label>'
        '<label><input type="checkbox" name="predict" checked> Predict first</label></div>'
        '<div class="map-of-runs"></div>'
        '<fieldset class="question" hidden><legend></legend></fieldset>'
        '<output aria-live="polite"></output>'
        f'<div class="plots" data-curves="{" ".join(PACKED)}"></div><dl></dl></div>'
        "<p>The explorer needs JavaScript. The table of all runs on the page about the grid shows "
        "the same.</p>"
    )


def _options(texts: Iterable[str]) -> str:
    """Return the options of a `select`, numbered from 0."""
    return "".join(f'<option value="{k}">{escape(text)}</option>' for k, text in enumerate(texts))
