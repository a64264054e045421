"""What commands cost, held against bare ones: samples in turn, medians, a table and a record."""

import json
import os
import platform
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from robo_genesis import project

Say = Callable[[str], None]


class BenchError(Exception):
    """A command failed or did not do what is measured; the message says which and why."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One run of a command: elapsed and processor seconds; `cpu` None where a run is a part."""

    wall: float
    cpu: float | None = None


Pair = tuple[Sample, Sample]


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table: what is measured, against what, and the ratio it must not exceed.

    Without a limit, a row states what both sides cost, and nothing is asked of it.

    `pairs` takes a number of runs, makes ready what they need, which is not measured, and yields
    one sample of the work and one of its opponent for each. `runs` is their usual number.
    `where` says what the time goes to, for a table in which the limit is not kept.
    """

    name: str
    work: str
    against: str
    limit: float | None
    pairs: Callable[[int], Iterable[Pair]]
    runs: int = 5
    where: str = ""


@dataclass(frozen=True, slots=True)
class Result:
    """The samples of both sides of a row, taken in turn."""

    name: str
    work: str
    against: str
    limit: float | None
    samples: tuple[Sample, ...]
    opposite: tuple[Sample, ...]
    where: str = ""

    @property
    def medians(self) -> tuple[float, float]:
        """Elapsed seconds of work and opponent."""
        work, against = (
            statistics.median(sample.wall for sample in side)
            for side in (self.samples, self.opposite)
        )
        return work, against

    @property
    def ratio(self) -> float:
        """Median of the work over median of its opponent."""
        work, against = self.medians
        return work / against

    @property
    def cpu_ratio(self) -> float | None:
        """The same of processor seconds, which neighbours on the machine disturb less."""
        sides = ([s.cpu for s in side if s.cpu] for side in (self.samples, self.opposite))
        work, against = (statistics.median(side) if side else None for side in sides)
        return work / against if work and against else None

    @property
    def met(self) -> bool:
        """Whether the ratio keeps to the limit, if there is one."""
        return self.limit is None or self.ratio <= self.limit


def in_turn(work: Callable[[], Sample], against: Callable[[], Sample], runs: int) -> Iterator[Pair]:
    """Yield a sample of each side, in turn, so that a slow minute of the machine hits both."""
    for _ in range(runs):
        yield work(), against()


def take(row: Row, runs: int | None, say: Say) -> Result:
    """Measure a row.

    Args:
        row: what to measure.
        runs: of each side, None for the row's usual number.
        say: told of each pair.

    Raises:
        BenchError: a command failed.
    """
    runs, pairs = runs or row.runs, list[Pair]()
    for pair in row.pairs(runs):
        pairs.append(pair)
        one, other = (sample.wall for sample in pair)
        say(f"{row.name}  {len(pairs)} of {runs}: {one:.3g} s against {other:.3g} s")
    samples, opposite = zip(*pairs, strict=True)
    return Result(row.name, row.work, row.against, row.limit, samples, opposite, row.where)


def table(results: Sequence[Result]) -> str:
    """Return the results as a table of text; least and most stand behind each median.

    Below it stands for each limit that is not kept where the time goes, where that is known.
    """
    seconds = "s (least-most)"
    head = ("work", seconds, "against", seconds, "ratio", "of CPU", "limit", "", "runs")
    lines = [head, *map(_line, results)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    aligned = [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    ]
    aligned.insert(1, "-" * max(map(len, aligned)))
    reasons = [f"{one.work}: {one.where}" for one in results if one.where and not one.met]
    return "\n".join([*aligned, *reasons])


def _line(result: Result) -> tuple[str, ...]:
    work, against = (_spread(side) for side in (result.samples, result.opposite))
    cpu = f"{result.cpu_ratio:.2f}" if result.cpu_ratio else "-"
    met = "met" if result.met else "NOT MET"
    held = ("-", "") if result.limit is None else (f"{result.limit:g}", met)
    figures = (f"{result.ratio:.2f}", cpu, *held, str(len(result.samples)))
    return (result.work, work, result.against, against, *figures)


def _spread(side: Sequence[Sample]) -> str:
    walls = [sample.wall for sample in side]
    return f"{statistics.median(walls):.3g} ({min(walls):.3g}-{max(walls):.3g})"


def machine(root: Path = project.ROOT) -> dict[str, Any]:
    """Return what the figures depend on: machine, versions, date and how busy it is now."""
    return {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "engine": project.engine_pin(root),
        "lock": project.lock_digest(root),
        "python": platform.python_version(),
        "cores": os.cpu_count(),
        "machine": platform.machine(),
        "load_average": [round(load, 2) for load in os.getloadavg()],
    }


def record(results: Sequence[Result], facts: dict[str, Any]) -> dict[str, Any]:
    """Return results and facts as JSON values, the figures that follow from samples included."""
    return {**facts, "rows": [_recorded(result) for result in results]}


def _recorded(result: Result) -> dict[str, Any]:
    names = ("medians", "ratio", "cpu_ratio", "met")
    return asdict(result) | {name: getattr(result, name) for name in names}


def keep(path: Path, values: dict[str, Any]) -> Path:
    """Write JSON values to a file in one move, and return the file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_suffix(".tmp")
    fresh.write_text(json.dumps(values, indent=1) + "\n", "utf8")
    return fresh.replace(path)


def chosen(names: str, known: Sequence[str]) -> list[str]:
    """Return the names that a list asks for, separated by spaces or commas; all if it is empty.

    Raises:
        BenchError: one of them is not known; the message lists those that are.
    """
    asked = names.replace(",", " ").split()
    for name in asked:
        if name not in known:
            raise BenchError(f"ROWS names {name!r}. Choices: {', '.join(known)}.")
    return asked or list(known)
