"""The step explorer: the grid as compact JSON, as a table, and as markup for a script."""

import json
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.checks import evaluate
from robo_genesis.core.quantities import format_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04.claims_text import CLAIMS
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.spec import ENTRY, STEPPED_JOINT
from robo_genesis.lessons.l04.study_checks import GRID_CHECKS
from robo_genesis.lessons.l04.study_spec import CASE_POINTS, KP, KV, POINTS, STEP_SIZES, GridPoint

RESOLUTION = {"q": 1e-4, "force": 1e-2}
"""Value of one unit of the packed integers [rad, N·m]. Metrics come from the full arrays."""

AXES: tuple[tuple[str, str, Sequence[float], str], ...] = (
    ("step", "Step", STEP_SIZES, "rad"),
    ("kp", "KP", KP, "N·m/rad"),
    ("kv", "KV", KV, "N·m·s/rad"),
)
"""Name, label, values and unit of each axis, in the order of the grid's points."""

LABELS = StepMetrics.about("label")
SHOWN = tuple(name for name in LABELS if name != "initial_error")
"""The metrics shown for a run. The initial error is left out: it equals the step."""

NAMES = {point: name for name, point in CASE_POINTS.items()}


def overshoot_share(point: GridPoint, measured: StepMetrics) -> float:
    """Return the overshoot as a share of the step."""
    return measured.overshoot / point.step


def sentence(point: GridPoint, measured: StepMetrics, samples: int) -> str:
    """Describe a point, its overshoot, and whether it saturated."""
    name = f" (the case {NAMES[point]})" if point in NAMES else ""
    overshoot = f"{100 * overshoot_share(point, measured):.1f} % of the step"
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
        "start": start,
        "limit": float(first.effort_limit[ENTRY]),
        "resolution": RESOLUTION,
        "axes": [{"name": n, "values": list(v), "unit": u} for n, _, v, u in AXES],
        "labels": [LABELS[name] for name in SHOWN],
        "points": [_packed(run, point, start) for point in POINTS],
    }


def _packed(run: Experiment, point: GridPoint, start: float) -> dict[str, Any]:
    """Return one run of the grid as JSON values; `start` [rad] is subtracted from positions."""
    trace, measured = run.traces[point.name], run.metrics[point.name]
    return {
        "case": NAMES.get(point, ""),
        "q": _integers(trace.q[:, ENTRY].astype(float) - start, RESOLUTION["q"]),
        "force": _integers(trace.control_force[:, ENTRY].astype(float), RESOLUTION["force"]),
        "sentence": sentence(point, measured, trace.steps),
        "metrics": [v for n, v in _written(measured).items() if n in SHOWN],
    }


def _integers(values: FloatArray, unit: float) -> list[int]:
    return [int(value) for value in np.rint(values / unit)]


def _written(measured: StepMetrics) -> dict[str, str]:
    return {name: format_value(value, unit) for name, value, unit in measured.items()}


def cell_labels(numbers: Sequence[str]) -> list[str]:
    """Return the text of each point's cell in a map: the case's name, if any, above its number."""
    return [
        f"{NAMES[point]}\n{number}" if point in NAMES else number
        for point, number in zip(POINTS, numbers, strict=True)
    ]


def checks(run: Experiment) -> str:
    """Return the table of the checks of the grid."""
    return tables.check_table(evaluate(GRID_CHECKS, run, CLAIMS))


def table(run: Experiment) -> str:
    """Return all runs of the grid with the metrics of the maps and the explorer."""
    return tables.markdown(rows(run))


def rows(run: Experiment) -> list[dict[str, str]]:
    """Return one row a point for a table, with the metrics of the maps and the explorer."""
    found = []
    for point in POINTS:
        measured = run.metrics[point.name]
        written = _written(measured)
        found.append(
            {
                "step [rad]": f"{point.step:g}",
                "KP": f"{point.kp:g}",
                "KV": f"{point.kv:g}",
                "case": NAMES.get(point, ""),
                "overshoot, share": f"{100 * overshoot_share(point, measured):.1f} %",
            }
            | {LABELS[name]: written[name] for name in SHOWN if name != "saturation_duration"}
        )
    return found


def markup(run: Experiment) -> str:
    """Return the explorer as HTML. A notice replaces it until `_static/explorer.js` runs.

    The data are an attribute, because a script in Markdown is shown as text.
    It opens at the first of the lesson's cases that overshoots, if there is one.
    """
    text = json.dumps(pack(run), separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    first = next((p for p in NAMES if run.metrics[p.name].overshoot > 0), POINTS[-1])
    inputs = "".join(
        f'<p><label for="explorer-{name}">{label} <span class="value"></span></label>'
        f'<input type="range" id="explorer-{name}" min="0" max="{len(values) - 1}" step="1" '
        f'value="{list(values).index(getattr(first, name))}"></p>'
        for name, label, values, _ in AXES
    )
    return (
        f'<div class="explorer" data-grid="{escape(text)}" hidden><fieldset>'
        f"<legend>Pick a run of {STEPPED_JOINT}</legend>{inputs}</fieldset>"
        f'<output for="{" ".join(f"explorer-{a[0]}" for a in AXES)}" '
        'aria-live="polite"></output>'
        f'<div class="plots" data-curves="{" ".join(RESOLUTION)}"></div><dl></dl></div>'
        "<p>The explorer needs JavaScript. The table of all runs on the page about the grid shows "
        "the same.</p>"
    )
