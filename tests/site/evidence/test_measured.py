"""Numbers that pages insert come from the bundle, and an unknown one stops the build."""

import re
from types import SimpleNamespace

import pytest

from robo_genesis.core import project
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.site.evidence import guard, measured
from robo_genesis.site.evidence.guard import problem_of
from robo_genesis.site.evidence.measured import measured as insert
from robo_genesis.site.evidence.measured import state_words, status_fold, visit_status


def test_a_metric_comes_with_unit_and_origin(outputs, experiment):
    text, origin = insert("l04/lab", "G2.overshoot")
    assert text == f"{experiment.metrics['G2'].overshoot:.4f} rad"
    assert origin.startswith(f"Measured by l04/lab on cpu, Genesis {project.engine_pin()}, run ")
    assert origin.endswith("from q_rad_or_m, target_rad_or_m")


@pytest.mark.parametrize(
    ("name", "text"), [("model.links", "11"), ("engine", project.engine_pin())]
)
def test_counts_and_the_engine_version_are_plain(outputs, name, text):
    assert insert("l04/lab", name)[0] == text


def test_a_value_that_a_check_found_is_inserted_in_a_unit(outputs):
    text, origin = insert("l04/lab", "control_law:G1.distance_to_control_law N·m")
    assert re.fullmatch(r"\S+ N·m", text)
    assert origin.endswith("found by the check control_law")
    with pytest.raises(LookupError, match=r"no finding 'control_law:x'. Known: .*control_law:G1"):
        insert("l04/lab", "control_law:x")


@pytest.mark.parametrize("name", ["G2.overshot", "G9.overshoot", "overshoot"])
def test_an_unknown_metric_names_those_there_are(outputs, name):
    with pytest.raises(LookupError, match=rf"no metric '{name}'. Known: .*G2\.overshoot"):
        insert("l04/lab", name)


def test_a_page_without_bundle_is_refused(outputs):
    with pytest.raises(BundleRefused, match=r"manifest\.json is not in"):
        insert("l04/lecture", "G2.overshoot")


@pytest.mark.parametrize("spoiled", [None, b"", b"no pickle"])
def test_a_state_is_computed_once_for_a_kept_folder(tmp_path, monkeypatch, spoiled):
    monkeypatch.setattr(measured, "built_pages", lambda: BuiltPages(states=tmp_path / "states"))
    calls = []
    first = measured.stored("../l04/lab", lambda: calls.append(1) or "verified")
    (file,) = (path for path in tmp_path.rglob("*") if path.is_file())
    assert file.parent == tmp_path / "states"
    if spoiled is not None:
        file.write_bytes(spoiled)
    assert measured.stored("../l04/lab", lambda: calls.append(2) or "verified") == first
    assert calls == ([1] if spoiled is None else [1, 2])


def test_the_line_of_an_accepted_run_has_its_engine():
    predicate = SimpleNamespace(engine=SimpleNamespace(version="9.8.7"))
    manifest = SimpleNamespace(predicate=predicate)
    accepted = Status("verified", "amdgpu", "", manifest)
    assert state_words(accepted) == "Measured on AMD GPU with Genesis 9.8.7"
    unclear = Status("inconclusive", "amdgpu", "", manifest)
    assert state_words(unclear) == "AMD GPU run: inconclusive"
    assert state_words(Status("stale", "x<y", "why", None)) == "x<y run: stale"


def test_the_words_of_the_line_are_text_and_not_markup():
    page = SimpleNamespace(body=[])
    visit_status(page, status_fold("", line=[("stale", "x<y run: stale")]))
    assert page.body == [
        '<details class="status-line"><summary>'
        '<span class="status-word state-stale">x&lt;y run: stale</span></summary>'
    ]


def test_a_guard_names_what_is_wrong_with_its_check(outputs):
    assert problem_of("l04/lab", "control_law") is None
    assert "no check 'control_lav'. Choices: " in str(problem_of("l04/lab", "control_lav"))
    with pytest.raises(BundleRefused, match=r"manifest\.json is not in"):
        problem_of("l04/elsewhere", "control_law")


def test_a_check_that_failed_guards_nothing(outputs, monkeypatch):
    failed = SimpleNamespace(name="sag", passed=False, found={"sag_m": 0.1})
    manifest = SimpleNamespace(predicate=SimpleNamespace(checks=[failed]))
    monkeypatch.setattr(guard.bundle, "read_manifest", lambda folder: manifest)
    assert problem_of("l04/lab", "sag") == "the check sag of l04/lab found {'sag_m': 0.1}."
