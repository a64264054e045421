"""Tables of L08, each a function of the experiment."""

from collections.abc import Iterator
from typing import Any

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l08 import metrics, rates, spec

MEASURES = False

COUNTED = {
    "success means": {
        "all phases done": ("askew", "finished"),
        "lifted at some time": ("askew", "raised_once"),
        "in the bowl at the end": ("askew", "in_bowl"),
        "all seven rungs": ("askew", "resting"),
    },
    "expert": {spec.LABELS[name]: (name, "resting") for name in spec.COUNTED},
    "counted": {
        "all phases done": ("boxes", "finished"),
        "horizontally in the bowl": ("boxes", "over_bowl"),
        "all seven rungs": ("boxes", "resting"),
        "hanging in the hand": ("boxes", "hanging"),
    },
}
"""By head of a table and by row, what is counted: a batch and a metric."""


def rate(successes: float, of: int) -> dict[str, str]:
    """Return a rate with its interval as columns of a table."""
    low, high = rates.wilson(successes, of)
    return {
        "episodes": f"{successes:.0f} of {of}", "rate [%]": f"{100 * successes / of:.1f}",
        "95 % interval [%]": f"{100 * low:.1f} to {100 * high:.1f}",
    }  # fmt: skip


def rate_table(run: Experiment, head: str) -> str:
    """Return the rates of a table of `COUNTED`, with their intervals."""
    return tables.markdown(
        [
            {head: words} | rate(getattr(run.metrics[batch], name), len(run.cases[batch].starts))
            for words, (batch, name) in COUNTED[head].items()
        ]
    )


@tables.as_table
def rung_table(run: Experiment) -> Iterator[dict[str, Any]]:
    """Return by rung how many episodes reach it, and how many fail there first."""
    left = len(spec.STARTS)
    for rung in metrics.RUNGS:
        exact, askew = (int(getattr(run.metrics[name], rung)) for name in spec.COUNTED)
        yield {"rung": rung, spec.LABELS["exact"]: exact, spec.LABELS["askew"]: askew,
               "of these fail here first": left - askew}  # fmt: skip
        left = askew
