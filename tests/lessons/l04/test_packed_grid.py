"""The data of the step explorer are the runs of the grid, without an engine."""

import gzip
import json
from itertools import product

import numpy as np
from bs4 import BeautifulSoup

from robo_genesis.core.text import format_value
from robo_genesis.lessons.l04 import explorer, spec, study_spec

POINTS = study_spec.POINTS
G2 = study_spec.CASE_POINTS["G2"]
SHIPPED = 60_000
"""Most bytes that the explorer's markup may take, compressed as a server sends it."""


def test_the_packed_runs_are_the_measured_ones(study_runs):
    markup = explorer.markup(study_runs)
    assert len(gzip.compress(markup.encode(), mtime=0)) < SHIPPED
    assert "\n" not in markup  # one block of HTML in Markdown
    text = BeautifulSoup(markup, "html.parser").select_one(".explorer")["data-grid"]
    data = json.loads(text)
    points = product(*(axis["values"] for axis in data["axes"]))  # the last axis fastest
    assert [*points] == [(point.step, point.kp, point.kv) for point in POINTS]
    drawn = round(data["until"] / data["dt"])
    for point, packed in zip(POINTS, data["points"], strict=True):
        run = study_runs.traces[point.name]
        q, force = (np.array(packed[n]) * data["resolution"][n] for n in ("q", "force"))
        q += data["start"]
        assert np.abs(q - run.q[: drawn + 1, spec.ENTRY]).max() < 0.51 * explorer.PACKED["q"]
        off = np.abs(force - run.control_force[:drawn, spec.ENTRY]).max()
        assert off < 0.51 * explorer.PACKED["force"]
        assert np.ptp(run.q[drawn:, spec.ENTRY]) < 5e-4  # rad, no motion after the drawn part


def test_metrics_measures_and_sentence_of_a_point(study_runs):
    data, number = explorer.pack(study_runs), POINTS.index(G2)
    measured, packed = study_runs.metrics[G2.name], data["points"][number]
    overshoot = packed["metrics"][data["labels"].index("overshoot")]
    assert overshoot == format_value(measured.overshoot, "rad")
    share = f"{100 * measured.overshoot / 0.25:.1f} %"
    assert packed["sentence"] == (
        f"KP 7000, KV 100, step 0.25 rad (the case G2). Overshoot: {share} of the step. "
        f"Saturated: {measured.saturation_samples} of 120 samples at the force limit."
    )
    assert explorer.CELLS.keys() == spec.MARGINS.keys() - {"settling_time"}
    for name, measure in zip(explorer.CELLS, data["measures"], strict=True):
        assert measure["margin"] == spec.MARGINS[name]
        assert measure["values"][number] == getattr(measured, name)
    rows = explorer.table(study_runs).splitlines()[2:]
    assert [k for k, row in enumerate(rows) if "| G2 |" in row] == [number]
