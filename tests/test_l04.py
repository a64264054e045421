import ast
import json
import re
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from robo_genesis import l04, project
from robo_genesis.comparison import LABELS
from robo_genesis.joint_control import ControlCase, differences, validate
from robo_genesis.lessons import STEP_MODULES
from robo_genesis.metrics import UNITS
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
    assert {UNITS[metric] for metric in LABELS.keys() & UNITS} <= set(l04.RESOLUTION)
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


OTHER = {
    "STEPPED_JOINT": "joint2",
    "EXPECTED_MODEL": {**l04.EXPECTED_MODEL, "links": 12},
    "EXPECTED_TYPES": ("PRISMATIC",) * 9,
    "ONE_FACTOR": {("G1", "G3"): ["kp[joint4]"]},
    "FRANKA_MJCF": "another.xml",
    "JOINT_NAMES": JOINT_NAMES[::-1],
    "RISE_FRACTION": 0.8,
    "SETTLING_BAND": 0.02,
    "SATURATION_THRESHOLD": 0.9,
}


@pytest.mark.parametrize("name", OTHER)
def test_what_decides_a_run_is_a_parameter(name, monkeypatch):
    before = l04.parameters()
    monkeypatch.setattr(l04, name, OTHER[name])
    assert l04.parameters() != before


@pytest.mark.parametrize("field", [field.name for field in fields(ControlCase)])
def test_every_field_of_a_case_is_a_parameter(field, monkeypatch):
    before, value = l04.parameters(), getattr(l04.G1, field)
    monkeypatch.setitem(l04.CASES, "G1", replace(l04.G1, **{field: value + 1}))
    assert l04.parameters() != before


@pytest.mark.parametrize(
    "name", ["PREDICTIONS", "MARGINS", "RELATIONS", "TOLERANCES", "RESOLUTION"]
)
def test_what_results_are_held_against_is_none(name, monkeypatch):
    before = l04.parameters()
    monkeypatch.setattr(l04, name, {})
    assert l04.parameters() == before


def test_a_computing_module_reads_parameters_of_the_lesson_and_nothing_else():
    trees = [ast.parse((PACKAGE / f"{name}.py").read_text("utf8")) for name in STEP_MODULES]
    read = {
        node.attr
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", None) == "l04"
    }
    assert read
    assert read <= {*OTHER, "CASES"}
    assert "l04" not in STEP_MODULES


def test_the_lab_runs_with_parameters_and_words_its_result_with_the_rest():
    (lab,) = (project.BOOK / "lessons").glob("l04-*/lab.md")
    read = set(re.findall(r"\bl04\.([A-Za-z]\w*)", lab.read_text("utf8")))
    assert read - {*OTHER, "CASES"} == {"BASELINE", "PREDICTIONS", "RESOLUTION", "parameters"}
    assert l04.CASES["baseline"] is l04.BASELINE


def test_the_lesson_is_data():
    tree = ast.parse(Path(l04.__file__).read_text("utf8"))
    functions = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert functions == ["with_entry", "parameters"]


def test_the_pin_is_not_repeated():
    sources = [*PACKAGE.rglob("*.py"), *(project.BOOK / "lessons").rglob("*.md")]
    assert [path for path in sources if project.engine_pin() in path.read_text("utf8")] == []
