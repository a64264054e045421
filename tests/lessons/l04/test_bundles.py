"""The bundles of L04's pages: runs, readings and checks are verified, and judgements are apart."""

import re
import shutil

import pytest
from lessons.lesson_bundles import altered, judged_again, metric, refused, without_run
from spoilers import METRICS, case, pop

from robo_genesis.lessons.l04 import spec, study_spec

RUN, OTHER = "grid_step_50mrad_KP_4375_KV_150", "grid_step_50mrad_KP_4375_KV_200"


def as_other(folder):
    shutil.copyfile(folder / "arrays" / f"{OTHER}.npz", folder / "arrays" / f"{RUN}.npz")


@pytest.mark.parametrize(
    ("page", "spoil", "refusal"),
    [
        ("batch", without_run(RUN), f"cases: .*{RUN}"),
        ("batch", as_other, f"law: .*{RUN}"),
        ("lecture", without_run("assigned"), "cases: .*assigned"),
        ("integrator", case("MuJoCo_Euler_G2_substeps_2", note=""),
         "cases: .*note of the case MuJoCo"),
        ("integrator", pop(METRICS, "readings", "inertia_Genesis"), "metrics: .*inertia_G"),
        ("lecture", metric("readings", "gravity_G2", 30.0), "checks: .*same_model"),
        ("integrator", altered("one_limit"), "checks: "),
    ],
)  # fmt: skip
def test_a_spoiled_one_is_refused_by_its_code(copy, page, spoil, refusal):
    folder = copy(page)
    spoil(folder)
    assert re.match(refusal, refused(folder))


def test_another_judgement_changes_a_verdict_and_nothing_else(copy, monkeypatch):
    judgements = [
        (spec, "EXPECTED_MODEL", spec.EXPECTED_MODEL | {"links": 12}, "mapping"),
        (spec, "ONE_FACTOR", {("G1", "G3"): ["kp[joint4]"]}, "one_factor"),
        (study_spec, "GRAVITY_AGREEMENT", -1.0, "gravity_support"),
    ]
    judged_again(copy("lecture"), monkeypatch, judgements)
