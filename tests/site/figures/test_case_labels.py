"""Readers see words in place of the names of runs."""

from types import SimpleNamespace

import numpy as np

from robo_genesis.core import palette
from robo_genesis.core.channels import Channel, Level, Replay, Runs
from robo_genesis.site.figures.case_labels import MARKS, label, labelled

CASES = ("dt10_sub1", "baseline")
WORDS = ["one step of 10 ms", "two steps of 5 ms"]


def runs() -> Runs:
    trace = SimpleNamespace(t=np.arange(3.0), steps=2, dt=1.0)
    by_case = dict.fromkeys(CASES, trace.t)
    return Runs(
        Replay(CASES, "body", "cube"),
        subject="the cube",
        traces=dict.fromkeys(CASES, trace),
        links=("body",),
        channels=(Channel("height", "z", "m", 4, by_case),),
        levels=(
            Level("target", "height", next(iter(palette.MARKS)), "", by_case, by_case),
        ),
        moves={case: f"**{case}**: the cube falls." for case in CASES},
    )


def test_runs_are_shown_by_their_words_everywhere():
    shown = labelled(runs(), "l03")
    (channel,), (level,) = shown.channels, shown.levels
    for by_case in (
        shown.traces,
        channel.values,
        level.values,
        level.texts,
        shown.moves,
    ):
        assert list(by_case) == WORDS
    assert shown.moves[WORDS[0]] == "**one step of 10 ms**: the cube falls."


def test_a_run_keeps_its_mark_with_its_words_and_without_words_its_name():
    assert label("l03", "h_5000us_10000") == "h_5000us_10000"
    assert palette.marks_of(WORDS, MARKS) == {WORDS[0]: "first", WORDS[1]: "baseline"}
