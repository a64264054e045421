import pytest

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
