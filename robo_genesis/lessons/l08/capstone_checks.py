"""Named checks of the capstone, and tests of the functions that a student writes there."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.core.checks import (
    Finding,
    Findings,
    above,
    at_most,
    below,
    equal,
    within,
)
from robo_genesis.core.exercises import Written, as_test, same_array, with_functions
from robo_genesis.core.experiment import (
    Experiment,
    MeasuringPage,
    counts,
    inputs,
    runs_of,
)
from robo_genesis.core.trace import Episodes, Trace
from robo_genesis.sim.arm.franka import JOINT_NAMES, MODEL_COUNTS
from robo_genesis.sim.arm.picking import PickCase
from robo_genesis.sim.common_checks import posture, stamps, structure

from . import capstone, checks, metrics, spec

MEASURES = False

# The rungs of L07's ladder.
SCENE = ("built", "stable", "seen", "reachable", "graspable")

FEWEST = 64  # Starts of each run
PART = (
    1 / 8
)  # Least share of episodes that succeed, and that fail; most wrong predictions
LARGEST = 0.04  # Largest error of a camera [m]
SMALLEST = 1e-3  # A smaller error does not count [m]


def rungs(passed: Mapping[str, float]) -> Findings:
    """Require all rungs of a scene."""
    for name in SCENE:
        yield equal(name, int(passed[name]), 1)


def one_change(name: str, own: PickCase, case: PickCase) -> Findings:
    """Require one other setting than in `own`, not the starts, and a quarter of its errors."""
    changed = capstone.settings_changed(own, case)
    single = len(changed) == 1 and changed != ["starts"]
    yield Finding(f"{name}.changed", changed, single, "one setting, not the starts")
    left, had = (
        np.median(np.abs(of.beliefs - of.starts).max(axis=1)) for of in (case, own)
    )
    yield above(f"{name}.usual_error_m", left, had / 4)


def new_starts(own: PickCase, other: PickCase) -> Findings:
    """Require at least 64 starts, each of them farther than 0.1 mm from all others of a case."""
    yield above("starts", len(other.starts), FEWEST - 1)
    starts = np.concatenate([own.starts, other.starts])
    apart = np.linalg.norm(starts[:, None] - starts, axis=2)
    np.fill_diagonal(apart, np.inf)
    yield above("distance of two starts [m]", apart.min(), 1e-4)


def few_wrong(wrong: float, good: np.ndarray) -> Findings:
    """Require few wrong predictions, and half as many as if all were predicted alike.

    Both outcomes have to occur, or the rule is not tested.
    """
    yield within("success", good.sum(), len(good) / 2, (0.5 - PART) * len(good))
    yield at_most("wrong predictions", wrong, PART * len(good))
    yield at_most("twice the wrong ones", 2 * wrong, min(good.sum(), (~good).sum()))


@as_test
def scene(my_object: Written, passed: Mapping[str, float]) -> Findings:
    """Check `my_object()`: not the cylinder of L07 and L08, and a scene with all rungs."""
    other = replace(spec.EXACT, **my_object())
    same = (other.shape, other.size) == (spec.EXACT.shape, spec.EXACT.size)
    yield equal("the course's cylinder", same, False)
    yield from rungs(passed)


@as_test
def sees(camera: Written) -> Findings:
    """Check `camera(places)`: believed places (e, 2), with errors of a possible size."""
    places = spec.starts(4, seed=9)
    found = camera(places)
    yield from same_array("believed places", found, places, LARGEST)
    yield from same_array("the same places again", camera(places), found, 0.0)
    yield above("largest error [m]", np.abs(found - places).max(), SMALLEST)


@as_test
def change(function: Written, own: PickCase) -> Findings:
    """Check a function that returns a case with one change."""
    yield from one_change("case", own, function(own))


@as_test
def renewed(attack: Written, own: PickCase) -> Findings:
    """Check `attack(case)`: a case with new starts."""
    yield from new_starts(own, attack(own))


@as_test
def rule(fails: Written, case: PickCase, trace: Episodes) -> Findings:
    """Check `fails(case)`: predicted failures (e,) of episodes that it was not made from."""
    good = metrics.good(trace, case)
    found = np.asarray(fails(case))
    yield equal("type and shape", f"{found.dtype} {found.shape}", f"bool {good.shape}")
    yield from few_wrong((found == good).sum(), good)


def scene_passes(run: Experiment) -> Findings:
    """The scene with the chosen object passes the five rungs of L07's ladder."""
    yield from rungs(run.readings["ladder"])


def something_to_explain(run: Experiment) -> Findings:
    """Of at least 64 episodes, at least one in eight succeeds, and one in eight fails."""
    n, good = len(run.cases["own"].starts), run.metrics["own"].resting
    yield above("own.starts", n, FEWEST - 1)
    yield within("own.success", good, n / 2, (0.5 - PART) * n)


def changes_are_single(run: Experiment) -> Findings:
    """Without the cause, and without the other possible cause, one setting differs and the
    starts are equal; the starts of the last run are new.
    """
    own, cause, rival, attack = (run.cases[name] for name in capstone.CASES)
    yield from one_change("without_cause", own, cause)
    yield from one_change("without_rival", own, rival)
    yield from new_starts(own, attack)


def cause_is_removed(run: Experiment) -> Findings:
    """Without the cause more episodes succeed than before, and than without the other possible
    cause: on the same starts, by McNemar's test with p below 0.05.
    """
    own, cause, rival = (
        metrics.good(run.traces[name], run.cases[name])
        for name in ("own", "without_cause", "without_rival")
    )
    for name, other in (("own", own), ("without_rival", rival)):
        more, less = (cause & ~other).sum(), (other & ~cause).sum()
        yield above(f"{name}.only_without_cause", more, less)
        yield below(f"{name}.p", statistics.paired(int(more), int(less)), 0.05)


def rule_predicts(run: Experiment) -> Findings:
    """Of the episodes with new starts, one in eight succeeds at least, and one in eight fails.
    The rule predicts at most one in eight wrongly, and at most half as many as if all
    outcomes were predicted alike.
    """
    good = metrics.good(run.traces["attack"], run.cases["attack"])
    yield from few_wrong(run.readings["rule"]["wrong"], good)


CHECKS = (
    structure,
    stamps,
    checks.laws_of_motion,
    posture,
    scene_passes,
    something_to_explain,
    changes_are_single,
    cause_is_removed,
    rule_predicts,
)

CAPSTONE: MeasuringPage = with_functions(
    MeasuringPage(
        runs=runs_of(
            {"first": capstone.CASES["own"].episode(0)},
            False,
            "the first episode of `own`, at all its steps",
            Trace,
        )
        | runs_of(capstone.CASES),
        kind=Episodes,
        joints=JOINT_NAMES,
        readings={
            "model": counts(MODEL_COUNTS),
            "ladder": counts(SCENE),
            "rule": counts(("wrong",)),
        },
        measure=capstone.attempt_metrics,
        checks=CHECKS,
        parameters=lambda: inputs(CAPSTONE.cases, spec.VIEW, counted=[*MODEL_COUNTS]),
    ),
    "my_object",
    "camera",
    "fails",
    "without_cause",
    "without_rival",
    "attack",
)
