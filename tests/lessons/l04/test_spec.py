import ast
import json
import re
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from robo_genesis.core import project
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.pipeline.pages.sources import measuring_modules
from robo_genesis.sim.arm.franka import EFFORT_LIMIT, JOINT_NAMES, Q_START, per_joint
from robo_genesis.sim.arm.joint_control import ControlCase

PACKAGE = Path(spec.__file__).parents[2]
ENTRY = JOINT_NAMES.index("joint4")


def test_the_lessons_values():
    assert Q_START.tolist() == [0, -0.3, 0, -2.0, 0, 1.7, 0.79, 0.04, 0.04]
    assert spec.BASELINE.kp.tolist() == [4500, 4500, 3500, 3500, 2000, 2000, 2000, 100, 100]
    assert spec.BASELINE.kv.tolist() == [450, 450, 350, 350, 200, 200, 200, 10, 10]
    assert EFFORT_LIMIT.tolist() == [87, 87, 87, 87, 12, 12, 12, 100, 100]
    assert (spec.STEPS, spec.BASELINE.dt, spec.BASELINE.substeps, spec.BASELINE.seed) == (
        120, 0.01, 2, 0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "kp", "kv"),
    [("baseline", 3500, 350), ("G1", 3500, 100), ("G2", 7000, 100), ("G3", 7000, 300)],
)
def test_the_gains_and_the_step_of_each_case(name, kp, kv):
    case = spec.CASES[name]
    assert (case.kp[ENTRY], case.kv[ENTRY]) == (kp, kv)
    assert np.flatnonzero(case.q_target - case.q_start).tolist() == [ENTRY]
    assert case.q_target[ENTRY] - case.q_start[ENTRY] == spec.STEP == 0.25


def test_configured_arrays_are_read_only():
    for case in spec.CASES.values():
        for field in fields(ControlCase):
            value = getattr(case, field.name)
            assert not isinstance(value, np.ndarray) or not value.flags.writeable, field.name


def test_one_value_for_each_joint_is_required():
    with pytest.raises(ValueError, match="8 values given, one for each of 9 joints"):
        per_joint(*range(8))


def test_predictions_cover_the_compared_pairs():
    assert list(spec.PREDICTIONS) == list(spec.ONE_FACTOR)


def test_one_sample_exceeds_the_resolution():
    assert all(value > 0 for value in spec.RESOLUTION.values())
    assert spec.RESOLUTION["s"] < spec.BASELINE.dt
    assert spec.RESOLUTION["1"] < 1


def test_parameters_are_json():
    for page in ("lecture", "formula", "integrator", "batch"):
        parameters = spec.parameters() | study_spec.parameters(page)
        assert json.loads(json.dumps(parameters, allow_nan=False)) == parameters


OTHER = {
    "STEPPED_JOINT": "joint2",
    "EXPECTED_MODEL": {**spec.EXPECTED_MODEL, "cameras": 1},  # its names are read
    "FRANKA_MJCF": "another.xml",
    "JOINT_NAMES": JOINT_NAMES[::-1],
    "RISE_FRACTION": 0.8,
    "SETTLING_BAND": 0.02,
    "SATURATION_THRESHOLD": 0.9,
}


JUDGEMENTS = (
    "PREDICTIONS", "MARGINS", "RELATIONS", "TOLERANCES", "RESOLUTION", "EXPECTED_TYPES",
    "ONE_FACTOR", "CONTROL_LAW_TOLERANCE", "LIMIT_EXCESS",
)  # fmt: skip


@pytest.mark.parametrize(
    ("module", "name", "other", "counts"),
    [
        *((spec, name, value, True) for name, value in OTHER.items()),
        *((spec, name, {}, False) for name in JUDGEMENTS),
        (spec, "EXPECTED_MODEL", {**spec.EXPECTED_MODEL, "links": 12}, False),
    ],
)
def test_what_decides_a_run_is_a_parameter_and_a_judgement_is_none(
    monkeypatch, module, name, other, counts
):
    before = module.parameters()
    monkeypatch.setattr(module, name, other)
    assert (module.parameters() != before) == counts


@pytest.mark.parametrize(
    ("name", "other", "pages"),
    [
        ("AT_REST", 0.02, []),
        ("ONE_JOINT_TOLERANCE", 1.0, []),
        ("KP", (3500.0, 7000.0), ["batch"]),
        ("SECOND_RUNS", {}, ["integrator"]),
        ("STEP_CASES", {}, ["formula"]),
        ("LONGER_CASES", {}, ["lecture"]),
        ("EXAMPLE_CASES", {}, ["lecture"]),
    ],
)
def test_an_input_of_a_page_is_a_parameter_of_that_page_alone(monkeypatch, name, other, pages):
    every = ("lecture", "formula", "integrator", "batch")
    before = {page: study_spec.parameters(page) for page in every}
    monkeypatch.setattr(study_spec, name, other)
    assert [page for page in every if study_spec.parameters(page) != before[page]] == pages


@pytest.mark.parametrize("field", [field.name for field in fields(ControlCase)])
def test_every_field_of_a_case_is_a_parameter(field, monkeypatch):
    before, value = spec.parameters(), getattr(spec.G1, field)
    monkeypatch.setitem(spec.CASES, "G1", replace(spec.G1, **{field: value + 1}))
    assert spec.parameters() != before


def test_a_computing_module_reads_parameters_of_the_lesson_and_nothing_else():
    # The judgement and the studies also read tolerances and claimed orderings.
    found = [n for n in measuring_modules("l04", ()) if n.startswith("lessons.")]
    names = [n for n in found if ".study" not in n and ".checks" not in n]
    files = [PACKAGE.joinpath(*name.split(".")).with_suffix(".py") for name in names]
    trees = [ast.parse(file.read_text("utf8")) for file in files]
    read = {
        node.attr
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", None) == "spec"
    }
    assert read <= {*OTHER, "CASES", "ENTRY"}  # ENTRY follows from joints and stepped joint


def test_the_lab_reads_parameters_and_the_compared_pairs_alone():
    (lab,) = (project.BOOK / "lessons").glob("l04-*/lab.md")
    read = set(re.findall(r"\bspec\.([A-Za-z]\w*)", lab.read_text("utf8")))
    assert read - {*OTHER, "CASES"} == {"BASELINE", "ONE_FACTOR"}
    assert spec.CASES["baseline"] is spec.BASELINE


def test_the_pin_is_not_repeated():
    sources = [*PACKAGE.rglob("*.py"), *(project.BOOK / "lessons").rglob("*.md")]
    assert [path for path in sources if project.engine_pin() in path.read_text("utf8")] == []
