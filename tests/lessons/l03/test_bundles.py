"""Bundles of bodies on a surface, with contacts: accepted, compared, tabulated, refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from bundles import written
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
)  # fmt: skip
from spoilers import predicate

from robo_genesis.core.project import BOOK
from robo_genesis.core.trace import ContactTrace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons.l03 import LESSON, spec, study_spec
from robo_genesis.pipeline.bundles.verify import verify_bundle


@pytest.fixture(scope="module")
def bundles(tmp_path_factory, engine, experiments) -> dict[str, Path]:
    """The bundles of all pages, by page, with MuJoCo in the place of both engines."""
    outputs = tmp_path_factory.mktemp("landed")
    return {page: written(engine, outputs, "l03", page, run) for page, run in experiments.items()}


class Copies(dict):
    """Copies of the bundles, each made when it is first needed, to spoil."""

    def __init__(self, bundles, place):
        super().__init__()
        self.bundles, self.place = bundles, place

    def __missing__(self, page):
        target = self.place / "l03" / page / "cpu"
        self[page] = Path(shutil.copytree(self.bundles[page], target))
        return self[page]


@pytest.fixture
def landed(bundles, tmp_path) -> Copies:
    return Copies(bundles, tmp_path)


@pytest.mark.parametrize("page", LESSON.pages)
def test_a_sound_one_is_accepted(landed, page):
    names = [check.name for check in verify_bundle(landed[page]).predicate.checks]
    assert names == [check.__name__ for check in LESSON.pages[page].checks]


@pytest.mark.parametrize("page", [page for page in LESSON.pages if page != "mistakes"])
def test_what_a_page_shows_follows_from_its_bundle(bundles, experiments, page):
    assert differing_outputs(bundles[page], experiments[page], BOOK) == []


def test_contacts_are_read_as_they_were_recorded(landed, contact_traces):
    found = read_any_trace(landed["lab"], bundle.read_arrays(landed["lab"]), "baseline")
    assert isinstance(found, ContactTrace)
    assert found.contacts.dtype == np.int32
    assert np.array_equal(found.contacts, contact_traces["baseline"].contacts)
    assert np.array_equal(found.penetration, contact_traces["baseline"].penetration)


def test_each_page_compares_with_itself_by_its_own_cases(bundles):
    claims = {}
    for page, folder in bundles.items():
        found = compare(folder, folder)
        assert found.state == "equal"
        sections = {section.title: section for section in found.sections}
        claims[page] = sections["Relations"].rows if "Relations" in sections else []
    assert len(claims["lab"]) == len(spec.RELATIONS)
    assert [claim.what for claim in claims["lecture"]] == [
        "stop_distance: high_on_050 lower than low_on_050, held in both"
    ]


def test_it_becomes_a_table_with_contacts(landed):
    rows = table(landed["lab"], "dt20_sub1")
    assert len(rows) == 76
    assert rows[-1]["contacts body [1]"] == "4"
    assert float(rows[-1]["penetration body [m]"]) > 0


def changed(case, name, change):
    return in_archive(case, lambda arrays: change(arrays[name]))


def without_contacts(folder):
    in_archive("baseline", lambda arrays: arrays.pop("contacts"))(folder)
    pop("arrays.json", "cases", "baseline", "variables", "contacts")(folder)


LAB = {
    "a position was moved": ("contact", changed(
        "baseline", "link_pos_m", lambda a: a[25, 0, 2:].__isub__(0.01))),
    "a start elsewhere": ("start", changed(
        "baseline", "link_pos_m", lambda a: a[:, 0, 1].__iadd__(0.01))),
    "contacts that were never read": ("labels", without_contacts),
    "a count of contacts was written": ("contact", changed(
        "low_on_050", "contacts", lambda a: a.fill(4))),
    "a metric was written": ("metrics", metric("low_on_050", "stop_distance", 0.4077)),
    "another friction than asked for": ("checks", metric("friction", "low_on_050", 0.45)),
    "a friction that was not read": ("metrics", pop("metrics.json", "friction", "low_on_050")),
    "another mass": ("checks", metric("mass", "ball", 0.2)),
    "no mass": ("metrics", metric("mass", "cube", None)),
    "a mass that is left out": ("metrics", pop("metrics.json", "mass", "ball")),
    "a run is missing": ("cases", pop("arrays.json", "cases", "bounce_sub4")),
    "another name for the body": ("labels", in_json(
        "arrays.json", lambda a: a["coords"].update(link=["box_baselink"]))),
    "a check that is left out": ("checks", pop("manifest.json", "predicate", "checks", -1)),
    "the lecture's parameters": ("stale", predicate(
        parameters=spec.parameters() | study_spec.parameters("lecture"))),
}  # fmt: skip


def copied(name, other):
    """Give a run the arrays of another one."""
    return lambda folder: shutil.copy(folder / f"arrays/{other}.npz", folder / f"arrays/{name}.npz")


LECTURE = {
    "a cube that slows down in the air": ("motion", changed(
        "h_5000us_10000", "link_vel_m_s", lambda a: a[5, 0].__imul__(0.98))),
    "a cube that turns without turning": ("motion", changed(
        "h_20000us_10000", "link_ang_rad_s", lambda a: a[5, 0].__iadd__(1e-3))),
    "another time constant": ("checks", metric("time_constant", "h_20000us", 0.01)),
    "a time constant that is left out": (
        "metrics", pop("metrics.json", "time_constant", "h_20000us")),
    "a cube that was laid down": ("contact", changed(
        "low_on_050", "link_pos_m", lambda a: a[:, 0, 2].fill(0.765))),
}  # fmt: skip

CONTACT = {
    "a run of Genesis in the place of one of MuJoCo": (
        "second-engine", copied("mujoco_baseline", "baseline")),
    "a hop of Genesis as one of MuJoCo, a little moved": ("second-engine", changed(
        "mujoco_low_on_050", "link_vel_m_s", lambda a: a[40:, 0, 0].__iadd__(1e-2))),
    "a run of the other engine is missing": (
        "cases", pop("arrays.json", "cases", "mujoco_baseline")),
    "a coarser push that is the finer one": ("contact", copied("stop_500us_low", "stop_250us_low")),
}  # fmt: skip

ENERGY = {
    "the landing on a softer contact": (
        "contact", copied("release_5ms_10000", "release_10ms_10000")),
}  # fmt: skip

SPOILED = {"lab": LAB, "lecture": LECTURE, "contact": CONTACT, "energy": ENERGY}


@pytest.mark.parametrize(("page", "name"), [(p, name) for p, of in SPOILED.items() for name in of])
def test_a_spoiled_bundle_is_refused_by_its_code(landed, page, name):
    (code, spoil), folder = SPOILED[page][name], landed[page]
    spoil(folder)
    assert refused(folder).startswith(code), name


JUDGEMENTS = {
    "lab": [
        ("EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 2}, "structure"),
        ("SETTLED_START", -1.0, "start"),
        ("START_SPEED", -1.0, "start"),
        ("FINER", (("baseline", "dt20_sub1"),), "one_factor"),
        ("EQUAL_STEP", ("baseline", "dt10_sub1"), "one_factor"),
        ("DEPTH_TOLERANCE", -1.0, "reported_late"),
        ("SAME_SLIDE", -1.0, "friction_orders"),
        ("COULOMB_SHARE", -1.0, "near_coulomb"),
        ("LEVEL_SHARE", -1.0, "level_in_flight"),
        ("FINE_SHARE", -1.0, "energy_converges"),
        ("COARSE_SHARE", 1e9, "energy_converges"),
    ],
    "lecture": [
        ("TIME_CONSTANT", -1.0, "time_constants"),
        ("SCATTER_FINE", -1.0, "scatter_shrinks"),
        ("SCATTER_COARSE", 1e9, "scatter_shrinks"),
        ("DEPTH_SHARE", -1.0, "depth_by_hand"),
        ("STIFF_SHARE", -1.0, "depth_by_hand"),
        ("HOP_LEFT", -1.0, "hop_follows_step"),
        ("INVISIBLE", -1.0, "hop_follows_speed"),
        ("STEPPED_TOLERANCE", -1.0, "clean_slides_are_coulomb_s"),
        ("RULE_TOLERANCE", -1.0, "larger_friction_rules"),
    ],
    "contact": [
        ("NEARLY", -1.0, "stops_nearly_right"),
        ("BLOW", 1e9, "hop_is_paid_by_friction"),
        ("RATIO_TOLERANCE", -1.0, "hop_is_paid_by_friction"),
        ("UNSETTLED", 1e9, "half_the_step_contradicts"),
        ("ENGINES_APART", -1.0, "engines_land_alike"),
        ("SAME_HOP", -1.0, "engines_hop_alike"),
    ],
    "energy": [
        ("RELEASE_SHARE", -1.0, "release_speed"),
        ("REBOUND_SHARE", -1.0, "stiff_contacts_rebound"),
    ],
}


@pytest.mark.parametrize("page", JUDGEMENTS)
def test_another_judgement_changes_a_verdict_and_nothing_else(landed, monkeypatch, page):
    module = spec if page == "lab" else study_spec
    judged_again(landed[page], monkeypatch, [(module, *of) for of in JUDGEMENTS[page]])


@pytest.mark.parametrize(
    ("page", "check"),
    [("lab", "near_coulomb"), ("lecture", "larger_friction_rules"), ("energy", "release_speed")],
)
def test_an_altered_finding_is_refused(landed, page, check):
    altered(check)(landed[page])
    assert refused(landed[page]).startswith("checks: ")
