"""The orderings between cases that a lesson claims, held in two runs, flipped, or not decidable."""

from collections.abc import Iterator, Mapping, Sequence

from robo_genesis.core.orderings import BROKEN, HELD, WITHIN_MARGIN, Relation, outcome
from robo_genesis.core.quantities import six_digits
from robo_genesis.evidence.bundle import Metric
from robo_genesis.evidence.findings import (
    DIFFERS,
    EQUAL,
    INCONCLUSIVE,
    Finding,
    Side,
    Specification,
)


def relations(old: Side, new: Side, spec: Specification) -> Iterator[Finding]:
    """Yield a row for each claimed ordering.

    One that one run holds and the other breaks is flipped; one that both break is no difference
    between them, but the lesson's claim fails, and that is reported as loudly.
    """
    for relation in spec.relations:
        (first, second), metric, claim, margin = relation
        outcomes = [outcome(side.numbers, relation) for side in (old, new)]
        units = [m.unit for side in (old, new) if (m := side.numbers.get(f"{first}.{metric}"))]
        found = {held for held, _ in outcomes}
        if BROKEN in found:
            state, verdict = DIFFERS, "broken in both" if found == {BROKEN} else "flipped"
            if WITHIN_MARGIN in found:
                verdict = "broken in one, undecided in the other"
        elif WITHIN_MARGIN in found:
            state, verdict = INCONCLUSIVE, "inconclusive"
        else:
            state, verdict = EQUAL, "held in both"
        what = f"{metric}: {second} {claim} than {first}, {verdict}"
        old_text, new_text = (f"{held}: {text}" for held, text in outcomes)
        allowed = f"margin {six_digits(margin, units[0] if units else '1')}"
        yield Finding(state, what, old_text, new_text, allowed=allowed)


def not_shown(numbers: Mapping[str, Metric], claimed: Sequence[Relation]) -> list[str]:
    """Return a line for each claimed ordering that one run breaks or leaves undecided.

    Args:
        numbers: the run's metrics by `case.metric`.
        claimed: what the lesson claims.
    """
    lines = []
    for relation in claimed:
        (first, second), metric, claim, _ = relation
        held, values = outcome(numbers, relation)
        if held != HELD:
            lines.append(f"{metric} {claim} in {second} than in {first} is {held} ({values})")
    return lines
