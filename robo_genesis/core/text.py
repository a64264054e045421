"""Measured values and lists as text, and text that others wrote, made safe for messages."""

import re
import signal
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal

MEASURES = False

NOT_OBSERVED = "not observed"
LONGEST_SHOWN = 160

# Digits after the point by unit, in texts for readers.
DIGITS = {
    "s": 2,
    "rad": 4,
    "m": 4,
    "1/s": 2,
    "rad/s": 3,
    "m/s": 3,
    "N·m": 2,
    "N": 2,
    "kg": 3,
    "J": 4,
    "%": 1,
    "pixel": 2,
    "iterations": 0,
    "pixels": 0,
    "points": 0,
    "poses": 0,
    "postures": 0,
    "steps": 0,
}

# The thousandth of a unit, in which small values are easier to read.
SCALED = {
    "m": "mm",
    "s": "ms",
    "rad": "mrad",
    "m/s": "mm/s",
    "rad/s": "mrad/s",
    "J": "mJ",
}


# By unit, values below these are written in a smaller unit by `readable`.
SHORT = {"m": 0.1, "J": 1.0}

# A smaller unit still, and the hundredth of a share.
MICRO = {"m": "µm", "s": "µs", "rad": "µrad", "J": "µJ", "1": "%"}

# By unit of a text, the factor from the unit in which a value is kept.
SCALES = (
    dict.fromkeys(SCALED.values(), 1e3)
    | dict.fromkeys(MICRO.values(), 1e6)
    | {"%": 100.0}
)


def ended(status: int, compiled: str = ".cache/engine") -> str:
    """Return how a process ended, and what to do if a signal ended it.

    Args:
        status: as `subprocess` gives it, negative for a signal.
        compiled: the folder of compiled code.
    """
    if status >= 0:
        return f"exit status {status}"
    cause = f"the disk is full or compiled code is damaged: free space, or delete {compiled}"
    if -status == signal.SIGKILL:
        cause = (
            "the memory was full: close programs. A build needs less memory with JOBS=1"
        )
    name = f"{signal.Signals(-status).name} ({signal.strsignal(-status)})"
    return f"{name}. If nobody stopped it, {cause}"


def scaled_value(value: float, unit: str) -> str:
    """Return a value in another unit with three significant digits: `4.47 mm`, `1.2 %`.

    Raises:
        LookupError: the unit is not one of `SCALES` and `DIGITS`; the message lists
            them.
    """
    if unit not in SCALES | DIGITS:
        raise LookupError(
            f"No text has the unit {unit!r}. Valid: {', '.join(SCALES | DIGITS)}."
        )
    scaled = SCALES.get(unit, 1.0) * value
    text = f"{scaled:#.3g}".removesuffix(".")
    if "e" in text:  # three digits of a large number, or more places of a small one
        text = f"{Decimal(text):f}".rstrip("0" if abs(scaled) < 1 else "").removesuffix(
            "."
        )
    return f"{text} {unit}"


def format_value(value: float | None, unit: str) -> str:
    """Return a metric as text for readers: `0.0447 rad`, `19 samples`, `not observed`."""
    if value is None:
        return NOT_OBSERVED
    if unit == "1":
        return f"{value} sample" if value == 1 else f"{value} samples"
    return f"{value:z.{DIGITS[unit]}f} {unit}"


def readable(value: float | None, unit: str) -> str:
    """Write a value with a unit of its size and three digits: `6.43 mm`; a longer one in metres."""
    if value == 0 and unit in SHORT:
        return f"0 {SCALED[unit]}"
    if value is None or abs(value) >= SHORT.get(unit, 0.0):
        return format_value(value, unit).replace("-", "−")
    smaller = SCALED[unit] if abs(value) >= 1e-5 else MICRO[unit]
    return scaled_value(value, smaller).replace("-", "−")


def six_digits(value: float | None, unit: str) -> str:
    """Return a value with up to six significant digits and its unit."""
    if value is None:
        return NOT_OBSERVED
    text = str(value) if isinstance(value, int) else f"{value:.6g}"
    return text if unit == "1" else f"{text} {unit}"


def quoted(value: object) -> str:
    """Return any value as text for a message: a float with six digits, long text shortened."""
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list | tuple):
        value = ", ".join(str(item) for item in value)
    text = str(value) or "nothing"
    if re.fullmatch("[0-9a-f]{64}", text):
        return f"{text[:12]}…"
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}…"


def blocks(titled: Mapping[str, Iterable[str]]) -> str:
    """Return sentences by title, each as a Markdown list under its bold title."""
    return "\n".join(f"**{title}**\n\n{bullets(of)}\n" for title, of in titled.items())


def bullets(sentences: Iterable[str]) -> str:
    """Return sentences as a Markdown list."""
    return "\n".join(f"- {sentence}" for sentence in sentences)


def listed(words: Sequence[str]) -> str:
    """Return words as a list in prose: `a, b and c`."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


def signed(value: float, digits: int) -> str:
    """Return a difference with its sign and a number of digits after the point; `0` if it is 0."""
    return f"{value:+.{digits}f}".replace("-", "−") if value else "0"


def decimal(value: float, digits: int) -> str:
    """Return a value with digits after the point; the minus sign is U+2212, and zero has none."""
    return f"{value:z.{digits}f}".replace("-", "−")


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a value with its unit, written as by `decimal`."""
    return f"{decimal(value, digits)} {unit}"


def time_digits(dt: float) -> int:
    """Return the number of digits after the point of times k · `dt` [s], at least two."""
    return next((n for n in (2, 3, 4, 5) if abs(round(dt, n) - dt) < 1e-9), 6)


def printable(text: str) -> str:
    r"""Return text as one line that a terminal shows and does not obey.

    Line breaks, control characters, reversed directions and other invisible characters
    become escapes such as `\x1b`.
    """
    odd = (c for c in {*text} if not c.isprintable())
    return text.translate({ord(c): c.encode("unicode_escape").decode() for c in odd})
