"""Measure what the course's commands cost against bare ones: `make bench`.

Environment: ROWS (names of rows, all where it is not set) and RUNS (of each side of each row). It
works in a copy of the checkout; nothing else should run beside it. The table is printed and kept in
`.bench/latest.json`. Exit status: 0 measured, whether the limits were kept or not, 1 a command
failed, 130 interrupted.
"""

import os
import shutil
import sys
from functools import partial

from robo_genesis import bench, bench_clone, bench_rows, kept, project
from robo_genesis.build import Progress
from robo_genesis.command import as_published, run
from robo_genesis.pages import PageError
from robo_genesis.project import CACHE, ROOT, ProjectError

LATEST = ROOT / ".bench" / "latest.json"


def measured() -> list[str]:
    """Measure the rows that were asked for, and return table, peak memory and where both are."""
    runs, say = asked_runs(), partial(Progress(partial(print, flush=True)), "bench")
    folder = CACHE / "bench"
    clone = bench_clone.Clone(folder / "work", folder / "logs")
    known = [row.name for row in bench_rows.rows(clone)]
    names = bench.chosen(os.environ.get("ROWS") or "", [*known, bench_rows.MEMORY])

    facts, results, last = bench.machine(), list[bench.Result](), list[str]()
    try:
        bench_clone.make_clone(ROOT, CACHE, folder, say)
        for row in bench_rows.rows(clone):
            if row.name in names:
                results.append(bench.take(row, runs, say))
                kept.keep(LATEST, bench.record(results, facts))  # a later row may fail
        if bench_rows.MEMORY in names:
            say(f"{bench_rows.MEMORY}  a build that executes all pages")
            peak = bench_rows.peak_of_full_build(clone)
            facts[bench_rows.MEMORY] = {"peak": peak, "limit": bench_rows.MEMORY_LIMIT}
            last = [memory_line(peak)]
    finally:
        for own in ("work", "bare", "executed"):  # logs stay
            shutil.rmtree(folder / own, ignore_errors=True)
    facts["load_average_after"] = bench.machine()["load_average"]
    file = kept.keep(LATEST, bench.record(results, facts))
    return [
        *([bench.table(results)] if results else []),
        *last,
        machine_line(facts),
        f"Kept: {file}",
    ]


def asked_runs() -> int | None:
    """Return RUNS, None where it is not set.

    Raises:
        BenchError: it is no positive number.
    """
    value = os.environ.get("RUNS") or None
    if value is not None and not (value.isdecimal() and int(value) > 0):
        raise bench.BenchError(f"RUNS={value!r} is not valid. Give a number from 1.")
    return int(value) if value else None


def memory_line(peak: int) -> str:
    """Say how much memory a full build held."""
    limit = bench_rows.MEMORY_LIMIT
    met = "met" if peak <= limit else "NOT MET"
    return (
        f"Peak memory of a build that executes all pages with JOBS=2: {peak / 2**30:.2f} GiB, "
        f"limit {limit / 2**30:g} GiB: {met}"
    )


def machine_line(facts: dict[str, object]) -> str:
    """Say on what was measured, and how busy it was."""
    return (
        f"{project.ENGINE} {facts['engine']}, lock {str(facts['lock'])[:12]}, Python "
        f"{facts['python']}, {facts['cores']} cores; load average before {facts['load_average']}, "
        f"after {facts['load_average_after']}"
    )


def main() -> int:
    """Measure and return the exit status."""
    as_published()
    return run(measured, "kept", (bench.BenchError, PageError, ProjectError))


if __name__ == "__main__":
    sys.exit(main())
