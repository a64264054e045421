"""The built pages of L04: the mistakes and what the lecture prints."""

import re

import pytest
from bs4 import BeautifulSoup

pytestmark = pytest.mark.engine
FOLDER = "lessons/l04-joint-control"


def parsed(site, page) -> BeautifulSoup:
    return BeautifulSoup((site / FOLDER / f"{page}.html").read_text(), "html.parser")


def test_each_symptom_is_visible_before_the_fold_that_explains_it(site):
    page = parsed(site, "mistakes")
    assert "L04 GALLERY CHECK: PASSED" in page.get_text()
    folds = page.select("section section details.sd-dropdown")
    assert len(folds) == 10
    for fold in folds:
        section = fold.find_parent("section").get_text()
        evidence, _, told = section.partition("Diagnosis.")
        assert re.search(r"\d\.\d|Exception", evidence), section[:80]
        assert "Fix." in told
    drawings = page.select("figure svg")
    assert sum("joint4" in drawing["aria-label"] for drawing in drawings) == 5
    assert len(drawings) == 6


def test_the_lecture_shows_two_failures(site):
    blocks = [block.get_text() for block in parsed(site, "lecture").select("div.cell_output pre")]
    (moved,) = (text for text in blocks if "finger_joint1 " in text and "joint7" in text)
    changes = {line.split()[0]: float(line.split()[1]) for line in moved.splitlines()[-9:]}
    assert abs(changes["joint7"]) > 100 * abs(changes["joint4"])
    (after,) = (text for text in blocks if "after step 1:" in text)
    first, last = (float(value) for value in re.findall(r"moved (\S+) rad", after))
    assert 0 < first < last


def test_a_number_in_prose_says_where_it_comes_from_and_math_needs_no_script(site):
    page = parsed(site, "lecture")
    origins = {number["data-provenance"] for number in page.select(".measured")}
    assert any(re.search(r"l04/lecture on cpu, Genesis .*, run \w{8}", of) for of in origins)
    assert len(page.select("math")) > 5
    scripts = " ".join(f"{script.get('src')} {script.get_text()}" for script in page("script"))
    assert not re.search("mathjax|katex", scripts, re.IGNORECASE)
