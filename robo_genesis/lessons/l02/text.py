"""Sentences about a dropped box, chosen and filled by its own numbers, right for every outcome."""

from collections.abc import Mapping, Sequence

from robo_genesis.core.free_fall import ahead_of_continuous, continuous_drop, summed_drop
from robo_genesis.core.text import Block, signed
from robo_genesis.lessons.l02.checks import SPEED_SHARE
from robo_genesis.lessons.l02.metrics import DropMetrics
from robo_genesis.lessons.l02.spec import AT_REST, FORMULA_TOLERANCE
from robo_genesis.lessons.l02.study import SHARE, Study
from robo_genesis.sim.rigid_bodies import Drop

LOOK = "Look first at the time stamps, the first state, gravity, and whether something was touched."
TERM = "g h t / 2".replace(" ", "\N{NO-BREAK SPACE}")
"""How far ahead of continuous free fall a stepped body is."""


def interpretation(found: DropMetrics, case: Drop) -> tuple[Block, ...]:
    """Return what one run shows: the fall, the formula that it follows, and what did not happen."""
    return (
        Block("The fall", (fall_sentence(found, case), speed_sentence(found, case))),
        Block("Measured beside two formulas", formula_sentences(found, case)),
        Block("What did not happen", (straight_sentence(found), ground_sentence(found, case))),
    )


def fall_sentence(found: DropMetrics, case: Drop) -> str:
    """Say how far the box fell or rose, and between which heights."""
    way = "fell" if found.drop >= 0 else "rose"
    return (
        f"In {found.duration:.2f} s of simulated time, {case.steps} outer steps, the box {way} "
        f"{abs(found.drop):.6f} m: from {case.height:g} m to {case.height - found.drop:.6f} m."
    )


def speed_sentence(found: DropMetrics, case: Drop) -> str:
    """Hold the speed at the end against g t, which both formulas have."""
    expected = case.gravity * found.duration
    told = f"At the end it moved down at {found.final_speed:.4f} m/s; g t is {expected:.4f} m/s"
    if abs(found.final_speed - expected) <= SPEED_SHARE * expected:
        return (
            f"{told}, the same to within float32: under constant acceleration the stepped velocity "
            "has no error of its own."
        )
    return f"{told}. They differ by {signed(found.final_speed - expected, 4)} m/s. {LOOK}"


def formula_sentences(found: DropMetrics, case: Drop) -> tuple[str, ...]:
    """Hold the drop against the stepped formula and against continuous free fall."""
    n = case.steps * case.substeps
    stepped = float(summed_drop(case.h, n, case.gravity))
    continuous = float(continuous_drop(found.duration, case.gravity))
    gap = float(ahead_of_continuous(case.h, found.duration, case.gravity))
    off = f"{1e6 * found.formula_error:.2g} µm"
    ahead = f"The box is {ahead_or_behind(found.continuous_gap)} that"
    first = f"The stepped formula gives {stepped:.6f} m for n = {n}"
    if found.formula_error <= FORMULA_TOLERANCE:
        first += f": at no sample is the box farther than {off} from it, which is float32."
    else:
        first += f", and the box is up to {off} off: it was not stepped as assumed. {LOOK}"
    second = f"Continuous free fall gives {continuous:.6f} m. {ahead}, and {TERM} is "
    second += f"{1000 * gap:.3f} mm"
    if abs(found.continuous_gap - gap) <= FORMULA_TOLERANCE:
        second += ": the difference is the solver's step, and no error of measurement."
    else:
        second += f": the solver's step does not explain the difference. {LOOK}"
    return first, second


def straight_sentence(found: DropMetrics) -> str:
    """Say whether the box moved aside or turned."""
    if found.sideways <= AT_REST and found.turning <= AT_REST:
        return (
            f"It neither moved aside (at most {1e6 * found.sideways:.2g} µm) nor turned (at most "
            f"{found.turning:.2g} rad/s)."
        )
    return (
        f"It moved {found.sideways:.2g} m aside and turned at up to {found.turning:.2g} rad/s: "
        "something touched it, or gravity does not point down."
    )


def ground_sentence(found: DropMetrics, case: Drop) -> str:
    """Say how far above the ground the box was at its lowest, or that it got there."""
    left = case.clearance - found.lowest
    if left > 0:
        return (
            f"It did not reach the ground: at the lowest sample {1000 * left:.1f} mm were left "
            "below it. What happens on landing is the matter of L03."
        )
    return "It reached the ground within the window, so these numbers are not of free fall alone."


def three_rows(found: DropMetrics, case: Drop) -> Sequence[Mapping[str, str]]:
    """Return measurement and both formulas side by side, for a table."""
    n = case.steps * case.substeps
    drops = {
        "measured": found.drop,
        "stepped, g h² n (n + 1) / 2": float(summed_drop(case.h, n, case.gravity)),
        "continuous, g t² / 2": float(continuous_drop(found.duration, case.gravity)),
    }
    return [
        {
            "drop": name,
            "distance [m]": f"{drop:.6f}",
            "against the measurement [mm]": signed(1000 * (drop - found.drop), 4),
        }
        for name, drop in drops.items()
    ]


def ahead_or_behind(gap: float) -> str:
    """Say by how much a box is lower or higher than another, without a sign [m]."""
    return f"{1000 * abs(gap):.3f} mm {'ahead of' if gap >= 0 else 'behind'}"


def convergence(found: Study) -> tuple[str, ...]:
    """Say how the difference to continuous free fall goes with the solver's step."""
    first, last = (ahead_or_behind(gap) for gap in (found.gaps[0], found.gaps[-1]))
    coarse, fine = (f"{1000 * h:g} ms" for h in (found.h[0], found.h[-1]))
    told = (
        f"With a solver step of {coarse} the box is {first} continuous free fall at the end; "
        f"with {fine} it is {last} it."
    )
    apart = max(abs(g / e - 1) for g, e in zip(found.gaps, found.expected, strict=True))
    if apart <= SHARE:
        return (
            told,
            f"Every one of the {len(found.names)} runs agrees with {TERM} to within "
            f"{100 * apart:.1g} %: the method is of first order, half the step leaves half the "
            "difference.",
        )
    return told, f"The one farthest from {TERM} is {100 * apart:.0f} % off it. {LOOK}"
