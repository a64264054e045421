"""The page on rates on made-up batches: its checks and tables, and the clock of a descent."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import put, reading, shift, trace
from lessons.experiments import require_spoilers
from lessons.l08.conftest import batch, experiment

from robo_genesis.lessons.l08 import pages, plots, rates, spec, text
from robo_genesis.sim.arm import picking


def outcomes(name, case):
    """Return which episodes succeed, hang in the hand, and are touched early."""
    along, across = 1000 * (case.beliefs - case.starts).T
    k = np.arange(len(case.starts))
    inside = (along > -3) & (along < 11) & (abs(across) < 23)
    noise = along - 1000 * rates.SAG[0] * (name == "corrected")
    good = {
        "plain": noise > -3,
        "corrected": abs(noise) < 8.5,
        "compensated": abs(noise) < 8.5,
        "elliptic": k >= 0,
        "timed": k >= 24,
        "paced": k >= 0,
        "boxes": k < 100,
    }
    return good.get(name, inside), (name == "boxes") & (k >= 108), abs(across) > 15


@pytest.fixture(scope="module")
def run(joints):
    lengths = {
        "paced": np.repeat([6, 6.5, 7], rates.TIMED),
        "timed": np.repeat([6, 6.4, 6.8, 7.2], rates.TIMED),
    }
    made = {}
    for name, case in rates.CASES.items():
        good, *hand = outcomes(name, case)
        how = {"length": lengths.get(name, 6), "slide": 1.5e-3}
        made[name] = batch(case, np.where(good, 7, 1), *hand, **how)
    return experiment(pages.RATES, made, joints)


ALL = slice(None)
SPOILED = [
    ("window_of_errors", trace("grid", force=put((ALL, slice(0, 256, 5)), 0))),
    ("correction_helps", trace("corrected", force=put((ALL, slice(95, 128)), 0))),
    ("window_is_centred", trace("corrected", force=put((ALL, slice(0, 9)), 0))),
    ("window_is_centred", trace("compensated", force=put((ALL, slice(0, 9)), 0))),
    ("cone_is_enough", trace("elliptic", force=put((ALL, slice(0, 9)), 0))),
    ("clock_hides_failure", trace("timed", force=put((ALL, 60), 0))),
    ("slower_slides_farther", trace("paced", object_pos=put((ALL, 40, 2), 0.135))),
    (
        "hovering_is_a_trap",
        trace("boxes", object_pos=put((-1, slice(100, 128), 0), 0.3)),
    ),
    ("stamps", trace("plain", t=lambda t: 2 * t)),
    ("structure", reading("model", "links", 10)),
    ("nothing_jumps", trace("boxes", q=shift((30, 0, 3), 0.5))),
    *(
        ("laws_of_motion", trace("boxes", **{array: put((0, 5), 0.7)}))
        for array in ("q", "object_pos", "object_quat")
    ),
]


def test_each_check_fails_for_a_spoiled_run(run):
    require_spoilers(run, SPOILED)


def test_a_clock_ends_the_descent_whatever_is_measured():
    case = replace(rates.batch(spec.starts(1)), timed=3.0)
    expert = picking.Expert(case, np.zeros((9, 1, 7)), np.array([True]))
    expert.phase[:] = picking.DESCEND
    for _ in range(3):
        assert expert.phase[0] == picking.DESCEND
        expert.act(np.ones((1, 9)), np.ones((1, 9)))
    assert expert.phase[0] == picking.CLOSE


def test_tables_and_figure_show_the_batches(run):
    assert "| 128 |" in text.pair_table(run)
    assert "below −8" in text.side_table(run)
    assert "| 0.6 | 2.0 | 3.00 | 1.50 |" in text.pace_table(run)
    assert "100 of 128" in text.rate_table(run, "counted")
    assert plots.errors(run, "grid").axes
