"""The data of the step explorer are the runs of the grid, without an engine."""

import gzip
import json

import numpy as np

from robo_genesis.lessons.l04 import explorer, spec, study_spec

POINTS = study_spec.POINTS
G2 = study_spec.CASE_POINTS["G2"]
# Most bytes that the explorer's data may take, compressed as a server sends them
SHIPPED = 60_000


def cells_of(data):
    """Return the cells in the order of the points: rows are upside down in their maps."""
    rows = (row for one in data["maps"] for row in reversed(one["rows"]))
    return [cell for row in rows for cell in row["cells"]]


def test_the_packed_runs_are_the_measured_ones(experiments):
    data = json.loads(json.dumps(explorer.explored(experiments["batch"])))
    assert len(gzip.compress(json.dumps(data).encode(), mtime=0)) < SHIPPED
    curves = {curve["key"]: curve for curve in data["curves"]["drawn"]}
    drawn = round(data["curves"]["until"] / data["curves"]["dt"])
    for point, cell in zip(POINTS, cells_of(data), strict=True):
        run = experiments["batch"].traces[point.name]
        q, force = (
            np.array(cell[n]) * of["unit"] + of["zero"] for n, of in curves.items()
        )
        assert (
            np.abs(q - run.q[: drawn + 1, spec.ENTRY]).max()
            < 0.51 * explorer.PACKED["q"]
        )
        off = np.abs(force - run.control_force[:drawn, spec.ENTRY]).max()
        assert off < 0.51 * explorer.PACKED["force"]
        assert np.ptp(run.q[drawn:, spec.ENTRY]) < 5e-4  # rad, no later motion


def test_the_cell_of_a_case_says_what_was_measured(experiments):
    run, number = experiments["batch"], POINTS.index(G2)
    data, measured = explorer.explored(run), run.metrics[G2.name]
    cell = cells_of(data)[number]
    assert cell["numbers"] == [getattr(measured, name) for name in explorer.CELLS]
    share = f"{100 * measured.overshoot / 0.25:.1f} %"
    assert cell["sentence"] == (
        f"KP 7000, KV 100, step 0.25 rad (the case G2). Overshoot: {share} of the step. "
        f"Saturated: {measured.saturation_samples} of 120 samples at the force limit."
    )
    rows = explorer.table(run).splitlines()[2:]
    assert [k for k, row in enumerate(rows) if "| G2 |" in row] == [number]
