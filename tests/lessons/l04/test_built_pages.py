"""The built pages of L04: mistakes, the explorer, warnings and formulas."""

import re
from pathlib import Path

import pytest
from bs4 import BeautifulSoup

from robo_genesis.core import project
from robo_genesis.evidence import bundle

pytestmark = pytest.mark.engine
FOLDER = "lessons/l04-joint-control"


def parsed(page: Path) -> BeautifulSoup:
    return BeautifulSoup(page.read_text(), "html.parser")


@pytest.fixture(scope="module")
def lecture(site) -> BeautifulSoup:
    return parsed(site / FOLDER / "lecture.html")


@pytest.fixture(scope="module")
def mistakes(site) -> BeautifulSoup:
    return parsed(site / FOLDER / "mistakes.html")


def plain(part) -> str:
    return re.sub(r"\s+", " ", part.get_text())


def test_all_symptoms_showed(mistakes):
    assert "L04 GALLERY CHECK: PASSED" in mistakes.get_text()


@pytest.mark.parametrize(
    ("anchor", "evidence"),
    [
        ("the-wrong-joint-moves", r"joint7`? moved most: at the last sample it was \d\.\d{4} rad"),
        (
            "seven-values-raise-an-error-one-does-not",
            r"GenesisException: Invalid input shape: \(7,\)",
        ),
        (
            "the-joint-stops-short-and-the-motor-keeps-pushing",
            r"with its limit at -\d\.\d{4} rad",
        ),
        ("the-target-is-reached-in-no-time", r"get_dofs_velocity reads -?\d+\.\d{3} rad/s"),
        ("the-arm-moves-without-a-command", r"it moved \d\.\d{4} rad in as many"),
        ("the-second-run-hardly-moves", r"after a reset it moves through \d\.\d{4} rad"),
        (
            "the-arm-is-at-rest-and-its-motor-seems-to-do-nothing",
            r"get_dofs_force is \d\.\d\d N·m",
        ),
        (
            "everything-is-a-sample-too-early",
            r"rise time \d\.\d\d s instead of \d\.\d\d s",
        ),
        (
            "an-accelerator-was-requested",
            r"raised GenesisException: Backend <gs\.\w+> not available",
        ),
        ("the-fingers-close-whatever-is-commanded", r"non-PD-reducible actuator"),
    ],
)
def test_a_symptom_is_visible_before_the_fold_that_explains_it(mistakes, anchor, evidence):
    section = mistakes.select_one(f"#{anchor}")
    (fold,) = section.select("details.sd-dropdown")
    text, folded = plain(section), plain(fold)
    found = re.search(evidence, text)
    assert found
    assert found.start() < text.index(folded)
    assert folded.index("Diagnosis.") < folded.index("Fix.")


def test_figures_of_mistakes_say_what_they_show(mistakes):
    drawings = mistakes.select("figure svg")
    assert len(drawings) == 6
    assert sum("joint4" in drawing["aria-label"] for drawing in drawings) == 5


def test_fingers_before_and_after_gains_are_on_the_page(mistakes):
    pattern = r"finger_joint2 ended at (\S+) m before gains were set and at (\S+) m with gains"
    before, after = re.search(pattern, plain(mistakes)).groups()
    assert float(before) < 0.1 * float(after)


def test_the_lecture_shows_two_failures(lecture):
    blocks = [block.get_text() for block in lecture.select("div.cell_output pre")]
    (moved,) = (text for text in blocks if "finger_joint1 " in text and "joint7" in text)
    changes = {line.split()[0]: float(line.split()[1]) for line in moved.splitlines()[-9:]}
    assert abs(changes["joint7"]) > 100 * abs(changes["joint4"])
    (after,) = (text for text in blocks if "after step 1:" in text)
    first, last = (float(value) for value in re.findall(r"moved (\S+) rad", after))
    assert 0 < first < last


def test_a_number_in_prose_is_the_bundle_s_and_says_where_it_comes_from(site):
    records = bundle.read_metrics(site.parent / "evidence" / "l04" / "cpu")
    number = parsed(site / "evidence" / "index.html").select_one(".measured")
    assert number.get_text() == f"{records['G2']['overshoot'].value:.4f} rad"
    assert re.search(
        r"l04/lab on cpu, Genesis .*, run \w{8}, \d{4}-\d\d-\d\d", number["data-provenance"]
    )


def test_the_missing_reference_run_has_a_panel_with_its_command(lecture):
    panel = lecture.select_one(".evidence-panel.status-missing")
    assert f"No run on AMD GPU is recorded for Genesis {project.engine_pin()}" in panel.get_text()
    assert "make evidence LESSON=l04 BACKEND=amdgpu" in panel.get_text()
    assert not panel.select("img, svg.drawing")


def test_engine_warnings_are_kept_in_a_fold(site):
    folds = parsed(site / FOLDER / "lab.html").select("details.hide")
    assert any("Approximating tendon" in fold.get_text() for fold in folds)


def test_math_needs_no_script(lecture):
    assert len(lecture.select("math")) > 5
    scripts = [script.get("src") or script.get_text() for script in lecture.select("script")]
    assert not [text for text in scripts if "mathjax" in text.lower() or "katex" in text.lower()]
