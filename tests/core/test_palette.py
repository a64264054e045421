"""The palette is readable in both themes, and cases drawn together have different marks."""

import pytest
from contrast import GROUNDS, contrast

from robo_genesis.core.palette import MARKS, PARTS, marks_of, outside_the_palette

TEXT, GRAPHICS = (
    4.5,
    3,
)  # Least contrast of text and of graphics, WCAG 2.2, 1.4.3 and 1.4.11


@pytest.mark.parametrize("theme", GROUNDS)
@pytest.mark.parametrize("name", MARKS)
def test_each_mark_reads_as_text_on_each_ground(name, theme):
    colour = getattr(MARKS[name], theme)
    assert min(contrast(colour, ground) for ground in GROUNDS[theme]) >= TEXT


@pytest.mark.parametrize("theme", GROUNDS)
def test_the_parts_of_a_figure_can_be_seen_on_each_ground_and_its_marks_on_the_band(
    theme,
):
    text, line, band = (
        getattr(PARTS[name], theme) for name in ("text", "line", "band")
    )
    assert getattr(PARTS["ground"], theme) in GROUNDS[theme]
    assert min(contrast(text, ground) for ground in (*GROUNDS[theme], band)) >= TEXT
    assert min(contrast(line, ground) for ground in (*GROUNDS[theme], band)) >= GRAPHICS
    assert (
        min(contrast(getattr(mark, theme), band) for mark in MARKS.values()) >= GRAPHICS
    )


def test_marks_have_colours_of_their_own():
    """In the light theme also beside the parts: a page finds elements by their colour."""
    light = [mark.light for mark in (*MARKS.values(), *PARTS.values())]
    dark = [mark.dark for mark in MARKS.values()]
    assert (len({*light}), len({*dark})) == (len(light), len(dark))


@pytest.mark.parametrize(
    ("cases", "marks"),
    [
        (("G2", "baseline"), ("second", "baseline")),
        (("slow", "G1", "fast"), ("second", "first", "third")),
        ("abcd", ("first", "second", "third", "baseline")),
    ],
)
def test_each_case_drawn_with_others_has_a_mark_of_its_own(cases, marks):
    declared = {"baseline": "baseline", "G1": "first", "G2": "second"}
    assert marks_of(cases, declared) == dict(zip(cases, marks, strict=True))


def test_more_cases_than_marks_are_refused():
    with pytest.raises(
        ValueError, match=r"a, b, c, d, e are 5 cases; the palette has 4 marks"
    ):
        marks_of("abcde", {})


def test_a_drawing_has_no_colour_that_a_theme_does_not_know():
    known = f'<path style="fill: {MARKS["first"].light}; stroke: none"/>'
    other = '<path fill="#ff0000"/><path style="stroke: red"/>'
    assert outside_the_palette(known + other) == ["#ff0000", "red"]
    assert outside_the_palette(f"{other}<image/>") == []
