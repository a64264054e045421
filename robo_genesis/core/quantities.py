"""Measured values as text, with the digits of each unit."""

NOT_OBSERVED = "not observed"

DIGITS = {
    "s": 2, "rad": 4, "m": 4, "rad/s": 3, "m/s": 3, "N·m": 2, "N": 2, "kg": 3, "J": 4, "%": 1,
}  # fmt: skip
"""Digits after the point by unit, in texts for readers."""

SCALED = {"m": "mm", "s": "ms", "rad": "mrad", "m/s": "mm/s", "rad/s": "mrad/s", "J": "mJ"}
"""The thousandth of a unit, in which small values are easier to read."""


def format_value(value: float | None, unit: str) -> str:
    """Return a metric as text for readers: `0.0447 rad`, `19 samples`, `not observed`."""
    if value is None:
        return NOT_OBSERVED
    if unit == "1":
        return f"{value} sample" if value == 1 else f"{value} samples"
    digits = DIGITS[unit]
    text = f"{value:.{digits}f}"
    return f"{text.removeprefix('-') if float(text) == 0 else text} {unit}"


def six_digits(value: float | None, unit: str) -> str:
    """Return a value with up to six significant digits and its unit."""
    if value is None:
        return NOT_OBSERVED
    text = str(value) if isinstance(value, int) else f"{value:.6g}"
    return text if unit == "1" else f"{text} {unit}"
