"""How far a stepped fall is from continuous free fall as the solver step shrinks."""

import itertools
from collections.abc import Iterator

from robo_genesis.core.checks import Finding, factors, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l02 import spec
from robo_genesis.sim.bodies.free_fall import ahead_of_continuous


def by_step(run: Experiment) -> list[str]:
    """Return the names of the runs, from the largest solver step to the smallest."""
    return sorted(run.cases, key=lambda name: -run.cases[name].h)


def expected_gap(run: Experiment, name: str) -> float:
    """Return g h t / 2: how much farther than g t² / 2 the body of a run falls [m]."""
    case = run.cases[name]
    return float(ahead_of_continuous(case.h, run.metrics[name].duration, case.gravity))


def one_factor(run: Experiment) -> Iterator[Finding]:
    """The cases differ in their substeps alone."""
    first, *others = by_step(run)
    return factors(run.cases, {(first, name): ["substeps"] for name in others})


def shrinks(run: Experiment) -> Iterator[Finding]:
    """The gap to continuous free fall is smaller with every smaller solver step."""
    for coarse, fine in itertools.pairwise(by_step(run)):
        larger, gap = (run.metrics[name].continuous_gap for name in (coarse, fine))
        yield Finding(
            f"{fine}.gap_m", gap, 0 < gap < larger, f"between 0 and {larger:g}"
        )


def first_order(run: Experiment) -> Iterator[Finding]:
    """The gap is g h t / 2, so half the solver step leaves half of it."""
    for name in by_step(run):
        gap, expected = run.metrics[name].continuous_gap, expected_gap(run, name)
        yield within(f"{name}.gap_m", gap, expected, spec.FIRST_ORDER_SHARE * expected)


CHECKS = (one_factor, shrinks, first_order)
