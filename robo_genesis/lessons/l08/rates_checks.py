"""Named checks of the page on rates; the docstring of each is its claim."""

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.core.checks import Findings, above, at_most, below, equal, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.picking import CLOSE
from robo_genesis.sim.common_checks import stamps, structure

from . import checks, metrics, rates

MEASURES = False

BAND = 12.5  # Least difference of two counts that is called a difference


def window_of_errors(run: Experiment) -> Findings:
    """Of 256 errors 36 to 60 end well. With at most 14 mm across the pads, all with 2
    to 6 mm along them do, and none from −10 mm down or from 18 mm up. Of those that end
    well, the hand touches 5 or more before the fingers close, among them at least half
    of those with more than 20 mm across.
    """
    case, trace = run.cases["grid"], run.traces["grid"]
    along, across = 1000 * (case.beliefs - case.starts).T
    good, inner = metrics.good(trace, case), np.abs(across) < 15
    early = ((trace.touches == 1) & (trace.phase < CLOSE)).any(axis=0)
    yield within("grid.success", run.metrics["grid"].resting, 48, BAND)
    core = inner & (along > 1) & (along < 7)
    yield equal("core.failed", (~good[core]).sum(), 0)
    yield above("touched_early", (good & early).sum(), 4.5)
    far = good & (np.abs(across) > 20)
    yield above("far.succeeded", far.sum(), 4.5)
    yield at_most("far.untouched", (far & ~early).sum(), (far & early).sum())
    outside = inner & ((along < -9) | (along > 17))
    yield equal("outside.succeeded", good[outside].sum(), 0)


def correction_helps(run: Experiment) -> Findings:
    """The corrected expert succeeds alone at 10 or more starts and fails alone at 8 at
    most, and by the paired test p is below 0.01.
    """
    alone, worse = pairs(run)[1:3]
    yield above("only_corrected", alone, 9.5)
    yield at_most("only_plain", worse, 8)
    yield below("p", statistics.paired(alone, worse), 0.01)


def window_is_centred(run: Experiment) -> Findings:
    """The corrected expert, and the plain one whose robot has no weight, succeed at all
    starts with noise of at most 7 mm along the pads, and at none with more than 9.5 mm
    to either side. Without the weight the pads are within 0.5 mm of the believed place.
    """
    along = (run.cases["plain"].beliefs - run.cases["plain"].starts)[:, 0]
    for name in ("corrected", "compensated"):
        good = metrics.good(run.traces[name], run.cases[name])
        failed = (~good[np.abs(along) <= 7e-3]).sum()
        yield equal(f"{name}.small_noise.failed", failed, 0)
        for side, noise in (("near", -along), ("far", along)):
            yield equal(f"{name}.{side}.succeeded", good[noise > 9.5e-3].sum(), 0)
    yield within("compensated.short_m", run.metrics["compensated"].short, 0, 5e-4)


def cone_is_enough(run: Experiment) -> Findings:
    """With the elliptic cone the plain expert carries each cylinder to the bowl."""
    yield equal("elliptic.carried", run.metrics["elliptic"].carried, rates.PAIRS)


def pairs(run: Experiment, first: int = rates.PAIRS) -> tuple[int, int, int, int]:
    """Return at how many of the first starts both experts succeed, only the corrected
    one, only the plain one, and none.
    """
    cases, traces = run.cases, run.traces
    plain, other = (
        metrics.good(traces[n], cases[n])[:first] for n in ("plain", "corrected")
    )
    both, alone = int((plain & other).sum()), int((other & ~plain).sum())
    return both, alone, int((plain & ~other).sum()), int((~plain & ~other).sum())


def clock_hides_failure(run: Experiment) -> Findings:
    """All episodes finish all phases. With the shortest clock none succeeds; with the
    longest one and with the measured end all do.
    """
    good = metrics.good(run.traces["timed"], run.cases["timed"]).reshape(
        len(rates.CLOCKS), -1
    )
    yield equal("timed.finished", run.metrics["timed"].finished, good.size)
    yield equal("shortest.success", good[0].sum(), 0)
    for row, words in ((-2, "longest"), (-1, "measured")):
        yield equal(f"{words}.success", good[row].sum(), rates.TIMED)


def slower_slides_farther(run: Experiment) -> Findings:
    """At each of three speeds all 16 episodes end well. From each start, a slower arm
    lets the cylinder slide farther. The medians of the slide per second differ by less
    than a tenth.
    """
    seconds, slid = (
        of.reshape(len(rates.STRIDES), -1) for of in metrics.slides(run.traces["paced"])
    )
    yield equal("paced.success", run.metrics["paced"].resting, slid.size)
    yield above("slower.least_further_slide_m", np.diff(slid, axis=0).min(), 0)
    rates_of = np.median(slid / seconds, axis=1)
    yield below("slide_per_second.spread", np.ptp(rates_of) / rates_of.min(), 0.1)


def hovering_is_a_trap(run: Experiment) -> Findings:
    """At least 13 boxes more are over the bowl at the end than succeed, and at least 10
    of them hang above the rim in the hand. At least 95 % of the episodes finish all
    phases.
    """
    m = run.metrics["boxes"]
    yield above("boxes.over_bowl", m.over_bowl, m.resting + BAND)
    yield above("boxes.hanging", m.hanging, 9.5)
    yield above("boxes.finished", m.finished, 0.95 * rates.PAIRS)


RATES = (
    structure,
    stamps,
    checks.laws_of_motion,
    checks.nothing_jumps,
    window_of_errors,
    correction_helps,
    window_is_centred,
    cone_is_enough,
    clock_hides_failure,
    slower_slides_farther,
    hovering_is_a_trap,
)
