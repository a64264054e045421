"""The bundles of the lecture and the deeper pages: runs, metrics and checks are verified too."""

import re
import shutil
from pathlib import Path

import pytest
from bundles import written
from lessons.l04.conftest import PAGES, of_page
from lessons.lesson_bundles import altered, judged_again, pop, refused, without_run
from spoilers import edit, seal

from robo_genesis.core.shown import ShownError
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare
from robo_genesis.lessons.l04 import LESSON, spec, study_spec
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.site.figures.explorer import Recorded


@pytest.fixture(scope="module")
def sound(tmp_path_factory, engine, study_runs) -> dict[str, Path]:
    """A sound bundle of each page."""
    outputs = tmp_path_factory.mktemp("studied")
    return {
        name: written(engine, outputs, "l04", name, of_page(study_runs, name)) for name in PAGES
    }


@pytest.fixture
def studied(sound, tmp_path):
    """Return a bundle of one's own of a page, to spoil."""
    return lambda page: Path(shutil.copytree(sound[page], tmp_path / "l04" / page / "cpu"))


@pytest.mark.parametrize("page", PAGES)
def test_a_sound_one_is_accepted(studied, page):
    names = [check.name for check in verify_bundle(studied(page)).predicate.checks]
    assert names == [check.__name__ for check in LESSON.pages[page].checks]


def with_value(group, name, factor):
    def change(metrics):
        metrics[group][name]["value"] *= factor

    return lambda folder: edit(folder, "metrics.json", change)


def without_note(run):
    return lambda folder: edit(folder, "arrays.json", lambda a: a["cases"][run].update(note=""))


def as_run(run, other):
    def spoil(folder):
        shutil.copyfile(folder / "arrays" / f"{other}.npz", folder / "arrays" / f"{run}.npz")

    return spoil


SPOILED = {
    "a study run is missing": (
        "integrator",without_run("G2_substeps_10"), "cases", "G2_substeps_10"),
    "a run of the grid is missing": (
        "batch",
        without_run("grid_step_50mrad_KP_4375_KV_150"), "cases", "grid_step_50mrad_KP_4375_KV_150",
    ),
    "a run of the grid has the arrays of another": (
        "batch",
        as_run("grid_step_50mrad_KP_4375_KV_150", "grid_step_50mrad_KP_4375_KV_200"),
        "law", "grid_step_50mrad_KP_4375_KV_150",
    ),
    "a metric of the grid was changed": (
        "batch",
        with_value("grid_step_250mrad_KP_7000_KV_300", "peak_speed", 1.1), "metrics", "grid_step",
    ),
    "the assigned path is missing": (
        "lecture",without_run("assigned"), "cases", "note of the case assigned is absent"),
    "a run of MuJoCo is called one of Genesis": (
        "integrator",
        without_note("MuJoCo_Euler_G2_substeps_2"), "cases", "note of the case MuJoCo_Euler",
    ),
    "a study metric was changed": (
        "integrator",
        with_value("G2_substeps_10", "overshoot", 1.1), "metrics", "G2_substeps_10.overshoot",
    ),
    "a reading is missing": (
        "integrator",
        pop("metrics.json", "readings", "inertia_MuJoCo"), "metrics", "inertia_MuJoCo",
    ),
    "a reading contradicts the runs": (
        "lecture",
        with_value("readings", "gravity_G2", 1.5), "checks", "gravity_support",
    ),
    "a check of the studies is missing": (
        "formula",
        pop("manifest.json", "predicate", "checks", -1), "checks", "",
    ),
}  # fmt: skip


@pytest.mark.parametrize("how", SPOILED)
def test_a_spoiled_one_is_refused_by_its_code(studied, how):
    page, spoil, code, named = SPOILED[how]
    folder = studied(page)
    spoil(folder)
    assert re.match(rf"{code}: .*{named}", refused(folder))


def test_other_study_cases_make_it_stale(studied, monkeypatch):
    monkeypatch.setattr(study_spec, "SECOND_RUNS", {})
    with pytest.raises(BundleRefused, match=r"^stale: .*parameters\.studies\.second_runs"):
        verify_bundle(studied("integrator"))


@pytest.mark.parametrize(
    ("group", "name", "factor", "state"),
    [
        ("readings", "inertia_Genesis", 1.0005, "within tolerance"),
        ("readings", "inertia_Genesis", 1.01, "differs"),
        ("G2_substeps_10", "overshoot", 1.5, "differs"),
    ],
)
def test_a_comparison_covers_the_studies(studied, tmp_path, group, name, factor, state):
    old = studied("integrator")
    other = Path(shutil.copytree(old, tmp_path / "new" / "cpu"))
    with_value(group, name, factor)(other)
    edit(other, "manifest.json", lambda m: m["predicate"]["engine"].update(version="1.4.5"))
    seal(other)
    found = compare(old, other)
    values = next(section for section in found.sections if section.title == "Values")
    (row,) = [row for row in values.rows if row.what == f"{group}.{name}"]
    assert row.state == state


LATER = ((("G1", "G2"), "rise_time", "later", 0.0),)
JUDGEMENTS = {
    "lecture": [
        (spec, "EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 12}, "mapping"),
        (spec, "EXPECTED_TYPES", ("REVOLUTE",) * 9, "mapping"),
        (spec, "ONE_FACTOR", {("G1", "G3"): ["kp[joint4]"]}, "one_factor"),
        (spec, "CONTROL_LAW_TOLERANCE", -1.0, "control_law"),
        (spec, "LIMIT_EXCESS", -1e3, "measurements"),
        (study_spec, "AT_REST", 0.0, "gravity_support"),
        (study_spec, "GRAVITY_AGREEMENT", -1.0, "gravity_support"),
    ],
    "formula": [
        (study_spec, "ONE_JOINT_TOLERANCE", -1.0, "stepped_model"),
        (study_spec, "IMPLICIT_TERM", -1.0, "implicit_term"),
    ],
    "integrator": [
        (spec, "RELATIONS", LATER, "second_engine_order"),
        (study_spec, "SAME_MODEL", -1.0, "same_model"),
        (study_spec, "SPREAD_SHARE", -1.0, "one_limit"),
    ],
    "batch": [
        (study_spec, "AGREEMENT", dict.fromkeys(study_spec.AGREEMENT, -1.0), "grid_matches_cases"),
        (study_spec, "BOUNDS", study_spec.BOUNDS | {"kp": (3500.0, 6000.0)}, "grid_within_gains"),
    ],
}


@pytest.mark.parametrize("page", JUDGEMENTS)
def test_another_judgement_changes_a_verdict_and_nothing_else(studied, monkeypatch, page):
    judged_again(studied(page), monkeypatch, JUDGEMENTS[page])


@pytest.mark.parametrize(
    ("page", "check"), [("lecture", "control_law"), ("integrator", "one_limit")]
)
def test_an_altered_finding_is_refused(studied, page, check):
    folder = studied(page)
    altered(check)(folder)
    assert refused(folder).startswith("checks: ")


def test_a_page_can_show_the_explorer_of_another_page_s_runs(sound, study_runs):
    data = Recorded("l04", sound["batch"]).explored()
    cells = (cell for one in data["maps"] for row in one["rows"] for cell in row["cells"])
    (g2,) = (cell for cell in cells if cell["tag"] == "G2")
    overshoot = study_runs.metrics["grid_step_250mrad_KP_7000_KV_100"].overshoot
    assert g2["values"][data["columns"].index("overshoot")] == f"{overshoot:.4f} rad"


def test_a_lesson_without_an_explorer_is_named(sound):
    with pytest.raises(ShownError, match=r"lessons\.l02\.explorer\.explored"):
        Recorded("l02", sound["batch"]).explored()
