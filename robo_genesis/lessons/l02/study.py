"""How far a stepped fall is from continuous free fall as the solver's step shrinks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from robo_genesis.core.checks import Check, evaluate
from robo_genesis.core.free_fall import ahead_of_continuous
from robo_genesis.lessons.l02.metrics import DropMetrics
from robo_genesis.sim.rigid_bodies import Drop

SHARE = 0.02
"""What a measured gap and g h t / 2 may differ by, as a share of the gap: at the smallest step the
gap is small and float32 shows."""


@dataclass(frozen=True, slots=True)
class Study:
    """Cases that differ in substeps alone, from the largest solver step h [s] to the smallest.

    `gaps` and `expected` say how much farther than g t² / 2 the box fell, measured and as
    g h t / 2 has it [m]; all are (k,).
    """

    names: tuple[str, ...]
    cases: Mapping[str, Drop]
    h: np.ndarray
    gaps: np.ndarray
    expected: np.ndarray


def study(metrics: Mapping[str, DropMetrics], cases: Mapping[str, Drop]) -> Study:
    """Order the cases by their solver's step.

    Raises:
        KeyError: a case has no metrics.
    """
    names = tuple(sorted(cases, key=lambda name: -cases[name].h))
    h = np.array([cases[name].h for name in names])
    gaps = np.array([metrics[name].continuous_gap for name in names])
    ends = np.array([metrics[name].duration for name in names])
    expected = np.array(
        [
            ahead_of_continuous(cases[name].h, end, cases[name].gravity)
            for name, end in zip(names, ends, strict=True)
        ]
    )
    return Study(names, cases, h, gaps, expected)


def shrinks(found: Study) -> list[str]:
    """The gap to continuous free fall is smaller with every smaller solver step."""
    return [
        f"{after} is {gap:g} m ahead, {before} {larger:g} m"
        for before, after, larger, gap in zip(
            found.names, found.names[1:], found.gaps, found.gaps[1:], strict=False
        )
        if not 0 < gap < larger
    ]


def first_order(found: Study) -> list[str]:
    """The gap is g h t / 2, so half the solver step leaves half of it."""
    return [
        f"{name} is {gap:g} m ahead, expected {wanted:g} m"
        for name, gap, wanted in zip(found.names, found.gaps, found.expected, strict=True)
        if abs(gap - wanted) > SHARE * wanted
    ]


def one_factor(found: Study) -> list[str]:
    """The cases differ in their substeps alone."""
    first = found.cases[found.names[0]]
    return [
        f"{name} differs from {found.names[0]} in more than its substeps"
        for name in found.names
        if replace(found.cases[name], substeps=first.substeps) != first
    ]


def run_checks(metrics: Mapping[str, DropMetrics], cases: Mapping[str, Drop]) -> tuple[Check, ...]:
    """Run the study's checks."""
    return evaluate((one_factor, shrinks, first_order), study(metrics, cases))


def rows(found: Study, metrics: Mapping[str, DropMetrics]) -> Sequence[dict[str, str]]:
    """Return one row a case, for a table on a page."""
    return [
        {
            "run": name,
            "h [ms]": f"{1000 * h:g}",
            "measured drop [m]": f"{metrics[name].drop:.6f}",
            "farther than g t² / 2 [mm]": f"{1000 * gap:.3f}",
            "g h t / 2 [mm]": f"{1000 * wanted:.3f}",
        }
        for name, h, gap, wanted in zip(
            found.names, found.h, found.gaps, found.expected, strict=True
        )
    ]
