import io

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from PIL import Image

from robo_genesis.pipeline import npm
from robo_genesis.site.text import formulas
from robo_genesis.site.text.formulas import to_mathml


@pytest.mark.parametrize(
    ("latex", "said"),
    [
        (r"\frac{a}{", "not valid"),
        (r"\frac{a}{b", "braces are not balanced"),
        (r"a & b", "not valid"),
        (r"\oiint x", "shows ∯, which the site's font for formulas does not have"),
    ],
)
def test_bad_math_is_refused_with_the_formula(latex, said):
    with pytest.raises(ValueError, match=said):
        to_mathml(latex, "inline")


ACCENT, BOLD = '<mover accent="true">', 'style="font-weight: bold"'


@pytest.mark.parametrize(
    ("latex", "has", "lacks"),
    [
        (r"\dot{q}", ACCENT, "\\"),
        (r"\hat{q}", ACCENT, "\\"),
        (r"\overset{!}{=}", "<mover>", "accent"),
        (r"\begin{aligned} a \\{} [b] \end{aligned}", "<mtr>", "\\"),
        (r"\boldsymbol{q}", BOLD, "mathvariant"),
        (
            r"\begin{aligned} a &= b \end{aligned}",
            'style="text-align: right"',
            "columnalign",
        ),
    ],
)
def test_a_formula_uses_what_browsers_implement(latex, has, lacks):
    markup = to_mathml(latex, "block")
    assert has in markup
    assert lacks not in markup


HEAVIEST = 50_000  # bytes, a ninth of what a first visit may cost


def test_the_font_is_light_with_each_character_and_the_tables_that_place_accents():
    content = formulas.font()
    font = TTFont(io.BytesIO(content))
    assert {*map(ord, formulas.SHOWN | formulas.ITALIC)} <= {*font.getBestCmap()}
    assert "MATH" in font
    assert len(content) <= HEAVIEST
    assert formulas.cut(npm.published(formulas.FILE)) == content


@pytest.mark.browser
def test_the_dot_of_a_velocity_is_visible_at_one_pixel_per_pixel(browser):
    page = browser.new_page(
        viewport={"width": 300, "height": 100}, device_scale_factor=1
    )

    css = formulas.css()

    def drawn(latex: str) -> np.ndarray:
        body = (
            f"<p style='font-size: 17px; margin: 40px'>{to_mathml(latex, 'inline')}</p>"
        )
        page.set_content(f"<!doctype html><style>{css}</style>{body}")
        page.evaluate("document.fonts.ready")
        ink = 255 - np.asarray(
            Image.open(io.BytesIO(page.screenshot())).convert("L"), int
        )
        loaded = page.evaluate("[...document.fonts].map(font => font.status)")
        assert loaded == ["loaded"] * css.count("@font-face")
        return ink

    with_dot, without = drawn(r"\dot{q}"), drawn("q")
    page.close()
    top = np.nonzero(without.max(axis=1) > 64)[0][0]
    light = [row for row in range(top - 6, top + 1) if with_dot[row].max() < 64]
    assert light, "light pixels lie between the dot and the letter"
    dot = with_dot[: light[-1]]
    assert dot.max() >= 128, "the dot is at least half as dark as ink can be"
    assert (dot >= 64).sum() >= 3, "and larger than a pixel"
