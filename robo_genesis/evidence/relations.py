"""The orderings between cases that a lesson claims, held in two runs, flipped, or not decidable."""

from collections.abc import Iterator, Mapping, Sequence

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
        (first, second), metric, order, margin = relation
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
        what = f"{metric}: {second} {order} than {first}, {verdict}"
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
        (first, second), metric, order, _ = relation
        held, values = outcome(numbers, relation)
        if held != HELD:
            lines.append(f"{metric} {order} in {second} than in {first} is {held} ({values})")
    return lines


def outcome(numbers: Mapping[str, Metric], relation: Relation) -> tuple[str, str]:
    """Return whether one run holds an ordering, and the two values it is read from.

    A time that the window did not reach is later than any time within it. What two values within
    the margin of each other show is nothing, unless the claim allows them to be equal and they are.
    """
    (first, second), metric, order, margin = relation
    a, b = (numbers.get(f"{case}.{metric}") for case in (first, second))
    if a is None or b is None:
        return WITHIN_MARGIN, f"{first} or {second} is missing"
    text = f"{first} {number(a.value, a.unit)}, {second} {number(b.value, b.unit)}"
    if a.value is None and b.value is None:
        return WITHIN_MARGIN, text
    if a.value is None or b.value is None:
        apart = float("inf") if b.value is None else float("-inf")
    else:
        apart = b.value - a.value
    if order == "no later" and apart <= 0:
        return HELD, text
    if abs(apart) <= margin:
        return WITHIN_MARGIN, text
    rises = {"higher": True, "later": True, "lower": False, "no later": False}[order]
    return (HELD if (apart > 0) == rises else BROKEN), text
