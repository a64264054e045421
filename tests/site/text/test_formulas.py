import io

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from PIL import Image

from robo_genesis.pipeline import npm
from robo_genesis.site.text import formulas
from robo_genesis.site.text.formulas import to_mathml


@pytest.mark.parametrize(
    "latex",
    [
        r"\tau = k_p (q^* - q) - k_v \dot{q}",
        r"\zeta = \frac{k_v + 1}{2 \sqrt{k_p I}} \approx 0.8\,\mathrm{N\,m}",
        r"\begin{aligned} a &= b \\ c &= d \end{aligned}",
        r"\begin{align} a &= b \\ c &= d \end{align}",
        r"\operatorname{clip}(x) = \begin{cases} 1 & x > 0 \\ 0 & \text{else} \end{cases}",
        r"\left\| \boldsymbol{q} \right\| \le \hat{\mathbf{M}} \ddot{q}",
    ],
)
def test_the_course_s_kind_of_math_is_converted_whole(latex):
    markup = to_mathml(latex, "block")
    assert markup.startswith("<math ")
    assert "\\" not in markup


@pytest.mark.parametrize(
    ("latex", "said"),
    [
        (r"\foo{x}", r"uses \\foo"),
        (r"\frac{a}{", "not valid"),
        (r"a & b", "not valid"),
        (r"\oiint x", "shows ∯, which the site's font for formulas does not have"),
    ],
)
def test_bad_math_is_refused_with_the_formula(latex, said):
    with pytest.raises(ValueError, match=said):
        to_mathml(latex, "inline")


def test_alignment_and_bold_use_what_browsers_implement():
    assert 'style="text-align: right"' in to_mathml(r"\begin{split} a &= b \end{split}", "block")
    bold = to_mathml(r"\boldsymbol{q}", "inline")
    assert "mathvariant" not in bold
    assert 'style="font-weight: bold"' in bold


@pytest.mark.parametrize("accent", [r"\dot", r"\ddot", r"\hat", r"\tilde", r"\vec", r"\bar"])
def test_an_accent_is_marked_as_one(accent):
    assert '<mover accent="true">' in to_mathml(rf"{accent}{{q}}", "inline")
    assert "accent" not in to_mathml(r"\overset{!}{=}", "inline")


HEAVIEST = 50_000  # bytes, a ninth of what a first visit may cost


def test_the_font_has_each_character_and_the_tables_that_place_accents():
    font = TTFont(io.BytesIO(formulas.font()))
    assert {*map(ord, formulas.SHOWN | formulas.ITALIC)} <= {*font.getBestCmap()}
    assert "MATH" in font
    assert formulas.missing("q̇ ≤ 1") == ""
    assert formulas.missing("a∯Ж") == "Ж∯"


def test_the_font_is_light_and_the_same_each_time():
    content = formulas.font()
    assert len(content) <= HEAVIEST
    assert formulas.cut(npm.published(formulas.FILE)) == content


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
    css = formulas.css()
    with_dot, without = drawn(r"\dot{q}", css), drawn("q", css)
    top = np.nonzero(without.max(axis=1) > 64)[0][0]
    light = [row for row in range(top - 6, top + 1) if with_dot[row].max() < 64]
    assert light, "light pixels lie between the dot and the letter"
    dot = with_dot[: light[-1]]
    assert dot.max() >= 128, "the dot is at least half as dark as ink can be"
    assert (dot >= 64).sum() >= 3, "and larger than a pixel"
