"""Tables of L08, each a function of the experiment."""

import numpy as np

from robo_genesis.core import statistics, tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT
from robo_genesis.core.text import decimal, scaled_value
from robo_genesis.sim.throughput import KEPT

from . import creep, metrics, rates, spec
from .creep_checks import share_of
from .rates_checks import pairs

MEASURES = False

# By head of a table and by row, what is counted: a batch and a metric.
RATE_TABLES = {
    "success means": {
        "all phases done": ("askew", "finished"),
        "lifted at some time": ("askew", "raised_once"),
        "in the bowl at the end": ("askew", "in_bowl"),
        "all seven rungs": ("askew", "resting"),
    },
    "expert": {spec.LABELS[name]: (name, "resting") for name in ("exact", "askew")},
    "expert of 128 starts": {
        spec.LABELS[name]: (name, "resting")
        for name in ("plain", "corrected", "compensated", "elliptic")
    },
    "counted": {
        "all phases done": ("boxes", "finished"),
        "horizontally in the bowl": ("boxes", "over_bowl"),
        "all seven rungs": ("boxes", "resting"),
        "hanging in the hand": ("boxes", "hanging"),
    },
}


def rate(successes: float, of: int) -> dict[str, str]:
    """Return a rate with its interval as columns of a table."""
    low, high = statistics.wilson(successes, of)
    return {
        "episodes": f"{successes:.0f} of {of}",
        "rate [%]": f"{100 * successes / of:.1f}",
        "95 % interval [%]": f"{100 * low:.1f} to {100 * high:.1f}",
    }


def rate_table(run: Experiment, head: str) -> str:
    """Return the rates of a table of `RATE_TABLES`, with their intervals."""
    return tables.markdown(
        [
            {head: words}
            | rate(getattr(run.metrics[batch], name), len(run.cases[batch].starts))
            for words, (batch, name) in RATE_TABLES[head].items()
        ]
    )


@tables.as_table
def rung_table(run: Experiment) -> tables.Rows:
    """Return by rung how many episodes reach it, and how many fail there first."""
    left = len(spec.STARTS)
    for rung in metrics.RUNGS:
        exact, askew = (
            int(getattr(run.metrics[name], rung)) for name in ("exact", "askew")
        )
        yield {
            "rung": rung,
            spec.LABELS["exact"]: exact,
            spec.LABELS["askew"]: askew,
            "of these fail here first": left - askew,
        }
        left = askew


def attempt_table(run: Experiment, *names: str) -> str:
    """Return the rates of runs with their intervals, and how many episodes fail first where."""
    rows = []
    for name in names:
        level = metrics.reached(run.traces[name], run.cases[name])
        good = rate((level == len(metrics.RUNGS)).sum(), len(level))
        lost = {of: (level == k).sum() for k, of in enumerate(metrics.RUNGS)}
        words = ", ".join(f"{n} {of}" for of, n in lost.items() if n)
        rows.append({"run": spec.LABELS[name], **good, "fail first at": words or "–"})
    return tables.markdown(rows)


@tables.as_table
def pair_table(run: Experiment) -> tables.Rows:
    """Return the outcomes of both experts at the first starts, and p of the paired test."""
    for n in (16, 32, 64, rates.PAIRS):
        both, alone, worse, none = pairs(run, n)
        plain, other = (
            rate(k, n)["95 % interval [%]"] for k in (both + worse, both + alone)
        )
        yield {
            "starts": n,
            "plain [%]": plain,
            "corrected [%]": other,
            "both": both,
            "only corrected": alone,
            "only plain": worse,
            "none": none,
            "p": f"{statistics.paired(alone, worse):.2g}",
        }


# Ranges of the noise, between −8, −4, 0, 4 and 8 mm.
NOISE = (
    "below −8",
    "from −8 to −4",
    "from −4 to 0",
    "from 0 to 4",
    "from 4 to 8",
    "from 8 on",
)


@tables.as_table
def side_table(run: Experiment) -> tables.Rows:
    """Return successes by the error along the pads, before any correction."""
    along = 1000 * (run.cases["plain"].beliefs - run.cases["plain"].starts)[:, 0]
    part = np.digitize(along, (-8, -4, 0, 4, 8))
    good = {
        n: metrics.good(run.traces[n], run.cases[n]) for n in ("plain", "corrected")
    }
    for k, words in enumerate(NOISE):
        own = part == k
        yield {"noise [mm]": words} | {
            spec.LABELS[name]: f"{of[own].sum()} of {own.sum()}"
            for name, of in good.items()
        }


@tables.as_table
def pace_table(run: Experiment) -> tables.Rows:
    """Return how long cylinders are held at each speed of the arm, and how far they slide."""
    found = (
        of.reshape(len(rates.STRIDES), -1) for of in metrics.slides(run.traces["paced"])
    )
    for stride, seconds, slid in zip(rates.STRIDES, *found, strict=True):
        yield {
            "command, at most [rad/s]": decimal(stride / DT, 1),
            "held [s]": decimal(np.median(seconds), 1),
            "slid [mm]": decimal(1000 * np.median(slid), 2),
            "slid per second [mm/s]": decimal(1000 * np.median(slid / seconds), 2),
        }


@tables.as_table
def creep_changes(run: Experiment) -> tables.Rows:
    """Return what users change, and the share of the creep that it leaves in both engines."""
    for name, (words, other, price) in creep.CHANGES.items():
        shares = {
            head: f"{share_of(run, engine + name, engine + other):z.3f}"
            for head, engine in (("Genesis", ""), ("MuJoCo", "mujoco_"))
        }
        depth = scaled_value(run.metrics[name].depth, "µm").removesuffix(" µm")
        times = {"time [ms]": time_of(run, name), "price": price}
        yield {"change": words} | shares | {"depth [µm]": depth} | times


def time_of(run: Experiment, name: str) -> str:
    """Write median, least and largest time of an outer step of a run's scene, if it is timed."""
    name = "plain_base" if name == "base" else name
    (scene,) = (one for one, cases in creep.SCENES.items() if name in cases)
    if scene not in creep.TIMED:
        return "–"
    step, least, most = (
        f"{1000 * run.readings['step'][f'{of}_{scene}']:.1f}" for of in KEPT
    )
    return f"{step} ({least}–{most})"
