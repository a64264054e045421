"""Each rule on the page about trust is one that a spoiled bundle breaks, and the reverse."""

import re

import pytest
from spoilers import CARELESS, DAMAGED

from robo_genesis.core import project
from robo_genesis.core.comparison import SAME_FLOAT
from robo_genesis.pipeline.bundles.verify import question

PAGE = (project.BOOK / "evidence" / "trust.md").read_text("utf8")
RULES = re.findall(r"^\| .+ \| (`.+) \|$", PAGE, re.MULTILINE)
CODES = {code for cell in RULES for code in re.findall(r"`([a-z-]+)`", cell)}

# Its test spoils the page of a bundle.
ELSEWHERE = "shown"


def test_the_codes_on_the_page_are_those_of_the_spoiled_bundles():
    tested = {code for code, _ in (DAMAGED | CARELESS).values()}
    assert tested | {ELSEWHERE} == CODES


KEYED = {
    "versions of engine and compiler": ("engine", "version"),
    "precision": ("engine", "precision"),
    "seed": ("seed",),
    "all parameters": ("parameters", "cases"),
    "syntax of the page's code cells": ("source", "page"),
    "modules that compute": ("source", "modules", "lessons.l04.metrics"),
}


@pytest.mark.parametrize(("words", "path"), KEYED.items())
def test_the_key_covers_what_the_page_says(words, path):
    value = question("l04", "lab", project.ROOT, project.BOOK)
    for name in path:
        value = value[name]
    assert value is not None
    assert words in " ".join(PAGE.split())


def test_the_page_is_short_and_states_the_tolerance_of_the_code():
    assert len(re.findall(r"[A-Za-z][\w'-]*", PAGE)) <= 900
    assert SAME_FLOAT == 1e-9
    assert "one part in 10⁹" in PAGE
