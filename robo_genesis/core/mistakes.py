"""Deliberate mistakes: the measured symptom of each, and the curves that show it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from robo_genesis.core.checks import Check
from robo_genesis.core.scene import FloatArray

MEASURES = False

Curves = Mapping[str, tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Failure:
    """The result of one deliberate mistake.

    `shown` is whether its symptom appeared; `evidence` describes the measurement in either case;
    `curves` by label are two arrays (n,); `axis` and `quantity` name what is drawn to the right and
    what is drawn upwards, with their units.
    """

    name: str
    shown: bool
    evidence: str
    curves: Curves = field(default_factory=dict)
    quantity: str = "position [m]"
    axis: str = "time [s]"

    @property
    def check(self) -> Check:
        """The named check that fails if the symptom did not appear."""
        return Check(f"gallery_{self.name}", self.shown, self.evidence)


def refused(call: Callable[[], Any]) -> Exception | None:
    """Return the exception that a call raises, None if it raises none."""
    try:
        call()
    except Exception as error:  # the caller checks its type
        return error
    return None


def quoted(error: Exception | None) -> str:
    """Quote an exception by type and message, or say that there was none."""
    return f"`{type(error).__name__}`: {error}" if error else "No exception was raised."
