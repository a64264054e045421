"""The grid's specification, the explorer's data and the checks: without an engine."""

import gzip
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core.checks import evaluate
from robo_genesis.core.experiment import Run
from robo_genesis.core.text import format_value
from robo_genesis.lessons.l04 import (
    explorer,
    spec,
    study_checks,
    study_plots,
    study_spec,
)
from robo_genesis.lessons.l04.study_spec import POINTS, GridPoint
from robo_genesis.sim.arm.franka import JOINT_NAMES

K = JOINT_NAMES.index(spec.STEPPED_JOINT)
G2 = study_spec.CASE_POINTS["G2"]


SHIPPED = 60_000
"""Most bytes that the explorer's data may take, compressed as a server sends them."""


def cells_of(data):
    """Return the cells in the order of the points: rows are upside down in their maps."""
    rows = (row for one in data["maps"] for row in reversed(one["rows"]))
    return [cell for row in rows for cell in row["cells"]]


def failed(run):
    outcomes = evaluate(study_checks.GRID_CHECKS, run)
    return {check.name: check.detail for check in outcomes if not check.passed}


def test_the_grid_holds_the_lesson_s_cases_exactly():
    assert len(set(POINTS)) == len(POINTS) == 100
    for name, point in study_spec.CASE_POINTS.items():
        assert point in POINTS
        case, same = spec.CASES[name], point.case
        assert all((getattr(case, f) == getattr(same, f)).all() for f in ("kp", "kv", "q_target"))
    assert [study_spec.point_of(point.case) for point in POINTS] == list(POINTS)
    assert len(study_spec.GRID_CASES) == 100
    assert "grid_step_250mrad_KP_7000_KV_100" in study_spec.GRID_CASES


def test_packed_data_unpacks_within_half_a_unit(study_runs):
    runs = [study_runs.traces[name] for name in study_spec.GRID_CASES]
    of_q, of_force = (
        np.array([getattr(run, name)[:, K] for run in runs]) for name in ("q", "control_force")
    )
    data = json.loads(json.dumps(explorer.explored(study_runs)))
    q, force = (
        np.array([cell[curve["key"]] for cell in cells_of(data)]) * curve["unit"] + curve["zero"]
        for curve in data["curves"]["drawn"]
    )
    drawn = round(data["curves"]["until"] / data["curves"]["dt"])
    of_q, of_force = of_q[:, : drawn + 1], of_force[:, :drawn]
    # The arrays are float32: their own last bit adds to the half unit.
    assert np.abs(q - of_q).max() <= 0.5 * explorer.PACKED["q"] + 1e-6
    assert np.abs(force - of_force).max() <= 0.5 * explorer.PACKED["force"] + 1e-5
    assert np.ptp(of_q) > 1000 * explorer.PACKED["q"]


def test_packed_metrics_are_those_of_the_full_arrays(study_runs):
    data = explorer.explored(study_runs)
    cells = cells_of(data)
    overshoot = cells[POINTS.index(G2)]["values"][data["columns"].index("overshoot")]
    assert overshoot == format_value(study_runs.metrics[G2.name].overshoot, "rad")
    assert [len(cell["values"]) for cell in cells] == [len(data["columns"])] * 100
    assert [cell["name"] for cell in cells] == [f"KP {p.kp:g}, KV {p.kv:g}" for p in POINTS]
    assert [cell["tag"] for cell in cells if cell["opens"]] == ["G2"]
    assert 1000 < len(gzip.compress(json.dumps(data).encode(), mtime=0)) < SHIPPED


def test_each_measure_has_the_lesson_s_margin_and_the_values_of_all_runs(study_runs):
    data = explorer.explored(study_runs)
    numbers = zip(*(cell["numbers"] for cell in cells_of(data)), strict=True)
    assert explorer.CELLS.keys() == spec.MARGINS.keys() - {"settling_time"}
    for name, measure, shown in zip(explorer.CELLS, data["measures"], numbers, strict=True):
        assert measure["margin"] == spec.MARGINS[name]
        assert [*shown] == [getattr(study_runs.metrics[point.name], name) for point in POINTS]


def test_the_sentence_says_what_was_measured(study_runs):
    measured = study_runs.metrics["G1"]
    wild = replace(measured, overshoot=0.05, saturation_samples=7)
    calm = replace(measured, overshoot=0.0, saturation_samples=0)
    assert explorer.sentence(G2, wild, 120) == (
        "KP 7000, KV 100, step 0.25 rad (the case G2). Overshoot: 20.0 % of the step. "
        "Saturated: 7 of 120 samples at the force limit."
    )
    assert explorer.sentence(GridPoint(0.1, 4375.0, 150.0), calm, 120) == (
        "KP 4375, KV 150, step 0.1 rad. Overshoot: none. "
        "Not saturated: no sample at the force limit."
    )


def test_the_table_has_the_cases_in_the_rows_of_their_points(study_runs):
    rows = explorer.rows(study_runs)
    assert len(rows) == 100
    for name, point in study_spec.CASE_POINTS.items():
        assert rows[POINTS.index(point)]["case"] == name


def test_a_map_writes_each_number_into_its_cell():
    steps, kp, kv = (0.1, 0.2), (1.0, 2.0, 3.0), (10.0, 20.0)
    values = np.arange(12.0)
    axes = Figure().subplots(1, 2)
    study_plots.grid_maps(axes, values, [f"{v:g}" for v in values], steps, kp, kv)
    for ax, first in zip(axes, (0, 6), strict=True):
        cells = {text.get_position(): text.get_text() for text in ax.texts}
        assert cells[0.5, 0.5] == f"{first}"
        assert cells[1.5, 2.5] == f"{first + 5}"
        assert len(cells) == 6


def moved(run):
    name = study_spec.CASE_POINTS["G2"].name
    q = np.array(run.traces[name].q)
    q[60, K] += 5 * study_spec.AGREEMENT["rad"]
    return with_traces(run, **{name: replace(run.traces[name], q=q)})


def with_traces(run, **changed):
    return replace(run, traces=run.traces | changed)


def with_metrics(**fields):
    name = study_spec.CASE_POINTS["G1"].name
    return lambda run: replace(
        run, accepted=run.metrics | {name: replace(run.metrics[name], **fields)}
    )


def with_case(*point):
    name = POINTS[-2].name  # none of the compared cases

    def change(run):
        page = replace(run.page, runs=run.page.runs | {name: Run(GridPoint(*point).case)})
        target = np.tile(page.cases[name].q_target, (spec.STEPS, 1))
        changed = with_traces(run, **{name: replace(run.traces[name], target=target)})
        return replace(changed, page=page)

    return change


def with_another_target(run):
    first = run.traces[POINTS[0].name]
    return with_traces(run, **{POINTS[0].name: replace(first, target=first.target + 0.01)})


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (moved, r"G2, difference of position \(rad\) is 5\S*e-06, expected at most 1e-06"),
        (with_metrics(saturation_samples=99), r"G1, difference of saturation_samples .*"),
        (with_metrics(rise_time=None), r"G1, difference of rise_time \(s\) is nan, .*"),
        (with_case(0.25, 7001.0, 300.0), r"grid_\w+, kp is 7001, expected between 3500 .*"),
        (with_case(0.25, 7000.0, 99.0), r"grid_\w+, kv is 99, expected between 100 and 300"),
        (with_case(0.26, 7000.0, 300.0), r"grid_\w+, step is 0.26, expected between 0 .*"),
        (with_another_target, r"grid_\w+.steps_with_another_target is 120, expected 0"),
    ],
)
def test_what_differs_or_is_more_violent_is_named(study_runs, change, says):
    check = "grid_within_gains" if says.startswith("grid") else "grid_matches_cases"
    assert failed(study_runs) == {}
    problems = failed(change(study_runs))
    assert list(problems) == [check]
    assert re.fullmatch(says, problems[check])


def test_the_map_writes_the_saturation_of_each_point(study_runs):
    figure, measured = study_plots.grid_saturation(study_runs), study_runs.metrics[G2.name]
    saturation = [text.get_text() for ax in figure.axes for text in ax.texts]
    assert len(saturation) == 100
    assert f"G2\n{measured.saturation_samples}" in saturation
