import json

import pytest

from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.pages import LESSON

PAGES = ("lecture", "motion", "formula", "integrator", "batch")
MODEL = spec.EXPECTED_MODEL


@pytest.mark.parametrize(
    ("module", "name", "other", "pages"),
    [
        (spec, "EXPECTED_MODEL", {**MODEL, "cameras": 1}, PAGES),  # its names are read
        (spec, "EXPECTED_MODEL", {**MODEL, "links": 12}, ()),
        (spec, "RISE_FRACTION", 0.8, PAGES),
        (spec, "RELATIONS", (), ()),
        (study_spec, "KP", (3500.0, 7000.0), ("batch",)),
        (study_spec, "INDEX_CASES", {}, ("lecture",)),
        (study_spec, "EXAMPLE_CASES", {}, ("motion",)),
    ],
)
def test_inputs_are_parameters_and_judgements_are_none(
    monkeypatch, module, name, other, pages
):
    before = {page: LESSON.pages[page].parameters() for page in PAGES}
    assert json.loads(json.dumps(before, allow_nan=False)) == before
    monkeypatch.setattr(module, name, other)
    changed = [
        page for page in PAGES if LESSON.pages[page].parameters() != before[page]
    ]
    assert changed == [*pages]
