"""The only decimal numbers in prose are configured inputs; `make lint` runs this file."""

import re
import runpy
from pathlib import Path

import pytest

from robo_genesis.core.project import BOOK
from robo_genesis.sim.bodies.free_fall import GRAVITY

# The numbers of each lesson are a module beside its tests.
LISTS = sorted(Path(__file__).parent.glob("*/prose_numbers.py"))

CONFIGURED = {f"{GRAVITY:g}"} | {
    f"{value:g}"
    for path in LISTS
    for value in runpy.run_path(str(path))["CONFIGURED"].values()
}
PAGES = [*sorted(BOOK.glob("*.md")), *sorted(BOOK.glob("[el]*/**/*.md"))]
DECIMAL = re.compile(r"(?<![\w.])(?:\d*\.\d+(?:e[-+]?\d+)?|\d+e[-+]?\d+)(?!\.\d)", re.I)
CODE_CELL = re.compile(
    r"^```\{code-cell\}[^\n]*\n((?:---\n.*?^---\n)?).*?^```", re.S | re.M
)


def prose(source: str) -> str:
    """Drop front matter, code and roles; keep text, tables, formulas, captions and alt texts."""
    source = re.sub(r"\A---\n.*?\n---\n", "", source, flags=re.S)
    source = re.sub(CODE_CELL, r"\1", source)
    source = re.sub(r"^```\{literalinclude\}.*?^```", "", source, flags=re.S | re.M)
    source = re.sub(r"\]\([^)\s]*\)", "]", source)  # addresses
    source = re.sub(r"\b(Python|to) 3\.\d+", "", source)
    return re.sub(r"\{[\w-]+\}`[^`\n]+`", "", source)


def typed_numbers(source: str) -> set[str]:
    return set(DECIMAL.findall(prose(source))) - CONFIGURED


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(BOOK).as_posix())
def test_prose_types_no_measured_number(page: Path):
    advice = "insert what was measured with {measured}; list what was chosen in prose_numbers.py"
    assert typed_numbers(page.read_text()) == set(), advice


CELL = "```{code-cell} ipython3\n---\nalt: peaks at 3.67 rad/s\n---\nx = 0.5\n```\n"
ROLE = "{measured}`l04/lab G2.overshoot 0.5`"


@pytest.mark.parametrize(
    ("text", "typed"),
    [
        ("G2 overshoots by 0.0447 rad, under 9.81 m/s².", {"0.0447"}),
        ("By `.0447 rad` or 6e-3 rad, with Python 3.11.", {".0447", "6e-3"}),
        (CELL + ROLE, {"3.67"}),  # an alternative text is prose, code and roles are not
    ],
)
def test_a_typed_measurement_is_found(text, typed):
    assert typed_numbers(text) == typed
