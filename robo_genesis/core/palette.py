"""Colour and line of each mark: of cases, targets and limits, in plots and on pages.

The hues follow the palette of Okabe and Ito, darkened or lightened until each is
readable as text. Lines of measured data are solid, with names beside them or in a
legend; targets and limits have dashes.
"""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass

MEASURES = False


@dataclass(frozen=True, slots=True)
class Mark:
    """Colours in the light and the dark theme, and dashes.

    `dashes` are lengths of dashes and gaps in turn, in line widths; empty means solid.
    """

    light: str
    dark: str
    dashes: tuple[float, ...] = ()


# `other` is compared with a case: a mistake, another getter, another engine. `further`
# is any additional run, such as a point of a grid.
MARKS = {
    "baseline": Mark("#4d4d4d", "#b8c0cc"),
    "first": Mark("#0072b2", "#6cb8ff"),
    "second": Mark("#b84d00", "#ff9f4a"),
    "third": Mark("#00795c", "#3fcf9f"),
    "target": Mark("#222222", "#e6e6e6", (1, 1.65)),
    "limit": Mark("#a8003d", "#ff8fa9", (1.5, 1.5)),
    "other": Mark("#7a3e9d", "#c9a2f2"),
    "further": Mark("#6f6200", "#d6c65a"),
}

# What a figure has besides its marks. `line`: axes, and thin lines at zero or at a
# target. `band`: the area around a target. No two colours of the light theme are equal,
# here and in `MARKS`: a page finds by them what each element of a drawing is.
PARTS = {
    "text": Mark("#1b1f24", "#e6e9ed"),
    "line": Mark("#7a7a7a", "#8c96a3"),
    "grid": Mark("#d9d9d9", "#3a4350"),
    "band": Mark("#e9e4d4", "#37331f"),
    "ground": Mark("#ffffff", "#14181e"),
}

# The marks that cases take, with their classes in style sheets.
CASE_CLASSES = {
    "baseline": "case-baseline",
    "first": "case-g1",
    "second": "case-g2",
    "third": "case-g3",
}


def marks_of(cases: Collection[str], declared: Mapping[str, str]) -> dict[str, str]:
    """Return the mark of each case: the declared one, or one that no other case here has.

    Args:
        cases: that are drawn together.
        declared: marks of cases by name; it may lack some and have others.

    Raises:
        ValueError: there are more cases than marks for cases.
    """
    if len(cases) > len(CASE_CLASSES):
        raise ValueError(
            f"{', '.join(cases)} are {len(cases)} cases; the palette has {len(CASE_CLASSES)} "
            "marks. Draw fewer cases in one plot, or add marks to CASE_CLASSES in this module."
        )
    own = {case: declared[case] for case in cases if case in declared}
    baseline, *coloured = CASE_CLASSES
    free = iter([mark for mark in (*coloured, baseline) if mark not in own.values()])
    return {case: own.get(case) or next(free) for case in cases}


COLOUR = re.compile(r'(?<=[:"])( ?)(#[0-9a-fA-F]{3,8})(?=[;"])')
NAMED = re.compile(
    r'\b(?:fill|stroke)(?:: ?|=")(?!none|url|inherit|currentColor)([a-zA-Z]+)'
)
VALID_COLOURS = (
    "A page draws in the light colours of core/palette.py, which follow the reader's theme: "
    f"{', '.join(f'{name} {mark.light}' for name, mark in (MARKS | PARTS).items())}. Take one by "
    '`plotting.look("first")`, or add it there with its colour in the dark theme.'
)


def outside_the_palette(drawing: str) -> list[str]:
    """Return the colours of an SVG drawing that no theme knows; one with a picture may have any."""
    if "<image" in drawing:
        return []
    known = {mark.light for mark in (MARKS | PARTS).values()}
    return sorted(
        {each[2] for each in COLOUR.finditer(drawing)} - known
        | {*NAMED.findall(drawing)}
    )


def css_name(mark: str) -> str:
    """Return the name of a mark in style sheets: `case-g1`, `target`."""
    return CASE_CLASSES.get(mark, mark)
