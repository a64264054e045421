"""What a mistake made on purpose leaves: its measured symptom and the curves that show it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from robo_genesis.core.checks import Check
from robo_genesis.core.scene import FloatArray

Curves = Mapping[str, tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class Failure:
    """One failure as it was produced.

    `shown` says whether its symptom appeared; `evidence` tells what was measured, whichever it is;
    `curves` are its traces, label → (time [s], position), both (n,).
    """

    name: str
    shown: bool
    evidence: str
    curves: Curves = field(default_factory=dict)

    @property
    def check(self) -> Check:
        """The named check that a page fails by if the symptom did not appear."""
        return Check(f"gallery_{self.name}", self.shown, self.evidence)


def refused(call: Callable[[], Any]) -> Exception | None:
    """Return the exception that a call raises, None if it raises none."""
    try:
        call()
    except Exception as error:  # which one it is decides the check
        return error
    return None


def quoted(error: Exception | None) -> str:
    """Quote an exception by type and message, or say that there was none."""
    return f"`{type(error).__name__}`: {error}" if error else "No exception was raised."
