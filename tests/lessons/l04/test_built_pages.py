"""The built page of L04's mistakes."""

import re

import pytest
from built_site import parsed

pytestmark = pytest.mark.engine
FOLDER = "lessons/l04-joint-control"


def test_each_symptom_is_visible_before_the_fold_that_explains_it(site):
    page = parsed(site, f"{FOLDER}/mistakes")
    assert "L04 GALLERY CHECK: PASSED" in page.get_text()
    folds = page.select("section section details.sd-dropdown")
    assert len(folds) == 9
    for fold in folds:
        section = fold.find_parent("section").get_text()
        evidence, _, told = section.partition("Diagnosis.")
        assert re.search(r"\d\.\d|Exception", evidence), section[:80]
        assert "Fix." in told
    assert len(page.select("figure svg")) == 2
