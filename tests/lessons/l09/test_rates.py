"""Checks, tables and figures of L09 on made-up records of clones."""

from types import SimpleNamespace

import numpy as np
import pytest
from lessons.changed_runs import passed, reading, trace, with_trace
from lessons.exercise_cells import solutions
from lessons.experiments import each, require_spoilers
from robot_runs import LINKS

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l09 import pages, plots, spec, text
from robo_genesis.lessons.l09.metrics import RUNGS, Copies, copies_metrics


def copies(good, loss, error, lost):
    """Return a record of eight networks: successes of 16, last loss, and error [rad].

    The other episodes pass the first `lost` rungs.
    """
    rungs = np.where(np.arange(16) < np.reshape(good, (-1, 1)), len(RUNGS), lost)
    return Copies(
        t=100 * np.arange(21.0),
        loss=np.repeat(np.geomspace(1, loss, 20)[:, None], 8, axis=1),
        error=np.full(8, error),
        weights=np.arange(8),
        rungs=np.broadcast_to(rungs, (8, 16)).ravel().astype(np.int8),
    )


# By kind: rungs that failures pass, last loss, error [rad], successes of all or each network.
RECORDS = """
waiting          0  0.012    2.5e-3   0
waiting_phase    2  0.00035  1.5e-3   0 0 0 1 1 0 0 0
waiting_no_turn  2  0.012    2.5e-3   1
waiting_both     2  0.0004   1.29e-3  1 3 9 8 2 5 3 6
waiting_five     2  0.012    3.0e-3   1 0 2 1 1 2 0 4
prompt           2  0.0024   2.4e-3   4 10 6 7 0 6 6 6
no_turn          2  0.0025   2.1e-3   15 15 16 15 16 14 14 12
delayed          0  0.013    2.5e-3   0
five             2  0.0048   3.2e-3   11 13 12 12 13 9 11 13
few              2  0.00165  0.8e-3   12 11 14 12 11 14 13 13
always           2  0.009    6.2e-3   12
elsewhere        2  0.003    1.0e-3   13
more             2  0.002    0.66e-3  14
most             2  0.002    0.66e-3  15
difference       2  0.008    0.95e-3  12 11 12 9 9 12 13 13
floor            2  0.0025   2.4e-3   11 9 11 11 7 11 8 7
last             2  0.001    1.5e-3   5 5 7 9 3 4 5 5
noisy            2  0.006    3.2e-3   14 15 15 15 12 15 15 10
longer           2  0.00075  1.8e-3   12 10 10 13 15 9 12 9
own              2  0.003    2.6e-3   4 10 6 7 0 6 6 6
asked            2  0.003    1.0e-3   13
"""
SOUND = {}  # By kind, the arguments of `copies`
for line in RECORDS.strip().splitlines():
    kind, *numbers = line.split()
    lost, loss, error, *good = map(float, numbers)
    SOUND[kind] = good, loss, error, lost
PROMPT = SOUND["prompt"][0]
STILL = np.zeros((2, len(LINKS), 3))
POSTURES = {"joints": 0.3, "hand": 1e-3}


def of(name, *good, **parts):
    """Give a kind of clones other successes, or another loss, error or lost rung."""
    given = good + SOUND[name][len(good) :]
    one = dict(zip(("good", "loss", "error", "lost"), given, strict=True)) | parts
    return with_trace(name, lambda run: copies(**one))


def measured(page):
    """Return the kinds of clones of a page."""
    return [name for name, run in page.runs.items() if run.measured]


@pytest.fixture(scope="module")
def runs(joints):
    """A sound run of each page; without a camera, the arm of shown episodes rises."""
    rises = STILL + np.reshape([0, 0.1], (2, 1, 1))
    found = {}
    for name in ("lecture", "asking", "inputs", "lab"):
        page = pages.LESSON.pages[name]
        traces = dict.fromkeys(page.runs, SimpleNamespace(link_pos=rises))
        traces |= {kind: copies(*SOUND[kind]) for kind in measured(page)}
        experts = dict.fromkeys(page.readings["experts"].units, len(spec.SHOWN))
        known = {"model": spec.EXPECTED_MODEL, "experts": experts, "postures": POSTURES}
        known |= passed(pages.LAB)
        found[name] = Experiment(page, traces, LINKS, known, {}, False, joints)
    return found


# Means above 0 and above that of PROMPT, but their intervals are not.
ONE, FIVES = (16, *[0] * 7), (*[16] * 5, 0, 0, 0)
SEVENTEEN = (3, 2, 2, 2, 2, 2, 2, 2)
SPOILED = {
    "lecture": {
        "phase_is_not_enough": [
            of("waiting_phase", error=2.6e-3),
            of("waiting_phase", SEVENTEEN),
            of("prompt", ONE),
        ],
        "waits_are_the_cause": [
            of("waiting", ONE),
            of("delayed", ONE),
            of("prompt", lost=0),
            of("waiting", SEVENTEEN),
            of("waiting", lost=1),
            of("delayed", SEVENTEEN),
            of("delayed", lost=1),
        ],
        "phase_helps_then": [
            of("waiting", 6),
            of("waiting_no_turn", 6),
            of("waiting_phase", 6),
        ],
        "two_causes": [
            of("waiting_no_turn", SEVENTEEN),
            of("prompt", 15),
            of("waiting_both", 15),
            of("no_turn", ONE),
        ],
        "error_does_not_rank": [
            of("waiting_phase", error=2.5e-3),
            of("waiting_phase", PROMPT),
        ],
        "chunks_help": [
            of("five", PROMPT[::-1]),
            of("five", error=2.3e-3),
            of("waiting_five", lost=0),
            of("waiting_five", 6),
        ],
    },
    "asking": {
        "postures_differ": [
            reading("postures", "joints", 0.09),
            reading("postures", "hand", 2.1e-3),
        ],
        "answers_contradict": [
            of("few", error=3.2e-3),
            of("elsewhere", error=3.2e-3),
        ],
    },
    "inputs": {
        "silent_input_harms": [of("no_turn", FIVES), of("floor", 5), of("floor", 15)],
        "noise_helps": [of("noisy", PROMPT[::-1]), of("noisy", error=1.1e-3)],
        "relative_outputs_help": [
            of("difference", PROMPT[::-1]),
            of("difference", error=2.5e-3),
        ],
        "last_command_does_not_help": [of("last", 9)],
        "training_helps": [of("longer", loss=1.3e-3), of("longer", PROMPT[::-1])],
    },
    "lab": {
        "posture": [with_trace("one", lambda run: SimpleNamespace(link_pos=STILL))],
        "functions": [reading("functions", "rate", 0)],
    },
}


@pytest.mark.parametrize("page", SPOILED)
def test_each_check_fails_for_a_spoiled_run(runs, page):
    run = runs[page]
    *_, kind = measured(run.page)
    expert, *_ = run.readings["experts"]
    everywhere = {
        "structure": [reading("model", "links", 10)],
        "experts_succeed": [reading("experts", expert, 119)],
        "trained": [of(kind, loss=0.21), trace(kind, weights=np.arange(8) % 7)],
    }
    require_spoilers(run, each(everywhere | SPOILED[page]))


def test_metrics_count_the_episodes_that_pass_each_rung():
    one = Copies(
        t=np.arange(3.0),
        loss=np.array([[1.0] * 4, [0.1, 0.2, 0.3, 0.4]]),
        error=np.array([1.0, 2.0, 3.0, 9.0]),
        weights=np.arange(4),
        rungs=np.array([0, 1, 2, 3, 4, 5, 6, 6]),
    )
    found = copies_metrics(one, spec.PROMPT)
    assert [getattr(found, rung) for rung in RUNGS] == [7, 6, 5, 4, 3, 2]
    assert (found.loss, found.error) == pytest.approx((25.0, 2.5))
    assert one.shares.tolist() == [0, 0, 0, 1]


def test_tables_count(runs):
    run = runs["lecture"]
    table = text.kind_table(run, "k", "prompt", "waiting")
    assert "| 45 of 128 | 20 to 50 |" in table
    assert "| 0 of 128 | 0 to 3 |" in table
    rows = text.order_table(run, "k", "five", "waiting_phase", "prompt").splitlines()
    assert ["1.50" in rows[2], "2.40" in rows[3], "3.20" in rows[4]] == [True] * 3
    assert "| −38 (−55 to −22) |" in text.change_table(run, "k", "five", "prompt")
    table = text.network_table(run, "k", "prompt")
    assert "| 0 4 6 6 6 6 7 10 | 8.0 | 3.6 |" in table
    assert "| resting | 45 | 94 |" in text.rung_table(run, "prompt", "five")


def test_the_lab_counts_the_student_s_clones(runs):
    run = runs["lab"]
    found = text.compared(solutions("l09")["rate"], run.traces["own"])
    assert found.count("35.2 % (20 to 50 %)") == 2
    found = text.conclusions(run)
    for words in ("45 of 128", "10 of 16", "worst in 0", "carried”: 83", "0.30 %"):
        assert words in found
    found = text.conclusions(of("own", 16)(run))
    assert ("128 of 128" in found, "“" in found) == (True, False)


def test_figures_draw(runs):
    run = runs["lecture"]
    assert len(plots.losses(run, "prompt").axes[0].lines) == 8
    assert len(plots.orders(run, "prompt", "five").axes[0].containers) == 2
    points, *_ = plots.networks(run, "waiting", "prompt").axes[0].lines
    assert points.get_xdata() == pytest.approx(np.sort(PROMPT) / 0.16)
    assert plots.posture(runs["lab"]).axes
