"""Parts of generated sentences: lists, signed numbers, values with units, blocks of sentences."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

MEASURES = False


@dataclass(frozen=True, slots=True)
class Block:
    """A title and its sentences."""

    title: str
    sentences: tuple[str, ...]

    def markdown(self) -> str:
        """Return the block as a Markdown list under a bold title."""
        return "\n".join([f"**{self.title}**", "", *(f"- {s}" for s in self.sentences), ""])


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
    text = f"{value:.{digits}f}"
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "−")


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a value with its unit, written as by `decimal`."""
    return f"{decimal(value, digits)} {unit}"


def time_digits(dt: float) -> int:
    """Return the number of digits after the point of times k · `dt` [s], at least two."""
    return next((n for n in (2, 3, 4, 5) if abs(round(dt, n) - dt) < 1e-9), 6)
