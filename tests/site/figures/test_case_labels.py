"""Readers see words in place of the names of runs."""

from dataclasses import replace

from robo_genesis.core import palette
from robo_genesis.lessons import find_replay
from robo_genesis.site.figures.case_labels import MARKS, label
from robo_genesis.site.replay.recorded_runs import read_runs

WORDS = {"G1": "one", "G2": "two", "G3": "three"}


def test_runs_are_shown_by_their_words_everywhere(pristine):
    replay = replace(find_replay("l04"), cases=tuple(WORDS))
    shown = read_runs(pristine, replay, WORDS)
    parts = [shown.traces, shown.moves, *(one.values for one in shown.channels)]
    parts += [of for level in shown.levels for of in (level.values, level.texts)]
    for by_case in parts:
        assert list(by_case) == [*WORDS.values()]
    assert shown.moves["one"].startswith("**one**")


def test_a_run_keeps_its_mark_with_its_words_and_without_words_its_name():
    assert label("l03", "h_5000us_10000") == "h_5000us_10000"
    words = ["one step of 10 ms", "two steps of 5 ms"]
    assert palette.marks_of(words, MARKS) == {words[0]: "first", words[1]: "baseline"}
