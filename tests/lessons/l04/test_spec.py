import ast
import json
from pathlib import Path

import pytest

from robo_genesis.lessons.l04 import LESSON, spec, study_spec
from robo_genesis.pipeline.pages.sources import measuring_modules

PACKAGE = Path(spec.__file__).parents[2]
PAGES = ("lecture", "formula", "integrator", "batch")


OTHER = {
    "STEPPED_JOINT": "joint2",
    "EXPECTED_MODEL": {**spec.EXPECTED_MODEL, "cameras": 1},  # its names are read
    "RISE_FRACTION": 0.8,
    "SETTLING_BAND": 0.02,
    "SATURATION_THRESHOLD": 0.9,
}


@pytest.mark.parametrize(
    ("module", "name", "other", "pages"),
    [
        *((spec, name, other, PAGES) for name, other in OTHER.items()),
        (spec, "RELATIONS", (), ()),
        (spec, "EXPECTED_MODEL", {**spec.EXPECTED_MODEL, "links": 12}, ()),
        (study_spec, "AT_REST", 0.02, ()),
        (study_spec, "KP", (3500.0, 7000.0), ("batch",)),
        (study_spec, "SECOND_RUNS", {}, ("integrator",)),
        (study_spec, "STEP_CASES", {}, ("formula",)),
        (study_spec, "LONGER_CASES", {}, ("lecture",)),
        (study_spec, "EXAMPLE_CASES", {}, ("lecture",)),
    ],
)
def test_an_input_is_a_parameter_of_its_pages_and_a_judgement_of_none(
    monkeypatch, module, name, other, pages
):
    before = {page: LESSON.pages[page].parameters() for page in PAGES}
    assert json.loads(json.dumps(before, allow_nan=False)) == before
    monkeypatch.setattr(module, name, other)
    changed = [page for page in PAGES if LESSON.pages[page].parameters() != before[page]]
    assert changed == [*pages]


def test_a_computing_module_reads_parameters_of_the_lesson_and_nothing_else():
    # The judgement and the studies also read tolerances and claimed orderings.
    found = [n for n in measuring_modules("l04", ()) if n.startswith("lessons.")]
    names = [n for n in found if ".study" not in n and "checks" not in n]
    files = [PACKAGE.joinpath(*name.split(".")).with_suffix(".py") for name in names]
    trees = [ast.parse(file.read_text("utf8")) for file in files]
    read = {
        node.attr
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", None) == "spec"
    }
    assert read <= {*OTHER, "CASES", "ENTRY"}  # ENTRY follows from joints and stepped joint
