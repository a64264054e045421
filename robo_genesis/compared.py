"""What a lesson's pictures and its replay hold against each other.

A lesson that is not here has neither: its recorded runs are shown by their facts and tables alone.
"""

from dataclasses import dataclass

from robo_genesis import l04, l04_studies


@dataclass(frozen=True, slots=True)
class Compared:
    """Cases that are drawn over each other, and the joint that they move."""

    cases: tuple[str, ...]
    joint: str

    @property
    def names(self) -> str:
        """The cases as words: `G1, G2 and G3`."""
        *others, last = self.cases
        return f"{', '.join(others)} and {last}"


COMPARED = {l04.LESSON: Compared(tuple(l04_studies.COMPARED), l04.STEPPED_JOINT)}
"""By lesson."""
