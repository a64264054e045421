"""Bundles of dropped boxes, which have no joints: accepted, compared, tabulated, refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from bundles import written
from lessons.body_runs import make_drop
from lessons.l02.readings import TRIALS
from lessons.lesson_bundles import (
    altered,
    differing_outputs,
    in_archive,
    in_json,
    judged_again,
    metric,
    pop,
    refused,
    table,
    without_run,
)  # fmt: skip
from spoilers import predicate

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.project import BOOK
from robo_genesis.core.trace import BodyTrace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.trace_files import read_any_trace, read_run, read_trace
from robo_genesis.lessons.l02 import LECTURE, checks, life_cycle, spec
from robo_genesis.pipeline.bundles.verify import verify_bundle


@pytest.fixture(scope="module")
def run(frames) -> Experiment:
    """A run of the lecture."""
    traces = {name: make_drop(case) for name, case in (spec.CASES | spec.SUBSTEP_CASES).items()}
    counted = life_cycle.expected(rendered=True)
    readings = {
        "model": spec.EXPECTED_MODEL,
        "body": {"mass": spec.BASELINE.mass},
        life_cycle.GROUP: {name: int(accepted) for name, accepted in counted.items()},
        **TRIALS,
    }
    pictures = frames | {spec.TRAYS: frames["final"]}
    return Experiment(LECTURE, traces, [spec.LINK], readings, pictures, True)


@pytest.fixture(scope="module")
def sound(tmp_path_factory, engine, run) -> Path:
    """The lecture's bundle."""
    return written(engine, tmp_path_factory.mktemp("dropped"), "l02", "lecture", run)


def test_what_the_page_shows_follows_from_its_bundle(sound, run):
    assert differing_outputs(sound, run, BOOK) == []


@pytest.fixture
def dropped(sound, tmp_path) -> Path:
    """A copy of the bundle, to spoil."""
    return Path(shutil.copytree(sound, tmp_path / "l02" / "lecture" / "cpu"))


def test_a_sound_one_is_accepted_and_has_no_joints(dropped):
    names = [check.name for check in verify_bundle(dropped).predicate.checks]
    own = [check.__name__ for check in checks.CHECKS]
    assert names[: len(own)] == own
    assert names[len(own) :] == [
        "one_factor", "shrinks", "first_order", "sides_of_build", "two_geometries",
        "invisible_lid", "further_falls",
    ]  # fmt: skip
    arrays = bundle.read_arrays(dropped)
    assert (arrays.joints, arrays.coords) == ([], {"link": [spec.LINK]})
    units = {n: v.unit for n, v in arrays.cases["baseline"].variables.items()}
    assert units["link_vel_m_s"] == "m/s"


def test_its_runs_are_read_as_they_were_recorded(dropped):
    arrays = bundle.read_arrays(dropped)
    found = read_any_trace(dropped, arrays, "baseline")
    assert np.array_equal(found.link_pos, make_drop(spec.BASELINE).link_pos)
    with pytest.raises(BundleRefused, match="labels"):
        read_trace(dropped, arrays, "baseline")


def test_runs_of_joints_are_no_runs_of_bodies(folder):
    arrays = bundle.read_arrays(folder)
    with pytest.raises(BundleRefused, match=r"number of joints of free bodies"):
        read_run(folder, arrays, "G1", BodyTrace)


def test_it_compares_with_itself(dropped):
    found = compare(dropped, dropped)
    assert found.state == "equal"
    titles = {section.title: section for section in found.sections}
    assert titles["Relations"].rows == ()
    assert {f.what for f in titles["Exact counts"].rows} >= {"life_cycle.scene.step after build"}
    assert any("link_vel_m_s" in f.what for f in titles["Arrays"].rows)


def test_it_becomes_a_table_with_units(dropped):
    rows = table(dropped, "baseline")
    assert len(rows) == 21
    assert float(rows[0]["link_pos box_baselink z [m]"]) == 0.5
    assert float(rows[-1]["link_vel box_baselink z [m/s]"]) == pytest.approx(-9.81 * 0.2)


def moved(where, by):
    return in_archive("baseline", lambda a: a["link_pos_m"][where, 0, 2].__iadd__(by))


def invented_contacts(folder):
    contacts = np.zeros((21, 1), np.int32)
    in_archive("baseline", lambda arrays: arrays.update(contacts=contacts))(folder)
    described = {"dims": ["state", "link"], "shape": [21, 1], "dtype": "int32", "unit": "1"}
    in_json("arrays.json", lambda a: a["cases"]["baseline"]["variables"].update(
        contacts=described | {"long_name": "contact points"}))(folder)  # fmt: skip


SPOILED = {
    "contacts that nobody checks": ("labels", invented_contacts),
    "a run of the study is missing": ("cases", without_run("substeps_10")),
    "a position was moved": ("motion", moved(slice(5, 6), 1e-3)),
    "another rule of stepping": ("motion", moved(slice(1, None), 1e-5)),
    "a metric was written": ("metrics", metric("baseline", "drop", 0.1962)),
    "another mass": ("checks", metric("body", "mass", 0.6)),
    "no mass": ("metrics", metric("body", "mass", None)),
    "a call that went through on the wrong side": (
        "checks", metric("life_cycle", "scene.step before build", 1)),
    "a call that was never tried": (
        "metrics", pop("metrics.json", "life_cycle", "camera.render after build")),
    "a ball that fell through the lid": ("checks", metric("trays", "hull", 0.03)),
    "a mesh that collides as it is drawn": ("checks", metric("shapes", "duck_felt", 3534)),
    "a heavier box that falls faster": ("checks", metric("further", "heavier", 0.21)),
    "no picture of the trays": ("frames", lambda f: (f / "frames" / "trays.png").unlink()),
    "one more link": ("labels", in_json(
        "arrays.json", lambda a: a["coords"].update(link=[spec.LINK, "lid"]))),
    "an axis of DOFs": ("labels", in_json(
        "arrays.json", lambda a: a["coords"].update(dof=["joint"]))),
    "a check that is left out": ("checks", pop("manifest.json", "predicate", "checks", -1)),
    "the lab's parameters": ("stale", predicate(parameters=spec.parameters())),
}  # fmt: skip


@pytest.mark.parametrize("name", SPOILED)
def test_a_spoiled_one_is_refused_by_its_code(dropped, name):
    code, spoil = SPOILED[name]
    spoil(dropped)
    assert refused(dropped).startswith(code), name


JUDGEMENTS = [
    ("FORMULA_TOLERANCE", -1.0, "stepped_formula"),
    ("AT_REST", -1.0, "straight_down"),
    ("SPEED_SHARE", -1.0, "speed"),
    ("FIRST_ORDER_SHARE", -1.0, "first_order"),
    ("EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 2}, "structure"),
    ("FURTHER_TOLERANCE", -1.0, "further_falls"),
    ("RESTING", 0.0, "invisible_lid"),
    ("BELONGS", spec.BELONGS | {"scene.step": spec.BEFORE}, "sides_of_build"),
]


def test_another_judgement_changes_a_verdict_and_nothing_else(dropped, monkeypatch):
    judged_again(dropped, monkeypatch, [(spec, *judgement) for judgement in JUDGEMENTS])


@pytest.mark.parametrize("check", ["speed", "shrinks"])
def test_an_altered_finding_is_refused(dropped, check):
    altered(check)(dropped)
    assert refused(dropped).startswith("checks: ")
