"""What is said of the pages that run."""

import re
from types import SimpleNamespace

import pytest

from robo_genesis.pipeline.pages.execute import Lines, Underway

LAST = SimpleNamespace(seconds=20.0)


def underway(cell: int = 0, **changed) -> Underway:
    """Return a page of three cells that started at second 100."""
    settings = {"name": "lab", "cells": 3, "last": LAST, "begin": 100.0} | changed
    return Underway(cell=cell, **settings)


@pytest.mark.parametrize(
    ("page", "now", "said"),
    [
        (underway(), 102.0, "kernel starts, 2 s, ~18 s left"),
        (underway(1), 106.0, "cell 1 of 3, 6 s, ~14 s left"),
        (underway(3), 190.0, "cell 3 of 3, 90 s, longer than last time"),
        (underway(2, last=None), 112.0, "cell 2 of 3, 12 s"),
    ],
)
def test_the_rest_of_a_page_is_estimated_from_its_last_run(page, now, said):
    assert page.state(now) == said


@pytest.mark.parametrize(("every", "lines"), [(0.0, 2), (1e6, 0)])
def test_running_pages_are_reported_only_after_a_silence(every, lines):
    said: list[str] = []
    report = Lines(lambda what, event: said.append(what), every)
    for _ in range(2):
        report.show([underway(2)])
    report.show([])
    assert len(said) == lines
    running = r"1 running: lab: cell 2 of 3, \d+ s, longer than last time"
    assert all(re.fullmatch(running, line) for line in said)
