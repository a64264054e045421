"""What a reader finds on the built pages."""

import re

import pytest
from bs4 import BeautifulSoup

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.l02 import checks as drop_checks
from robo_genesis.lessons.l03 import checks as contact_checks
from robo_genesis.lessons.l04 import checks as step_checks
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.registry import LESSONS

pytestmark = pytest.mark.engine
PIN = project.engine_pin()
LESSON = "lessons/l04-joint-control"
FIRST, SECOND = "lessons/l02-life-cycle", "lessons/l03-rigid-bodies"


def page(site, name: str) -> BeautifulSoup:
    return BeautifulSoup((site / f"{name}.html").read_text(), "html.parser")


@pytest.mark.parametrize("page_name", ["lecture", "lab"])
@pytest.mark.parametrize(("folder", "lesson"), [(LESSON, "L04"), (FIRST, "L02"), (SECOND, "L03")])
def test_pages_show_executed_outputs_and_their_verdict(site, folder, lesson, page_name):
    found = page(site, f"{folder}/{page_name}")
    assert f"{lesson} CHECK: PASSED" in found.get_text()
    assert len(found.select("div.cell_output img[src$='.svg']")) >= 3


@pytest.mark.parametrize(
    ("name", "checks"),
    [
        ("index", drop_checks.CHECKS),
        *((f"{FIRST}/{name}", drop_checks.CHECKS) for name in ("lecture", "lab")),
        *((f"{SECOND}/{name}", contact_checks.CHECKS) for name in ("lecture", "lab")),
        *((f"{LESSON}/{name}", step_checks.CHECKS) for name in ("lecture", "lab")),
    ],
)
def test_status_is_computed_and_says_what_is_missing(site, name, checks):
    status = page(site, name).select_one(".lesson-status").get_text()
    assert f"cpu-verified Lab in a clean notebook kernel, Genesis {PIN}" in status
    assert f"{len(checks)} of {len(checks)} checks passed" in status
    assert f"amdgpu-missing No run on this backend is recorded for Genesis {PIN}" in status


def test_a_number_in_prose_is_the_bundle_s_and_says_where_it_comes_from(site):
    records = bundle.read_metrics(site.parent / "evidence" / "l04" / "cpu")
    number = page(site, "index").select_one(".measured")
    assert number.get_text() == f"{records['G2']['overshoot'].value:.4f} rad"
    assert re.search(
        r"l04/lab on cpu, Genesis .*, run \w{8}, \d{4}-\d\d-\d\d", number["data-provenance"]
    )


def test_the_lab_s_bundle_stands_beside_the_site_and_is_accepted(site):
    manifest = verify_bundle(site.parent / "evidence" / "l04" / "cpu")
    assert manifest.predicate.page == "lab"
    assert manifest.predicate.parameters == l04.parameters()


def test_nothing_published_names_a_path_of_the_builder(site):
    texts = [p for p in site.parent.rglob("*") if p.suffix in {".html", ".json", ".txt", ".md"}]
    assert texts
    assert [p.name for p in texts if str(project.ROOT) in p.read_text(errors="ignore")] == []


def test_expected_error_shows_its_message_without_a_stack(site):
    errors = [e.get_text() for e in page(site, f"{LESSON}/lecture").select(".output.traceback")]
    assert [error.split(":")[0] for error in errors] == ["JointError", "GenesisException"]
    assert "finger_joint2" in errors[0]
    assert "non-PD-reducible actuator" in errors[1]


def test_the_missing_reference_run_has_a_panel_with_its_command(site):
    panel = page(site, f"{LESSON}/lecture").select_one(".evidence-panel.status-missing")
    assert f"No run on this backend is recorded for Genesis {PIN}" in panel.get_text()
    assert "make evidence LESSON=l04 BACKEND=amdgpu" in panel.get_text()
    assert not panel.select("img")


def test_engine_warnings_are_kept_in_a_fold(site):
    folds = page(site, f"{LESSON}/lab").select("details.hide")
    assert any("Approximating tendon" in fold.get_text() for fold in folds)


def test_math_needs_no_script(site):
    found = page(site, f"{LESSON}/lecture")
    assert len(found.select("math")) > 5
    scripts = [script.get("src") or script.get_text() for script in found.select("script")]
    assert not [text for text in scripts if "mathjax" in text.lower() or "katex" in text.lower()]


def test_build_ends_with_what_it_was_made_of(build_output):
    tail = "\n".join(build_output.splitlines()[-4 - len(LESSONS) :])
    expected = ["Site: ", "Engine: genesis-world", "requested cpu, actual cpu", "render camera"]
    expected += ["executed", "reused", "Checks passed: "]
    assert [words for words in expected if words not in tail] == []
