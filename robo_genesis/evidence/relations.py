"""The orderings between cases that a lesson claims, held in two runs, flipped, or not decidable."""

from collections.abc import Iterator, Mapping, Sequence

from robo_genesis.comparison import HELD_BY, order
from robo_genesis.evidence.bundle import Metric
from robo_genesis.evidence.findings import (
    DIFFERS,
    EQUAL,
    INCONCLUSIVE,
    Finding,
    Relation,
    Side,
    Specification,
    number,
)

HELD, WITHIN_MARGIN, BROKEN = "held", "within the margin", "broken"


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
        allowed = f"margin {number(margin, units[0] if units else '1')}"
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


def outcome(numbers: Mapping[str, Metric], relation: Relation) -> tuple[str, str]:
    """Return whether one run holds an ordering, and the two values it is read from.

    Two values within the margin of each other show nothing, unless the claim is "no later" and the
    second is not later at all.
    """
    (first, second), metric, claim, margin = relation
    a, b = (numbers.get(f"{case}.{metric}") for case in (first, second))
    if a is None or b is None:
        return WITHIN_MARGIN, f"{first} or {second} is missing"
    text = f"{first} {number(a.value, a.unit)}, {second} {number(b.value, b.unit)}"
    resolved, exact = (order(a.value, b.value, room) for room in (margin, 0))
    if claim == "no later" and exact in HELD_BY[claim]:
        return HELD, text
    if resolved in (None, "equal"):
        return WITHIN_MARGIN, text
    return (HELD if resolved in HELD_BY[claim] else BROKEN), text
