"""How far a stepped fall is from continuous free fall as the solver step shrinks."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.checks import Finding, factors, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.free_fall import ahead_of_continuous
from robo_genesis.core.scene import FloatArray
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.metrics import DropMetrics
from robo_genesis.sim.bodies.rigid_bodies import Drop


@dataclass(frozen=True, slots=True)
class StepStudy:
    """Cases that differ in substeps alone, from the largest solver step `h` [s] to the smallest.

    `gaps` and `expected` are how much farther than g t² / 2 the box fell [m], as measured and
    by g h t / 2; all arrays are (k,).
    """

    names: tuple[str, ...]
    h: FloatArray
    gaps: FloatArray
    expected: FloatArray


def step_study(metrics: Mapping[str, DropMetrics], cases: Mapping[str, Drop]) -> StepStudy:
    """Order the cases by their solver step.

    Raises:
        KeyError: a case has no metrics.
    """
    names = tuple(sorted(cases, key=lambda name: -cases[name].h))
    gaps = [metrics[name].continuous_gap for name in names]
    expected = [
        ahead_of_continuous(cases[name].h, metrics[name].duration, cases[name].gravity)
        for name in names
    ]
    h = [cases[name].h for name in names]
    return StepStudy(names, np.array(h), np.array(gaps), np.array(expected))


def one_factor(run: Experiment) -> Iterator[Finding]:
    """The cases differ in their substeps alone."""
    first, *others = step_study(run.metrics, run.cases).names
    return factors(run.cases, {(first, name): ["substeps"] for name in others})


def shrinks(run: Experiment) -> Iterator[Finding]:
    """The gap to continuous free fall is smaller with every smaller solver step."""
    study = step_study(run.metrics, run.cases)
    for (_, larger), (name, gap) in itertools.pairwise(zip(study.names, study.gaps, strict=True)):
        expected = f"between 0 and {larger:g}"
        yield Finding(f"{name}.gap_m", gap, bool(0 < gap < larger), expected)


def first_order(run: Experiment) -> Iterator[Finding]:
    """The gap is g h t / 2, so half the solver step leaves half of it."""
    study = step_study(run.metrics, run.cases)
    for name, gap, expected in zip(study.names, study.gaps, study.expected, strict=True):
        yield within(f"{name}.gap_m", gap, expected, spec.FIRST_ORDER_SHARE * expected)


CHECKS = (one_factor, shrinks, first_order)


def rows(
    study: StepStudy, metrics: Mapping[str, DropMetrics], cases: Mapping[str, Drop]
) -> Sequence[dict[str, str]]:
    """Return one row per case, for a table on a page."""
    return [
        {
            "substeps": str(cases[name].substeps),
            "h [ms]": f"{1000 * h:g}",
            "measured drop [m]": f"{metrics[name].drop:.6f}",
            "farther than g t² / 2 [mm]": f"{1000 * gap:.3f}",
            "g h t / 2 [mm]": f"{1000 * expected:.3f}",
        }
        for name, h, gap, expected in zip(
            study.names, study.h, study.gaps, study.expected, strict=True
        )
    ]
