import json
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from robo_genesis import l04, project
from robo_genesis.comparison import LABELS
from robo_genesis.joint_control import ControlCase, differences, validate
from robo_genesis.metrics import UNITS, StepMetrics
from robo_genesis.scene_config import EFFORT_LIMIT, JOINT_NAMES, Q_START, per_joint

PACKAGE = Path(l04.__file__).parent
PAIRS = list(l04.ONE_FACTOR)
ENTRY = JOINT_NAMES.index("joint4")


def test_the_lessons_values():
    assert Q_START.tolist() == [0, -0.3, 0, -2.0, 0, 1.7, 0.79, 0.04, 0.04]
    assert l04.BASELINE.kp.tolist() == [4500, 4500, 3500, 3500, 2000, 2000, 2000, 100, 100]
    assert l04.BASELINE.kv.tolist() == [450, 450, 350, 350, 200, 200, 200, 10, 10]
    assert EFFORT_LIMIT.tolist() == [87, 87, 87, 87, 12, 12, 12, 100, 100]
    assert (l04.STEPS, l04.BASELINE.dt, l04.BASELINE.substeps, l04.BASELINE.seed) == (
        120, 0.01, 2, 0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "kp", "kv"), [("G1", 3500, 100), ("G2", 7000, 100), ("G3", 7000, 300)]
)
def test_the_gains_of_each_case(name, kp, kv):
    assert (l04.CASES[name].kp[ENTRY], l04.CASES[name].kv[ENTRY]) == (kp, kv)


@pytest.mark.parametrize("name", l04.CASES)
def test_the_step_is_on_one_joint_alone(name):
    step = l04.CASES[name].q_target - l04.CASES[name].q_start
    assert np.flatnonzero(step).tolist() == [ENTRY]
    assert step[ENTRY] == l04.STEP == 0.25


@pytest.mark.parametrize("name", l04.CASES)
def test_every_case_is_valid(name, joints):
    validate(l04.CASES[name], joints)


@pytest.mark.parametrize("pair", PAIRS)
def test_compared_cases_differ_in_one_entry(pair, joints):
    found = differences(l04.CASES[pair[0]], l04.CASES[pair[1]], joints)
    assert found == l04.ONE_FACTOR[pair]
    assert len(found) == 1


def test_configured_arrays_are_read_only():
    for case in l04.CASES.values():
        for field in fields(ControlCase):
            value = getattr(case, field.name)
            assert not isinstance(value, np.ndarray) or not value.flags.writeable, field.name


def test_one_value_for_each_joint_is_required():
    with pytest.raises(ValueError, match="8 values given, one for each of 9 joints"):
        per_joint(*range(8))


def test_predictions_cover_the_compared_pairs_and_known_metrics():
    assert list(l04.PREDICTIONS) == PAIRS
    for predictions in l04.PREDICTIONS.values():
        for metric, order in predictions:
            assert metric in LABELS
            assert order in ("no later", "later", "higher", "lower")


def test_every_compared_unit_has_a_resolution():
    assert {UNITS[metric] for metric in LABELS} <= set(l04.RESOLUTION)
    assert all(value > 0 for value in l04.RESOLUTION.values())


def test_one_sample_more_is_a_difference():
    assert l04.RESOLUTION["s"] < l04.BASELINE.dt
    assert l04.RESOLUTION["1"] < 1


def test_parameters_are_json_and_complete():
    parameters = l04.parameters()
    assert json.loads(json.dumps(parameters, allow_nan=False)) == parameters
    assert set(parameters["cases"]) == set(l04.CASES)
    for name, case in l04.CASES.items():
        stored = parameters["cases"][name]
        assert stored == {
            field.name: np.asarray(getattr(case, field.name)).tolist() for field in fields(case)
        }


@pytest.fixture(scope="module")
def records(experiment):
    return l04.metric_records(experiment.metrics, experiment.model)


def test_records_are_the_metrics(records, experiment):
    assert list(records) == ["model", *l04.CASES]
    for case, m in experiment.metrics.items():
        assert {n: (r["value"], r["unit"]) for n, r in records[case].items()} == {
            name: (value, unit) for name, value, unit in m.items()
        }
    assert {n: r["value"] for n, r in records["model"].items()} == l04.EXPECTED_MODEL


def test_counts_are_exact_and_measurements_are_values(records):
    classes = {r["class"] for r in records["model"].values()}
    assert classes == {"exact"}
    assert {name for name, r in records["G1"].items() if r["class"] == "exact"} == {
        "saturation_samples"
    }


def test_every_metric_names_its_source_arrays():
    assert list(l04.SOURCES) == [field.name for field in fields(StepMetrics)]


def test_measure_needs_every_case(traces):
    with pytest.raises(KeyError, match="G3"):
        l04.measure({name: traces[name] for name in ("baseline", "G1", "G2")}, ENTRY)


def test_the_pin_is_not_repeated():
    sources = [*PACKAGE.rglob("*.py"), *(project.BOOK / "lessons").rglob("*.md")]
    assert [path for path in sources if project.engine_pin() in path.read_text("utf8")] == []
