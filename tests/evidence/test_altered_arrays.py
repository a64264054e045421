"""One array of one run of a built bundle altered, and everything that follows from it made right.

The forger keeps the types of data and computes metrics, checks and digests again. A try
is refused if the arrays form no run, a law is broken, or a check fails."""

from collections.abc import Iterator
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
import pytest
from built_site import MEASURING_PAGES, executed_pages

from robo_genesis.core.checks import evaluate
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import ContactTrace, TraceError
from robo_genesis.evidence import bundle
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.lessons.l08 import creep_checks
from robo_genesis.sim.bodies.laws import DEPTH, NEXT

pytestmark = pytest.mark.engine  # the bundles of the built site

LAWS = ("laws_of_motion", "free_fall")
REQUIRED = 0.97  # Share of the tries that must be refused

# Tolerances of the laws of a body on a surface; an array that changes by less is not
# altered.
WITHIN = NEXT | {"penetration": DEPTH}

# Those of held boxes, which hardly move, by lesson and page.
OF_PAGE = {("l08", "creep"): creep_checks.NEXT}

NOISE = "A landed cube turns by less than float32 resolves in a step, so nothing follows from it."
SCHEME = "MuJoCo does not have the engine's resolution of the elliptic cone."
ON_EDGE = "A cube that lands on an edge has other contact points in the two engines."
ROUNDING = "The alteration is no larger than what float32 resolves of a position."
TOUCHING = (
    "A hand or a hull touches the body, and forces of these contacts are in no array."
)
SCALES = ("× 1.02", "× 0.98", "sample", "zero")

# By lesson, array and alteration, why a try may be accepted. No other may.
ACCEPTED = {
    **{
        ("l07", name, how): TOUCHING
        for name in ("link_ang", "link_vel")
        for how in SCALES
    },
    **{
        (of, name, "sample"): TOUCHING
        for of in ("l07", "l08")
        for name in ("internal_force", "link_pos")
    },
    ("l07", "contacts", "sample"): ON_EDGE,
    ("l07", "penetration", "× 1.02"): ROUNDING,
    **{
        ("l03", "link_ang", how): f"{NOISE} {SCHEME}"
        for how in ("× 1.02", "× 0.98", "sample")
    },
    **{("l03", name, "sample"): ON_EDGE for name in ("link_vel", "contacts")},
    ("l03", "penetration", "sample"): ROUNDING,
}


class Try(NamedTuple):
    lesson: str
    page: str
    run: str
    array: str
    how: str
    value: np.ndarray


def alterations(array: np.ndarray, seed: int) -> dict[str, np.ndarray]:
    """Return the altered arrays of the same type, by alteration, without those that are equal."""
    index = tuple(np.random.default_rng(seed).integers(array.shape))
    whole = np.issubdtype(array.dtype, np.integer)
    sample = np.array(array)
    sample[index] += 1 if whole else array.dtype.type(1e-2 * np.ptp(array))
    altered = {
        "× 1.02": np.round(array * 1.02) if whole else array * array.dtype.type(1.02),
        "× 0.98": np.round(array * 0.98) if whole else array * array.dtype.type(0.98),
        "sample": sample,
        "zero": np.zeros_like(array),
    }
    kept = {how: of.astype(array.dtype) for how, of in altered.items()}
    return {how: of for how, of in kept.items() if not np.array_equal(of, array)}


def tries(lesson: str, page: str, experiment: Experiment) -> Iterator[Try]:
    for run, trace in experiment.traces.items():
        within = (
            WITHIN
            if isinstance(trace, ContactTrace)
            else OF_PAGE.get((lesson, page), {})
        )
        for field in fields(trace):
            seed = sum(map(ord, f"{lesson}/{page}/{run}/{field.name}"))
            array = getattr(trace, field.name)
            for how, value in alterations(array, seed).items():
                if np.abs(np.subtract(value, array, dtype=float)).max() > within.get(
                    field.name, 0
                ):
                    yield Try(lesson, page, run, field.name, how, value)


def is_refused(experiment: Experiment, of: Try) -> bool:
    """Whether a bundle with one altered array, made right in all else, is refused."""
    page, trace = experiment.page, experiment.traces[of.run]
    try:
        forged = replace(trace, **{of.array: of.value})
        traces = experiment.traces | {of.run: forged}
        run = replace(experiment, traces=traces)
        # The laws of the other runs do not read the altered one.
        one = replace(run, page=replace(page, runs={of.run: page.runs[of.run]}))
        laws = [check for check in page.checks if check.__name__ in LAWS]
        if not all(check.passed for check in evaluate(laws, one)):
            return True
        run.records()
        claims = [check for check in page.checks if check not in laws]
        return not all(check.passed for check in evaluate(claims, run))
    except (TraceError, BundleRefused, LookupError, ValueError, ArithmeticError):
        return True


@pytest.fixture(scope="module")
def experiments(build_output) -> dict[tuple[str, str], Experiment]:
    """The experiments of the built bundles."""
    found, built = {}, executed_pages()
    for lesson, page in MEASURING_PAGES:
        folder = built.outputs[f"{lesson}/{page}"] / "cpu"
        read = bundle.read_manifest(folder), bundle.read_metrics(folder)
        found[lesson, page] = from_bundle(folder, *read)
    return found


def test_an_altered_array_is_refused(experiments):
    all_tries = [of for page, run in experiments.items() for of in tries(*page, run)]
    accepted = [
        of for of in all_tries if not is_refused(experiments[of.lesson, of.page], of)
    ]
    for_no_reason = [
        of[:5] for of in accepted if (of.lesson, of.array, of.how) not in ACCEPTED
    ]
    assert for_no_reason == []
    assert len(accepted) <= (1 - REQUIRED) * len(all_tries), (
        f"{len(accepted)} of {len(all_tries)}"
    )
