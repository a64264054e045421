"""How the course's cost grows with lessons and bundles: the kept measurement, and what it says."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from robo_genesis import kept

FILE = Path(kept.FOLDER) / "growth.json"
COMMAND = "make growth"


class GrowthError(kept.KeptError):
    """The measurement failed; the message says why."""


class Built(kept.Part):
    """One size of the book: seconds with all pages executed and with none, bytes of the site."""

    lessons: int
    executing: float
    rendering: float
    site: int


class Verified(kept.Part):
    """Seconds of one process that verified so many bundles, its start included."""

    bundles: int
    seconds: float


class Growth(kept.Record):
    """One measurement; both series stand in growing order."""

    built: tuple[Built, ...]
    verified: tuple[Verified, ...]


def read(book: Path) -> Growth | None:
    """Return the kept measurement of a book, None where there is none.

    Raises:
        KeptError: the file is no such record.
    """
    return kept.read(book / FILE, Growth, COMMAND)


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Return the growth of y per unit of x, as the straight line nearest to the points has it."""
    return float(np.polyfit(x, y, 1)[0])


def sentences(found: Growth) -> tuple[str, str, str]:
    """Return a sentence each on build time, on the site's size and on verification."""
    lessons = [b.lessons for b in found.built]
    first, last = found.built[0], found.built[-1]
    executing = slope(lessons, [b.executing for b in found.built])
    rendering = slope(lessons, [b.rendering for b in found.built])
    megabytes = slope(lessons, [b.site / 1e6 for b in found.built])
    bundles = [v.bundles for v in found.verified]
    each = slope(bundles, [v.seconds for v in found.verified])
    return (
        f"From {first.lessons} to {last.lessons} lessons a build that executes every page went "
        f"from {first.executing:.0f} s to {last.executing:.0f} s, about {executing:.0f} s more for "
        f"each lesson; one that executes none went from {first.rendering:.0f} s to "
        f"{last.rendering:.0f} s, about {rendering:.1f} s more for each.",
        f"The site went from {first.site / 1e6:.0f} MB to {last.site / 1e6:.0f} MB, "
        f"{megabytes:.1f} MB more for each lesson.",
        f"A process that verified {found.verified[0].bundles} bundle took "
        f"{found.verified[0].seconds:.1f} s, one that verified {found.verified[-1].bundles} took "
        f"{found.verified[-1].seconds:.1f} s: {1000 * each:.0f} ms more for each.",
    )
