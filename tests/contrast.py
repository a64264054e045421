"""How well a colour can be read on another."""

from matplotlib.colors import to_rgb

# Backgrounds in each theme: page, panels and tables.
GROUNDS = {"light": ("#ffffff", "#f3f4f5"), "dark": ("#14181e", "#222832", "#29313d")}


def contrast(one: str, other: str) -> float:
    """Return the contrast ratio of two colours `#rrggbb`, 1 to 21.

    Source: WCAG 2.2, definitions of relative luminance and contrast ratio.
    """
    darker, lighter = sorted((luminance(one), luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


def luminance(colour: str) -> float:
    linear = [
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in to_rgb(colour)
    ]
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
