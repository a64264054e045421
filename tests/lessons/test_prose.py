"""Prose of the pages holds no decimal number but configured inputs; measured ones are inserted."""

import re
from pathlib import Path

import pytest

from robo_genesis.core import scene
from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l02 import spec as l02
from robo_genesis.lessons.l03 import metrics as contact_metrics
from robo_genesis.lessons.l03 import spec as l03
from robo_genesis.lessons.l04 import metrics, study_spec
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04 import text as interpretation
from robo_genesis.sim import contacts

CONFIGURED = {
    "time step [s]": scene.DT,
    "window [s]": l04.WINDOW,
    "step of joint4 [rad]": l04.STEP,
    "small step of joint4 [rad]": study_spec.SMALL_STEP,
    "open finger [m]": scene.Q_START[-1],
    "rise fraction": metrics.RISE_FRACTION,
    "settling band [rad]": metrics.SETTLING_BAND,
    "saturation threshold": metrics.SATURATION_THRESHOLD,
    "edge of the box [m]": l02.BASELINE.size,
    "height of the box [m]": l02.BASELINE.height,
    "length of the drop [s]": l02.BASELINE.dt * l02.BASELINE.steps,
    "acceleration of gravity [m/s²]": l02.BASELINE.gravity,
    "edge of the cube [m]": l03.BASELINE.size,
    "height of the surface [m]": contacts.TOP,
    "window of a landing [s]": l03.BASELINE.duration,
    "own friction of the cubes": l03.PUSHED.friction,
    "and of the other": l03.BESIDE.friction,
    "friction of the surface": l03.PUSHED.surface_friction,
    "and of the other surface, and the time to settle [s]": l03.PUSHED.settle,
    "slow enough for a stop [m/s], and a damping ratio": contact_metrics.STOP_SPEED,
    "speed nearly at rest [rad/s]": interpretation.AT_REST,
}
PAGES = [*sorted(BOOK.glob("*.md")), *sorted(BOOK.glob("[el]*/**/*.md"))]
DECIMAL = re.compile(r"(?<![\w.])(?:\d*\.\d+(?:e-?\d+)?|\d+e-?\d+)(?!\.\d)")
CODE_CELL = re.compile(r"^```\{code-cell\}[^\n]*\n((?:---\n.*?^---\n)?).*?^```", re.S | re.M)


def prose(source: str) -> str:
    """Drop front matter, code and roles; keep text, tables, formulas, captions and alt texts."""
    source = re.sub(r"\A---\n.*?\n---\n", "", source, flags=re.S)
    source = re.sub(CODE_CELL, r"\1", source)
    source = re.sub(r"^```\{literalinclude\}.*?^```", "", source, flags=re.S | re.M)
    source = re.sub(r"\]\([^)\s]*\)", "]", source)  # addresses
    return re.sub(r"\{[\w-]+\}`[^`\n]+`", "", source)


def typed_numbers(source: str) -> set[str]:
    configured = {f"{value:g}" for value in CONFIGURED.values()}
    return set(DECIMAL.findall(prose(source))) - configured


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(BOOK).as_posix())
def test_prose_types_no_measured_number(page: Path):
    assert typed_numbers(page.read_text()) == set()


def test_a_typed_measurement_is_found():
    assert typed_numbers("G2 overshoots by 0.0447 rad, of a step of 0.25 rad.") == {"0.0447"}
    assert typed_numbers("Overshoot 3.5 %.") == {"3.5"}
    assert typed_numbers("| 87.0 | N·m |") == {"87.0"}


@pytest.mark.parametrize("text", ["0.0447rad", ".0447", "6e-3", "`0.0447 rad`"])
def test_other_ways_to_type_one_are_found(text):
    assert typed_numbers(f"It overshoots by {text} or so.")


def test_captions_and_alt_texts_count_as_prose():
    header = "mystnb:\n  image:\n    alt: peaks at 3.67 rad/s\n"
    cell = f"```{{code-cell}} ipython3\n---\n{header}---\nx = 0.5\n```\n"
    assert typed_numbers(cell) == {"3.67"}


def test_code_and_roles_are_not_prose():
    cell = "```{code-cell} ipython3\nx = 0.5\n```\n"
    assert typed_numbers(cell + "{measured}`l04/lab G2.overshoot 0.5`") == set()
