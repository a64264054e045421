"""The font of formulas: what it contains, what it weighs, and that a page shows the dot of q̇."""

import io

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from PIL import Image

from robo_genesis.pipeline import npm
from robo_genesis.site.text import math_font
from robo_genesis.site.text.formulas import to_mathml

HEAVIEST = 50_000  # bytes, a ninth of what a first visit may cost


def test_the_font_has_each_character_and_the_tables_that_place_accents():
    font = TTFont(io.BytesIO(math_font.font()))
    assert {*map(ord, math_font.SHOWN | math_font.ITALIC)} <= {*font.getBestCmap()}
    assert "MATH" in font
    assert math_font.missing("q̇ ≤ 1") == ""
    assert math_font.missing("a∯Ж") == "Ж∯"


def test_the_font_is_light_and_the_same_each_time():
    content = math_font.font()
    assert len(content) <= HEAVIEST
    assert math_font.cut(npm.published(math_font.FILE)) == content


@pytest.fixture(scope="module")
def drawn(browser):
    """Return what draws a formula with the course's style at one device pixel for one CSS pixel."""
    page = browser.new_page(viewport={"width": 300, "height": 100}, device_scale_factor=1)

    def draw(latex: str, css: str) -> np.ndarray:
        body = f"<p style='font-size: 17px; margin: 40px'>{to_mathml(latex, 'inline')}</p>"
        page.set_content(f"<!doctype html><style>{css}</style>{body}")
        page.evaluate("document.fonts.ready")
        ink = 255 - np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("L"), int)
        loaded = page.evaluate("[...document.fonts].map(font => font.status)")
        assert loaded == ["loaded"] * css.count("@font-face")
        return ink

    yield draw
    page.close()


@pytest.mark.browser
def test_the_dot_of_a_velocity_is_visible_at_one_pixel_per_pixel(drawn):
    css = math_font.css()
    with_dot, without = drawn(r"\dot{q}", css), drawn("q", css)
    top = np.nonzero(without.max(axis=1) > 64)[0][0]
    light = [row for row in range(top - 6, top + 1) if with_dot[row].max() < 64]
    assert light, "light pixels lie between the dot and the letter"
    dot = with_dot[: light[-1]]
    assert dot.max() >= 128, "the dot is at least half as dark as ink can be"
    assert (dot >= 64).sum() >= 3, "and larger than a pixel"
