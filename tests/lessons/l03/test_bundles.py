"""Bundles of bodies on a surface, with contacts: accepted, compared, handed on, refused."""

import csv
import shutil
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from bundles import written
from spoilers import edit, predicate, seal

from robo_genesis.core.metrics import reading_records
from robo_genesis.core.trace import ContactTrace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare, specification
from robo_genesis.evidence.recorder import Measured
from robo_genesis.evidence.trace_files import read_any_trace, read_contact_trace
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.l03 import checks, spec, study
from robo_genesis.lessons.l03.metrics import measure, metric_records
from robo_genesis.sim import contacts, mujoco_contacts, session
from robo_genesis.site.takeaways.files import csv_text

MASSES = {"cube": spec.BASELINE.mass, "ball": spec.DROPPED_BALL.mass}
CUBE = {"cube": spec.BASELINE.mass}
SECONDS = {
    name: mujoco_contacts.time_constant(study.solver_step(name)) for name in spec.STEPS_STUDIED
}


def asked(cases):
    """Return the settings of cases as a scene would give them back."""
    return {name: {n: getattr(c, name) for n, c in cases.items()} for name in contacts.SETTINGS}


def measured(traces, cases, frames, masses, parameters, more=()):
    metrics = measure(traces, cases)
    settings = asked(spec.BY_GENESIS if more else cases)
    run = checks.ContactExperiment(
        spec.EXPECTED_MODEL, masses, settings, cases, traces, metrics, "camera", frames
    )
    found = metric_records(metrics, spec.EXPECTED_MODEL, masses, settings)
    if more:
        studies = study.Studies(traces, metrics, SECONDS)
        outcomes = checks.run_study_checks(run) + study.run_checks(studies)
        found |= {study.GROUP: reading_records(SECONDS, "s")}
    else:
        outcomes = checks.run_checks(run)
    renderer = session.Renderer("Mesa", "llvmpipe")
    return Measured(None, (spec.LINK,), traces, found, outcomes, frames, parameters, renderer)


@pytest.fixture(scope="module")
def lab(tmp_path_factory, engine, frames, contact_traces) -> Path:
    traces = {name: contact_traces[name] for name in spec.CASES}
    content = measured(traces, spec.CASES, frames, MASSES, spec.parameters())
    return written(engine, tmp_path_factory.mktemp("landed"), "l03", "lab", content)


@pytest.fixture(scope="module")
def lecture(tmp_path_factory, engine, frames, contact_traces) -> Path:
    cases = spec.STUDY_CASES
    traces = {name: contact_traces[name] for name in cases}
    content = measured(traces, cases, frames, CUBE, spec.study_parameters(), more=SECONDS)
    return written(engine, tmp_path_factory.mktemp("studied"), "l03", "lecture", content)


@pytest.fixture
def landed(lab, tmp_path) -> Path:
    """The lab's bundle, to spoil."""
    return Path(shutil.copytree(lab, tmp_path / "l03" / "lab" / "cpu"))


@pytest.fixture
def studied(lecture, tmp_path) -> Path:
    """The lecture's."""
    return Path(shutil.copytree(lecture, tmp_path / "l03" / "lecture" / "cpu"))


def test_sound_ones_are_accepted(landed, studied):
    names = [check.name for check in verify_bundle(landed).predicate.checks]
    assert names == [check.__name__ for check in checks.CHECKS]
    names = [check.name for check in verify_bundle(studied).predicate.checks]
    assert names[-1] == study.STUDIED[-1].__name__


def test_contacts_come_back_as_they_were(landed, contact_traces):
    arrays = bundle.read_arrays(landed)
    found = read_any_trace(landed, arrays, "baseline")
    assert isinstance(found, ContactTrace)
    assert found.contacts.dtype == np.int32
    assert np.array_equal(found.contacts, contact_traces["baseline"].contacts)
    assert np.array_equal(found.penetration, contact_traces["baseline"].penetration)


def test_each_page_compares_with_itself_by_its_own_cases(landed, studied):
    found = compare(landed, landed, specification("l03", "lab"))
    assert found.state == "equal"
    titles = {section.title: section for section in found.sections}
    assert len(titles["Relations"].findings) == len(spec.RELATIONS)
    other = compare(studied, studied, specification("l03", "lecture"))
    assert other.state == "equal"
    claims = {s.title: s for s in other.sections}["Relations"].findings
    assert [claim.what for claim in claims] == [
        "stop_distance: high_on_050 lower than low_on_050, held in both"
    ]


def test_it_becomes_a_table_with_contacts(landed):
    arrays = bundle.read_arrays(landed)
    trace = read_any_trace(landed, arrays, "dt20_sub1")
    rows = list(csv.DictReader(csv_text(trace, arrays, "dt20_sub1").splitlines()))
    assert len(rows) == 76
    assert rows[-1]["contacts body [1]"] == "4"
    assert float(rows[-1]["penetration body [m]"]) > 0


def without_contacts(folder):
    path = folder / "arrays" / "baseline.npz"
    with np.load(path) as stored:
        values = {name: np.array(stored[name]) for name in stored}
    del values["contacts"]
    np.savez_compressed(path, **values)
    edit(folder, "arrays.json", lambda a: a["cases"]["baseline"]["variables"].pop("contacts"))


def changed(case, name, change):
    def spoil(folder):
        path = folder / "arrays" / f"{case}.npz"
        with np.load(path) as stored:
            values = {key: np.array(stored[key]) for key in stored}
        change(values[name])
        np.savez_compressed(path, **values)

    return spoil


def honest_failure(folder):
    """A cube that starts elsewhere, with metrics and checks made what the arrays now give."""
    changed("baseline", "link_pos_m", lambda a: a[:, 0, 1].__iadd__(0.01))(folder)
    arrays = bundle.read_arrays(folder)
    traces = {name: read_contact_trace(folder, arrays, name) for name in spec.CASES}
    metrics = measure(traces, spec.CASES)
    frames = {name: np.zeros(0) for name in ("initial", "final")}
    run = checks.ContactExperiment(
        spec.EXPECTED_MODEL,
        MASSES,
        asked(spec.CASES),
        spec.CASES,
        traces,
        metrics,
        "camera",
        frames,
    )
    outcomes = [asdict(check) for check in checks.run_checks(run)]
    found = metric_records(metrics, spec.EXPECTED_MODEL, MASSES, asked(spec.CASES))
    edit(folder, "metrics.json", lambda m: m.update(found))

    def change(m):
        m["predicate"]["checks"] = [*outcomes[:-1], m["predicate"]["checks"][-1]]

    edit(folder, "manifest.json", change)


def metric(group, name, value):
    def change(folder):
        edit(folder, "metrics.json", lambda m: m[group][name].update(value=value))

    return change


def pop(file, *path):
    def change(folder):
        def of(content):
            for key in path[:-1]:
                content = content[key]
            content.pop(path[-1])

        edit(folder, file, of)

    return change


LAB = {
    "a position was moved": ("metrics", changed("baseline", "link_pos_m",
                                                lambda a: a[25, 0, 2:].__isub__(0.01))),
    "a start elsewhere, told as it is": ("failed", honest_failure),
    "contacts that were never read": ("labels", without_contacts),
    "a count of contacts was written": ("metrics", changed("low_on_050", "contacts",
                                                           lambda a: a.fill(4))),
    "a metric was written": ("metrics", metric("low_on_050", "stop_distance", 0.4077)),
    "another friction than asked for": ("checks", metric("friction", "low_on_050", 0.45)),
    "a friction that was not read": ("metrics", pop("metrics.json", "friction", "low_on_050")),
    "another mass": ("checks", metric("mass", "ball", 0.2)),
    "no mass": ("metrics", metric("mass", "cube", None)),
    "a mass that is left out": ("metrics", pop("metrics.json", "mass", "ball")),
    "a run is missing": ("cases", pop("arrays.json", "cases", "bounce_sub4")),
    "another name for the body": ("labels", lambda f: edit(
        f, "arrays.json", lambda a: a["coords"].update(link=["box_baselink"]))),
    "a check that is left out": (
        "checks", lambda f: edit(f, "manifest.json", lambda m: m["predicate"]["checks"].pop())),
    "the lecture's parameters": ("stale", predicate(parameters=spec.study_parameters())),
}  # fmt: skip

LECTURE = {
    "another time constant": ("checks", metric("time_constant", "h_20000us", 0.01)),
    "a time constant that is left out": (
        "metrics", pop("metrics.json", "time_constant", "h_20000us")),
    "a run of the other engine is missing": ("cases", pop("arrays.json", "cases",
                                                          "mujoco_baseline")),
    "a cube that was laid down": ("metrics", changed("low_on_050", "link_pos_m",
                                                     lambda a: a[:, 0, 2].fill(0.765))),
}  # fmt: skip


def refused(folder) -> str:
    seal(folder)
    with pytest.raises(BundleRefused) as caught:
        verify_bundle(folder)
    return str(caught.value)


@pytest.mark.parametrize("name", LAB)
def test_a_spoiled_lab_is_refused_by_its_code(landed, name):
    code, spoil = LAB[name]
    spoil(landed)
    assert refused(landed).startswith(code), name


@pytest.mark.parametrize("name", LECTURE)
def test_a_spoiled_lecture_is_refused_by_its_code(studied, name):
    code, spoil = LECTURE[name]
    spoil(studied)
    assert refused(studied).startswith(code), name


def test_another_page_or_lesson_has_no_specification():
    with pytest.raises(BundleRefused, match=r"l03/exam does not measure anything"):
        specification("l03", "exam")
