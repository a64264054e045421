"""Tables of L08, each a function of the experiment."""

from collections.abc import Iterator
from typing import Any

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l08 import metrics, rates, spec

MEASURES = False

WORDS = {
    "finished": "all phases done", "raised_once": "lifted at some time",
    "in_bowl": "in the bowl at the end", "resting": "all seven rungs",
}  # fmt: skip
"""Definitions of success, from the most careless on."""


def rate(successes: float, of: int) -> dict[str, str]:
    """Return a rate with its interval as columns of a table."""
    low, high = rates.wilson(successes, of)
    return {
        "episodes": f"{successes:.0f} of {of}", "rate [%]": f"{100 * successes / of:.1f}",
        "95 % interval [%]": f"{100 * low:.1f} to {100 * high:.1f}",
    }  # fmt: skip


@tables.as_table
def words_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return what each definition of success counts in the same episodes."""
    for name, words in WORDS.items():
        count = getattr(run.metrics["askew"], name)
        yield {"success means": words} | rate(count, len(spec.STARTS))


@tables.as_table
def rung_table(run: Experiment) -> Iterator[dict[str, Any]]:
    """Return by rung how many episodes reach it, and how many fail there first."""
    left = len(spec.STARTS)
    for rung in metrics.RUNGS:
        exact, askew = (int(getattr(run.metrics[name], rung)) for name in spec.COUNTED)
        yield {"rung": rung, spec.LABELS["exact"]: exact, spec.LABELS["askew"]: askew,
               "of these fail here first": left - askew}  # fmt: skip
        left = askew


@tables.as_table
def rate_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return the rates of success with their intervals."""
    for name in spec.COUNTED:
        of = len(spec.BATCHES[name].starts)
        yield {"expert": spec.LABELS[name]} | rate(run.metrics[name].resting, of)
