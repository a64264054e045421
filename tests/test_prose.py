"""Prose of the pages holds no decimal number but configured inputs; measured ones are inserted."""

import re
from pathlib import Path

import pytest

from robo_genesis import l04, metrics, scene_config
from robo_genesis.project import BOOK

CONFIGURED = {
    "time step [s]": scene_config.DT,
    "window [s]": l04.WINDOW,
    "step of joint4 [rad]": l04.STEP,
    "open finger [m]": scene_config.Q_START[-1],
    "rise fraction": metrics.RISE_FRACTION,
    "settling band [rad]": metrics.SETTLING_BAND,
    "saturation threshold": metrics.SATURATION_THRESHOLD,
}
PAGES = sorted(BOOK.glob("*.md")) + sorted(BOOK.glob("lessons/**/*.md"))
DECIMAL = re.compile(r"(?<![\w.])\d+\.\d+(?!\.?\w)")


def prose(source: str) -> str:
    """Drop front matter, fenced code, inline code and roles; keep text, tables and formulas."""
    source = re.sub(r"\A---\n.*?\n---\n", "", source, flags=re.S)
    source = re.sub(r"^(`{3,})\{(code-cell|literalinclude)\}.*?^\1", "", source, flags=re.S | re.M)
    return re.sub(r"`[^`\n]+`", "", source)


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


def test_code_roles_and_versions_in_them_are_not_prose():
    assert typed_numbers("{measured}`l04/lab G2.overshoot` and `v1.3`") == set()
