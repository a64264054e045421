"""Checks of the functions that a student writes in L09's lab; see `core/exercises.py`."""

from functools import partial

import numpy as np

from robo_genesis.core import statistics
from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.exercises import Written, as_test, compared, refused, same_array

MEASURES = False


def episode(n: int = 6, seed: int = 1) -> tuple[np.ndarray, ...]:
    """Return positions (n+1, 9), poses (n+1, 7) and commands (n, 9) that all differ."""
    rng = np.random.default_rng(seed)
    return rng.random((n + 1, 9)), rng.random((n + 1, 7)), rng.random((n, 9))


@as_test
def rows(pairs: Written) -> Findings:
    """Check `pairs(q, pose, sent)`: rows (n, 16) of what was seen, and the next commands."""
    for n in (1, 6):
        q, pose, sent = episode(n)
        found = pairs(q, pose, sent)
        yield equal(f"{n}_steps.number_of_values", len(found), 2)
        seen = np.concatenate([q[:-1], pose[:-1]], axis=1)
        yield from same_array(f"{n}_steps.seen", found[0], seen, 0.0)
        yield from same_array(f"{n}_steps.commands", found[1], sent, 0.0)


# Rows in which one column never changes, one hardly, and one by much.
COLUMNS = np.array([[2.0, 0.5, 1.0], [2.0, 0.5 + 1e-5, 3.0], [2.0, 0.5, 8.0]])


@as_test
def scaling(scale: Written) -> Findings:
    """Check `scale(x, learned, least)`: mean and spread of the rows that are learned."""
    for name, used in (
        ("all", np.ones(3, bool)),
        ("two", np.array([True, False, True])),
    ):
        for least in (1e-6, 0.01):
            of = COLUMNS[used]
            mean, spread = of.mean(axis=0), np.maximum(of.std(axis=0), least)
            found = scale(COLUMNS, used, least)
            yield equal(f"{name}.number_of_values", len(found), 2)
            yield from same_array(f"{name}_{least:g}.mean", found[0], mean, 1e-12)
            yield from same_array(f"{name}_{least:g}.spread", found[1], spread, 1e-12)


@as_test
def commands(command: Written) -> Findings:
    """Check `command(output, mean, spread, offset)`: commands (e, 9), fingers shut or open."""
    rng = np.random.default_rng(2)
    output, q = rng.normal(size=(5, 9)), rng.random((5, 9))
    mean, spread = rng.random(9), rng.random(9)
    mean[7:], spread[7:] = 0.026, 0.018
    output[:, 7:] = [[0.4, 0.4], [-0.4, -0.4], [0.1, 2.0], [-3.0, -0.1], [0.2, -0.2]]
    for name, offset in (("command", 0.0), ("difference", 1.0)):
        right = output * spread + mean
        right[:, :7] += offset * q[:, :7]
        right[:, 7:] = np.where(right[:, 7:] < 0.02, 0.0, 0.04)
        found = command(output, mean, spread, offset * q[:, :7])
        yield from same_array(name, found, right, 1e-12)


COUNTS = (
    (np.array([12, 9, 14, 13]), 16),
    (np.array([0, 16]), 16),
    (np.array([3, 3, 3, 4, 3, 3, 3, 3]), 4),
)


@as_test
def rates(rate: Written) -> Findings:
    """Check `rate(good, of)`: mean of the networks' shares, and Student's interval."""
    for good, of in COUNTS:
        right = statistics.of_groups(good / of)
        names = ("mean", "lower", "upper")
        yield from compared(f"{len(good)}_networks", names, rate(good, of), right, 1e-9)
    raised = type(refused(partial(rate, np.array([5]), 16))).__name__
    yield equal("one_network.raises", raised, "ValueError")


@as_test
def answers(aggregate: Written) -> Findings:
    """Check `aggregate(x, y, asked, answers, known)`: rows of both, the known answers last."""
    rng = np.random.default_rng(3)
    x, y, asked, said = (
        rng.random((n, k)) for n, k in ((4, 16), (4, 9), (3, 16), (3, 9))
    )
    for name, known in (
        ("all", [True, True, True]),
        ("some", [True, False, True]),
        ("none", [False] * 3),
    ):
        keep = np.array(known)
        found = aggregate(x, y, asked, said, keep)
        yield equal(f"{name}.number_of_values", len(found), 2)
        right = np.concatenate([x, asked[keep]]), np.concatenate([y, said[keep]])
        yield from same_array(f"{name}.seen", found[0], right[0], 0.0)
        yield from same_array(f"{name}.commands", found[1], right[1], 0.0)
