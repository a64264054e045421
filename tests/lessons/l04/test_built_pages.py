"""The built pages of L04: the failure gallery, the doctor, errors, warnings and formulas."""

import re
from pathlib import Path

import pytest
from bs4 import BeautifulSoup

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.sim.diagnosis import STEPS

pytestmark = pytest.mark.engine
FOLDER = "lessons/l04-joint-control"
PARTS = ("Symptom.", "Evidence.", "Diagnosis.", "Mend.")


def parsed(page: Path) -> BeautifulSoup:
    return BeautifulSoup(page.read_text(), "html.parser")


@pytest.fixture(scope="module")
def lecture(site) -> BeautifulSoup:
    return parsed(site / FOLDER / "lecture.html")


@pytest.fixture(scope="module")
def panels(lecture) -> dict[str, BeautifulSoup]:
    folds = lecture.select("details.sd-dropdown")
    return {fold.summary.get_text(strip=True): fold for fold in folds}


def test_all_symptoms_showed(lecture):
    assert "L04 GALLERY CHECK: PASSED" in lecture.get_text()


@pytest.mark.parametrize(
    ("title", "evidence"),
    [
        (
            "The wrong joint moves",
            r"`?joint7`? moved most: at the last sample it was \d\.\d{4} rad",
        ),
        ("Seven values are refused, one is not", r"GenesisException: Invalid input shape: \(7,\)"),
        ("The joint stops short, and the motor keeps pushing", r"with its limit at -\d\.\d{4} rad"),
        ("The target is reached in no time", r"get_dofs_velocity reads -?\d+\.\d{3} rad/s"),
        ("The arm moves, and nobody told it to", r"it moved \d\.\d{4} rad in as many"),
        ("The second run hardly moves", r"after a reset it moves through \d\.\d{4} rad"),
        ("The arm stands, and its motor seems to do nothing", r"get_dofs_force is \d\.\d\d N·m"),
        ("Everything is a sample too early", r"rise time \d\.\d\d s instead of \d\.\d\d s"),
        (
            "An accelerator was asked for",
            r"raised GenesisException: Backend <gs\.\w+> not available",
        ),
    ],
)
def test_a_panel_holds_symptom_evidence_diagnosis_and_mend(panels, title, evidence):
    text = re.sub(r"\s+", " ", panels[title].get_text())
    assert [text.find(part) for part in PARTS] == sorted(text.find(part) for part in PARTS)
    assert min(text.find(part) for part in PARTS) >= 0
    assert re.search(evidence, text)


def test_figures_of_panels_say_what_they_show(panels):
    images = [image for fold in panels.values() for image in fold.select("img")]
    assert len(images) == 5
    assert all("joint4" in image["alt"] for image in images)


def test_the_doctor_s_own_output_stands_on_the_page(lecture):
    blocks = [block.get_text() for block in lecture.select("div.cell_output pre")]
    (found,) = (text for text in blocks if "DOCTOR:" in text)
    lines = found.strip().splitlines()
    assert lines[-1] == f"DOCTOR: all {len(STEPS)} steps pass"
    assert f"genesis-world {project.engine_pin()}, as pinned" in lines[0]
    assert [line.split()[1:3] for line in lines if line[:2].strip().isdigit()] == [
        [step.__name__, "ok"] for step in STEPS
    ]
    assert max(map(len, lines)) <= 80


def test_fingers_before_and_after_gains_stand_on_the_page(lecture):
    text = re.sub(r"\s+", " ", lecture.get_text())
    pattern = r"finger_joint2 ended at (\S+) m before gains were set and at (\S+) m with gains"
    before, after = re.search(pattern, text).groups()
    assert float(before) < 0.1 * float(after)


def test_a_number_in_prose_is_the_bundle_s_and_says_where_it_comes_from(site):
    records = bundle.read_metrics(site.parent / "evidence" / "l04" / "cpu")
    number = parsed(site / "index.html").select_one(".measured")
    assert number.get_text() == f"{records['G2']['overshoot'].value:.4f} rad"
    assert re.search(
        r"l04/lab on cpu, Genesis .*, run \w{8}, \d{4}-\d\d-\d\d", number["data-provenance"]
    )


def test_expected_error_shows_its_message_without_a_stack(lecture):
    errors = [e.get_text() for e in lecture.select(".output.traceback")]
    assert [error.split(":")[0] for error in errors] == ["JointError", "GenesisException"]
    assert "finger_joint2" in errors[0]
    assert "non-PD-reducible actuator" in errors[1]


def test_the_missing_reference_run_has_a_panel_with_its_command(lecture):
    panel = lecture.select_one(".evidence-panel.status-missing")
    assert (
        f"No run on this backend is recorded for Genesis {project.engine_pin()}" in panel.get_text()
    )
    assert "make evidence LESSON=l04 BACKEND=amdgpu" in panel.get_text()
    assert not panel.select("img")


def test_engine_warnings_are_kept_in_a_fold(site):
    folds = parsed(site / FOLDER / "lab.html").select("details.hide")
    assert any("Approximating tendon" in fold.get_text() for fold in folds)


def test_math_needs_no_script(lecture):
    assert len(lecture.select("math")) > 5
    scripts = [script.get("src") or script.get_text() for script in lecture.select("script")]
    assert not [text for text in scripts if "mathjax" in text.lower() or "katex" in text.lower()]
