"""Tables of the page on rates, each a function of the experiment."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l08 import edge, metrics, rates, spec
from robo_genesis.lessons.l08.edge_checks import pairs
from robo_genesis.lessons.l08.text import rate

MEASURES = False


@tables.as_table
def pair_table(run: Experiment) -> Iterator[dict[str, Any]]:
    """Return the outcomes of both experts at the first starts, and p of the paired test."""
    for n in (16, 32, 64, edge.PAIRS):
        both, alone, worse, none = pairs(run, n)
        plain, other = (rate(k, n)["95 % interval [%]"] for k in (both + worse, both + alone))
        yield {
            "starts": n, "plain [%]": plain, "corrected [%]": other, "both": both,
            "only corrected": alone, "only plain": worse, "none": none,
            "p": f"{rates.paired(alone, worse):.2g}",
        }  # fmt: skip


@tables.as_table
def side_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return successes by the error along the pads, before any correction."""
    along = 1000 * (run.cases["plain"].beliefs - run.cases["plain"].starts)[:, 0]
    edges = np.array([-np.inf, -8, -4, 0, 4, 8, np.inf])
    for low, high in pairwise(edges):
        own = (along >= low) & (along < high)
        words = f"from {low:g} to {high:g}".replace("from -inf to", "below")
        yield {"noise [mm]": words.replace(" to inf", " on").replace("-", "−")} | {
            spec.LABELS[n]: f"{metrics.good(run.traces[n], run.cases[n])[own].sum()} of {own.sum()}"
            for n in ("plain", "corrected")
        }
