"""Tables and sentences of L09, each a function of the experiment."""

import numpy as np

from robo_genesis.core import statistics, tables
from robo_genesis.core.exercises import Written
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, decimal

from . import spec
from .metrics import RUNGS, Copies

MEASURES = False


def percent(low: float, high: float) -> str:
    """Return an interval of shares in percent, within 0 and 100."""
    return f"{100 * max(low, 0):.0f} to {100 * min(high, 1):.0f}"


def interval(trace: Copies) -> tuple[float, float]:
    """Return the interval of the mean of the networks.

    If all have the same count it is that of Wilson for all episodes: equal counts show no
    spread.
    """
    shares, good = trace.shares, trace.good
    if np.ptp(shares) == 0:
        return statistics.wilson(int(good.sum()), len(good))
    low, high = statistics.of_groups(shares)[1:]
    return max(low, 0.0), min(high, 1.0)


def rate(trace: Copies) -> dict[str, str]:
    """Return successes and their interval as columns."""
    good = trace.good
    return {
        "success": f"{good.sum()} of {len(good)}",
        "95 % interval [%]": percent(*interval(trace)),
    }


def learned(run: Experiment, name: str) -> dict[str, str]:
    """Return loss and error of a kind as columns."""
    found = run.metrics[name]
    return {
        "loss [%]": decimal(found.loss, 2),
        "error [mrad]": decimal(1000 * found.error, 2),
    }


@tables.as_table
def kind_table(run: Experiment, head: str, *names: str) -> tables.Rows:
    """Return rates of kinds of clones."""
    for name in names:
        yield {head: spec.LABELS[name]} | rate(run.traces[name])


@tables.as_table
def order_table(run: Experiment, head: str, *names: str) -> tables.Rows:
    """Return losses, errors and rates of kinds, the smallest error first."""
    for name in sorted(names, key=lambda one: run.metrics[one].error):
        row = learned(run, name) | rate(run.traces[name])
        yield {head: spec.LABELS[name]} | row


@tables.as_table
def change_table(run: Experiment, head: str, base: str, *names: str) -> tables.Rows:
    """Return losses, errors and rates of kinds, and the difference to another one's rate.

    The interval of a difference is that of the networks' differences: network j of both
    has the same seed and the same starts.
    """
    for name in (base, *names):
        row = {head: spec.LABELS[name]} | learned(run, name) | rate(run.traces[name])
        more = "–"
        if name != base:
            apart = run.traces[name].shares - run.traces[base].shares
            mean, low, high = (100 * of for of in statistics.of_groups(apart))
            more = f"{mean:+.0f} ({low:+.0f} to {high:+.0f})".replace("-", "−")
        yield row | {"difference [points]": more}


@tables.as_table
def network_table(run: Experiment, head: str, *names: str) -> tables.Rows:
    """Return the successes of each network, and how they spread beside those of fair tosses."""
    for name in names:
        trace = run.traces[name]
        good = counts(trace)
        share = good.mean() / spec.EACH
        tosses = spec.EACH * share * (1 - share)
        yield {
            head: spec.LABELS[name],
            f"successes of {spec.EACH}, by network": " ".join(map(str, np.sort(good))),
            "variance": decimal(good.var(ddof=1), 1),
            "variance of tosses": decimal(tosses, 1),
        }


@tables.as_table
def rung_table(run: Experiment, *names: str) -> tables.Rows:
    """Return how many episodes pass each rung and those before it."""
    for rung in RUNGS:
        passed = {
            spec.LABELS[name]: int(getattr(run.metrics[name], rung)) for name in names
        }
        yield {"rung": rung} | passed


def counts(trace: Copies) -> np.ndarray:
    """Return the successes of each network (k,)."""
    return np.asarray(trace.good.reshape(len(trace.weights), -1).sum(axis=1))


def compared(rate: Written, trace: Copies) -> str:
    """Return the rate of clones with its interval, by the student and by the course."""
    good = counts(trace)
    course = float(trace.shares.mean()), *interval(trace)
    lines = [f"successes by network: {good}"]
    for name, found in (("yours", rate(good, spec.EACH)), ("course", course)):
        mean, low, high = found
        lines.append(f"{name:7} {100 * mean:.1f} % ({percent(low, high)} %)")
    return "\n".join(lines)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the clones of the lab."""
    trace, m = run.traces["own"], run.metrics["own"]
    low, high = interval(trace)
    lost = [(trace.rungs == k).sum() for k in range(len(RUNGS))]
    first = RUNGS[int(np.argmax(lost))]
    best, worst = (
        int(spec.EACH * of) for of in (trace.shares.max(), trace.shares.min())
    )
    return bullets(
        [
            f"{m.resting} of {len(trace.rungs)} episodes succeed. The interval of the mean of "
            f"{len(trace.weights)} networks is {percent(low, high)} %.",
            f"The best network succeeds in {best} of {spec.EACH} episodes, the worst in {worst}.",
            f"Most failures are first at “{first}”: {max(lost)}."
            if sum(lost)
            else "No episode fails.",
            f"The last loss is {m.loss:.2f} %, the median error of a command "
            f"{1000 * m.error:.2f} mrad.",
        ]
    )
