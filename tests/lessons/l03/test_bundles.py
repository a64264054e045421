"""Bundles of bodies on a surface, with contacts: accepted, compared, refused."""

import shutil

import pytest
from lessons.lesson_bundles import judged_again, refused
from spoilers import ARRAYS, facts, in_archive, pop

from robo_genesis.evidence.compare import compare
from robo_genesis.lessons.l03 import spec, study_spec


@pytest.mark.parametrize(
    ("page", "claims"), [("lab", 2), ("lecture", 1), ("energy", 0)]
)
def test_a_page_compares_with_itself_by_its_own_cases(sound, page, claims):
    found = compare(sound[page], sound[page])
    assert found.state == "equal"
    assert (
        sum(len(of.rows) for of in found.sections if of.title == "Relations") == claims
    )


def changed(case, name, change):
    return in_archive(case, lambda arrays: change(arrays[name]))


def without_contacts(folder):
    in_archive("baseline", lambda arrays: arrays.pop("contacts"))(folder)
    pop(ARRAYS, "cases", "baseline", "variables", "contacts")(folder)


def copied(name, other):
    """Give a run the arrays of another one."""
    return lambda folder: shutil.copy(
        folder / f"arrays/{other}.npz", folder / f"arrays/{name}.npz"
    )


SPOILED = {
    "a start elsewhere": (
        "lab",
        "start",
        changed("baseline", "link_pos_m", lambda a: a[:, 0, 1].__iadd__(0.01)),
    ),
    "contacts that were never read": ("lab", "bad-array", without_contacts),
    "the lecture's parameters": (
        "lab",
        "stale",
        facts(parameters=spec.parameters() | study_spec.parameters("lecture")),
    ),
    "a cube that turns without turning": (
        "lecture",
        "motion",
        changed("h_20000us_10000", "link_ang_rad_s", lambda a: a[5, 0].__iadd__(1e-3)),
    ),
    "a run of Genesis in the place of one of MuJoCo": (
        "contact",
        "second-engine",
        copied("mujoco_baseline", "baseline"),
    ),
    "a hop of Genesis as one of MuJoCo, a little moved": (
        "contact",
        "second-engine",
        changed(
            "mujoco_low_on_050", "link_vel_m_s", lambda a: a[40:, 0, 0].__iadd__(1e-2)
        ),
    ),
}


@pytest.mark.parametrize("name", SPOILED)
def test_a_spoiled_bundle_is_refused_by_its_code(copy, name):
    page, code, spoil = SPOILED[name]
    folder = copy(page)
    spoil(folder)
    assert refused(folder).startswith(code)


def test_another_judgement_changes_a_verdict_and_nothing_else(copy, monkeypatch):
    judgements = [
        (spec, "EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 2}, "structure"),
        (spec, "ONE_FACTOR", {("baseline", "dt20_sub1"): {"substeps"}}, "one_factor"),
        (spec, "COARSE_SHARE", 1e9, "energy_converges"),
    ]
    judged_again(copy("lab"), monkeypatch, judgements)
