"""The bundles of L04's pages: runs, readings and checks are verified, and judgements are apart."""

import re

import pytest
from lessons.lesson_bundles import judged_again, refused
from spoilers import METRICS, case, pop

from robo_genesis.lessons.l04 import spec, study_spec


@pytest.mark.parametrize(
    ("spoil", "refusal"),
    [
        (
            case("MuJoCo_Euler_G2_substeps_2", note=""),
            "labels: .*MuJoCo_Euler_G2_substeps_2.note",
        ),
        (pop(METRICS, "readings", "inertia_Genesis"), "metrics: .*inertia_G"),
    ],
)
def test_a_spoiled_one_is_refused_by_its_code(copy, spoil, refusal):
    folder = copy("integrator")
    spoil(folder)
    assert re.match(refusal, refused(folder))


def test_another_judgement_changes_a_verdict_and_nothing_else(copy, monkeypatch):
    judgements = [
        (spec, "EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 12}, "mapping"),
        (spec, "ONE_FACTOR", {("G1", "G3"): ["kp[joint4]"]}, "one_factor"),
        (study_spec, "GRAVITY_AGREEMENT", -1.0, "gravity_support"),
    ]
    judged_again(copy("lecture"), monkeypatch, judgements)
