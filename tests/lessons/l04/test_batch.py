"""The grid's specification, the explorer's data and the checks: without an engine."""

import gzip
import json
import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core.quantities import format_value
from robo_genesis.lessons.l04 import batch, explorer, plots, spec, study_checks, study_spec
from robo_genesis.lessons.l04.claims_text import GRID_CLAIMS
from robo_genesis.lessons.l04.study_spec import POINTS, GridPoint
from robo_genesis.sim.franka import JOINT_NAMES

K = JOINT_NAMES.index(spec.STEPPED_JOINT)
G2 = study_spec.CASE_POINTS["G2"]
SHIPPED = 60_000
"""Most bytes that the explorer's markup may take, compressed as a server sends it."""


@pytest.fixture(scope="module")
def found(make_run, joints) -> batch.Sweep:
    """A sweep of synthetic runs, each scaled by its step and another at each point."""
    runs = []
    for number, point in enumerate(POINTS):
        run = make_run("G2", 20.0 + number / 10, 0.4 + point.kv / 300)
        scale = point.step / spec.STEP
        q = spec.START_OF_STEP + (run.q[:, K] - spec.START_OF_STEP) * scale
        moved, target = np.array(run.q), np.array(run.target)
        moved[:, K], target[:, K] = q, spec.START_OF_STEP + point.step
        runs.append(replace(run, q=moved, target=target))
    return batch.collect(POINTS, runs, joints)


@pytest.fixture(scope="module")
def grid(traces, joints) -> study_checks.Grid:
    """A sweep of G1 to G3 that agrees with the single runs."""
    alone = {name: traces[name] for name in study_spec.CASE_POINTS}
    points = list(study_spec.CASE_POINTS.values())
    return study_checks.Grid(batch.collect(points, list(alone.values()), joints), alone, joints)


def failed(grid):
    outcomes = study_checks.run_grid_checks(grid, GRID_CLAIMS)
    return {check.name: check.detail for check in outcomes if not check.passed}


def test_the_grid_holds_the_lesson_s_cases_exactly():
    assert len(set(POINTS)) == len(POINTS) == 100
    for name, point in study_spec.CASE_POINTS.items():
        assert point in POINTS
        case, same = spec.CASES[name], point.case
        assert all((getattr(case, f) == getattr(same, f)).all() for f in ("kp", "kv", "q_target"))
    assert [study_spec.point_of(point.case) for point in POINTS] == list(POINTS)


def test_a_sweep_cannot_be_changed(found):
    assert found.q.shape == (100, spec.STEPS + 1)
    assert found.control_force.shape == (100, spec.STEPS)
    for array in (found.t, found.q, found.control_force, found.effort_limit):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_packed_data_unpacks_within_half_a_unit(found):
    data = json.loads(json.dumps(explorer.pack(found)))
    q, force = (
        np.array([point[name] for point in data["points"]]) * data["resolution"][name]
        for name in ("q", "force")
    )
    q = q + data["start"]
    # The arrays are float32: their own last bit adds to the half unit.
    assert np.abs(q - found.q).max() <= 0.5 * explorer.RESOLUTION["q"] + 1e-6
    assert np.abs(force - found.control_force).max() <= 0.5 * explorer.RESOLUTION["force"] + 1e-5
    assert np.ptp(found.q) > 1000 * explorer.RESOLUTION["q"]


def test_packed_metrics_are_those_of_the_full_arrays(found):
    data, number = explorer.pack(found), found.at(G2)
    overshoot = data["points"][number]["metrics"][data["labels"].index("overshoot")]
    assert overshoot == format_value(found.metrics[number].overshoot, "rad")
    assert [len(point["metrics"]) for point in data["points"]] == [len(data["labels"])] * 100


def test_the_axes_number_the_points(found):
    """As the page's script counts: the last axis fastest."""
    axes = explorer.pack(found)["axes"]
    points = [tuple(getattr(point, axis["name"]) for axis in axes) for point in found.points]
    assert points == list(product(*(axis["values"] for axis in axes)))


def test_the_sentence_says_what_was_measured(found):
    measured = found.metrics[0]
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


def test_the_markup_is_small_and_its_data_can_be_read(found):
    markup = explorer.markup(found)
    assert 1000 < len(gzip.compress(markup.encode(), mtime=0)) < SHIPPED
    (text,) = re.findall(r'<script type="application/json">(.*?)</script>', markup)
    assert json.loads(text) == json.loads(json.dumps(explorer.pack(found)))


def test_the_table_has_the_cases_in_the_rows_of_their_points(found):
    rows = explorer.rows(found)
    assert len(rows) == 100
    for name, point in study_spec.CASE_POINTS.items():
        assert rows[found.at(point)]["case"] == name


def test_a_map_writes_each_number_into_its_cell():
    steps, kp, kv = (0.1, 0.2), (1.0, 2.0, 3.0), (10.0, 20.0)
    values = np.arange(12.0)
    axes = Figure().subplots(1, 2)
    plots.grid_maps(axes, values, [f"{v:g}" for v in values], steps, kp, kv)
    for ax, first in zip(axes, (0, 6), strict=True):
        cells = {text.get_position(): text.get_text() for text in ax.texts}
        assert cells[0.5, 0.5] == f"{first}"
        assert cells[1.5, 2.5] == f"{first + 5}"
        assert len(cells) == 6


def moved(found):
    q = np.array(found.q)
    q[1, 60] += 5 * study_spec.AGREEMENT["rad"]
    return {"q": q}


def with_first_metrics(**fields):
    return lambda found: {"metrics": (replace(found.metrics[0], **fields), *found.metrics[1:])}


def with_last_case(*point):
    return lambda found: {"cases": (*found.cases[:2], GridPoint(*point).case)}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (moved, r"G2, difference of position \[rad\] is 5\S*e-06, expected at most 1e-06"),
        (with_first_metrics(saturation_samples=99), r"G1, difference of saturation_samples .*"),
        (with_first_metrics(rise_time=None), r"G1, difference of rise_time \[s\] is nan, .*"),
        (with_last_case(0.25, 7001.0, 100.0), "run 2, kp is 7001, expected between 3500 and 7000"),
        (with_last_case(0.25, 7000.0, 99.0), "run 2, kv is 99, expected between 100 and 300"),
        (with_last_case(0.26, 7000.0, 100.0), "run 2, step is 0.26, expected between 0 and 0.25"),
    ],
)
def test_what_differs_or_is_more_violent_is_named(grid, change, says):
    check = "grid_within_gains" if says.startswith("run") else "grid_matches_cases"
    assert failed(grid) == {}
    problems = failed(replace(grid, found=replace(grid.found, **change(grid.found))))
    assert list(problems) == [check]
    assert re.fullmatch(says, problems[check])
