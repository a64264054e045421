"""Colour and line style of each case, of targets and of limits: the one home for plots and pages.

Hues follow Okabe and Ito's palette, darkened or lightened until each reads as text on its ground.
Dashes tell the lines apart without colour; no two marks share a pattern.
"""

from collections.abc import Sequence
from dataclasses import dataclass

GROUNDS = {"light": ("#ffffff", "#f3f4f5"), "dark": ("#14181e", "#222832", "#29313d")}
"""What the marks stand on in each theme: page, panels and tables."""


@dataclass(frozen=True, slots=True)
class Mark:
    """Colours in the light and the dark theme, and dashes.

    `dashes` are lengths drawn and left out in turn, in line widths; empty means solid.
    """

    light: str
    dark: str
    dashes: tuple[float, ...] = ()


MARKS = {
    "baseline": Mark("#4d4d4d", "#b8c0cc"),
    "G1": Mark("#0072b2", "#6cb8ff", (14, 2)),
    "G2": Mark("#b84d00", "#ff9f4a", (6, 2)),
    "G3": Mark("#00795c", "#3fcf9f", (6, 2, 1.5, 2)),
    "target": Mark("#222222", "#e6e6e6", (1, 1.65)),
    "limit": Mark("#a8003d", "#ff8fa9", (1.5, 1.5)),
    "other": Mark("#7a3e9d", "#c9a2f2", (3, 1.5)),
    "further": Mark("#6f6200", "#d6c65a", (10, 2, 3, 2)),
}
"""`other` is what is held against a case: a mistake, another getter, another engine. `further` is a
run that is none of these: a point of a grid between the cases, a third one in a comparison."""

CASES = ("baseline", "G1", "G2", "G3")


def marks_of(cases: Sequence[str]) -> dict[str, str]:
    """Return the mark of each case: its own, or one that no other case here has.

    Raises:
        ValueError: there are more cases than marks that tell cases apart.
    """
    if len(cases) > len(CASES):
        raise ValueError(
            f"{', '.join(cases)} are {len(cases)} cases; the palette tells {len(CASES)} apart. "
            "Draw fewer of them over each other, or add marks to CASES in this module."
        )
    coloured = (*CASES[1:], CASES[0])  # the baseline's grey last
    free = iter([name for name in coloured if name not in cases])
    return {case: case if case in CASES else next(free) for case in cases}


def css_name(name: str) -> str:
    """Return a mark's name in style sheets: `case-g1`, `target`."""
    return f"case-{name.lower()}" if name in CASES else name


def contrast(one: str, other: str) -> float:
    """Return the contrast ratio of two colours `#rrggbb`, 1 to 21.

    Source: WCAG 2.2, definitions of relative luminance and contrast ratio.
    """
    darker, lighter = sorted((_luminance(one), _luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


def _luminance(colour: str) -> float:
    channels = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
