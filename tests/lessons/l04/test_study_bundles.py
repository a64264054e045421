"""The bundle of the page that runs the studies: their runs, metrics and checks are verified too."""

import shutil
from pathlib import Path

import pytest
from bundles import written
from spoilers import edit, seal

from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare, specification
from robo_genesis.evidence.recorder import Measured
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.l04 import checks, spec, study, study_checks, study_spec
from robo_genesis.lessons.l04.metrics import measure, metric_records
from robo_genesis.sim import session

LINKS = ("link0", "link4", "hand")


@pytest.fixture(scope="module")
def sound(tmp_path_factory, engine, frames, study_runs) -> Path:
    traces = dict(study_runs.traces)
    metrics = measure(traces, spec.CASES, study_runs.entry)
    run = checks.StepExperiment(
        study_runs.joints, spec.EXPECTED_MODEL, spec.CASES,
        {name: traces[name] for name in spec.CASES}, metrics, "camera", frames,
    )  # fmt: skip
    measured = Measured(
        joints=study_runs.joints,
        links=LINKS,
        traces=traces,
        metrics=metric_records(metrics, spec.EXPECTED_MODEL) | study.records(study_runs),
        checks=[*checks.run_checks(run), *study_checks.run_checks(study_runs)],
        frames=frames,
        parameters=spec.parameters() | study_spec.parameters(),
        renderer=session.Renderer("Mesa", "llvmpipe"),
    )
    return written(engine, tmp_path_factory.mktemp("studied"), "l04", "lecture", measured)


@pytest.fixture
def studied(sound, tmp_path):
    """A bundle of one's own, to spoil."""
    return Path(shutil.copytree(sound, tmp_path / "l04" / "lecture" / "cpu"))


def test_a_sound_one_is_accepted(studied):
    accepted = verify_bundle(studied)
    assert [check.name for check in accepted.predicate.checks][-1] == "second_engine_order"


def without_a_run(folder):
    (folder / "arrays" / "G2_substeps_10.npz").unlink()
    edit(folder, "arrays.json", lambda arrays: arrays["cases"].pop("G2_substeps_10"))


def with_value(group, name, factor):
    def change(metrics):
        metrics[group][name]["value"] *= factor

    return lambda folder: edit(folder, "metrics.json", change)


def without_a_reading(folder):
    edit(folder, "metrics.json", lambda metrics: metrics["readings"].pop("inertia_MuJoCo"))


def without_a_check(folder):
    edit(folder, "manifest.json", lambda manifest: manifest["predicate"]["checks"].pop())


SPOILED = {
    "a study run is missing": (without_a_run, "cases", "G2_substeps_10"),
    "a study metric was changed": (
        with_value("G2_substeps_10", "overshoot", 1.1), "metrics", "G2_substeps_10.overshoot",
    ),
    "a reading is missing": (without_a_reading, "metrics", "inertia_MuJoCo"),
    "a reading contradicts the runs": (
        with_value("readings", "gravity_G2", 1.5), "checks", "gravity_support",
    ),
    "a check of the studies is missing": (without_a_check, "checks", ""),
}  # fmt: skip


@pytest.mark.parametrize("how", SPOILED)
def test_a_spoiled_one_is_refused_by_its_code(studied, how):
    spoil, code, named = SPOILED[how]
    spoil(studied)
    seal(studied)
    with pytest.raises(BundleRefused, match=rf"^{code}: .*{named}"):
        verify_bundle(studied)


def test_other_study_cases_make_it_stale(studied, monkeypatch):
    monkeypatch.setattr(study_spec, "SECOND_RUNS", {})
    with pytest.raises(BundleRefused, match=r"^stale: .*parameters\.studies\.second_runs"):
        verify_bundle(studied)


@pytest.mark.parametrize(
    ("group", "name", "factor", "state"),
    [
        ("readings", "inertia_Genesis", 1.0005, "within tolerance"),
        ("readings", "inertia_Genesis", 1.01, "differs"),
        ("G2_substeps_10", "overshoot", 1.5, "differs"),
    ],
)
def test_a_comparison_covers_the_studies(studied, tmp_path, group, name, factor, state):
    other = Path(shutil.copytree(studied, tmp_path / "new" / "cpu"))
    with_value(group, name, factor)(other)
    edit(other, "manifest.json", lambda m: m["predicate"]["engine"].update(version="1.4.5"))
    seal(other)
    found = compare(studied, other, specification("l04"))
    values = next(section for section in found.sections if section.title == "Values")
    (row,) = [finding for finding in values.findings if finding.what == f"{group}.{name}"]
    assert row.state == state
