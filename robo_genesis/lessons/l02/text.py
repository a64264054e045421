"""Sentences about a dropped box, chosen and filled by its metrics, correct for every outcome."""

from collections.abc import Mapping, Sequence

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.free_fall import ahead_of_continuous, continuous_drop, summed_drop
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import Block, signed
from robo_genesis.lessons.l02 import spec, trials
from robo_genesis.lessons.l02 import study as studies
from robo_genesis.lessons.l02.metrics import DropMetrics
from robo_genesis.lessons.l02.spec import (
    AT_REST,
    FIRST_ORDER_SHARE,
    FORMULA_TOLERANCE,
    SPEED_SHARE,
)
from robo_genesis.lessons.l02.study import StepStudy
from robo_genesis.sim.bodies.rigid_bodies import Drop

MEASURES = False

TENTH, MILLIMETRE = 0.1, 1e-3
"""Lengths below the first are written in mm, below the second in µm [m]."""

INSPECT = "Check the times of the samples, the first state, gravity, and contacts first."
TERM = "g h t / 2".replace(" ", "\N{NO-BREAK SPACE}")
"""How far ahead of continuous free fall a stepped body is."""


def model_table(run: Experiment) -> str:
    """Return the engine's counts of the scene and the box, and the box's mass."""
    return tables.markdown([{**run.readings["model"], "mass [kg]": run.readings["body"]["mass"]}])


def metric_table(run: Experiment) -> str:
    """Return the metrics of the baseline."""
    return tables.metric_table({spec.LABELS["baseline"]: run.metrics["baseline"]}, readable)


def readable(value: float | None, unit: str) -> str:
    """Write a value with a unit of its size: `0.0689 µm`, `4.90 mm` and `0.2011 m`."""
    if value is None or unit != "m" or value == 0 or abs(value) >= TENTH:
        return format_value(value, unit).replace("-", "−")
    size, name = (1e3, "mm") if abs(value) >= MILLIMETRE else (1e6, "µm")
    return f"{size * value:.3g} {name}".replace("-", "−")


def three_drops(run: Experiment) -> str:
    """Return a table of the measured drop and both formulas."""
    return tables.markdown(three_rows(run.metrics["baseline"], run.cases["baseline"]))


def conclusions(run: Experiment) -> str:
    """Return the sentences about the baseline."""
    blocks = interpretation(run.metrics["baseline"], run.cases["baseline"])
    return "\n".join(block.markdown() for block in blocks)


def substep_table(run: Experiment) -> str:
    """Return the drops of all solver steps."""
    study = studies.step_study(run.metrics, run.cases)
    return tables.markdown(studies.rows(study, run.metrics, run.cases))


def substep_conclusions(run: Experiment) -> str:
    """Return the sentences about all solver steps."""
    sentences = convergence(studies.step_study(run.metrics, run.cases))
    return "\n".join(f"- {sentence}" for sentence in sentences)


def falls_table(run: Experiment) -> str:
    """Return the further falls beside the stepped formula."""
    words = {
        "higher": f"from {spec.HIGHER:g} m",
        "thrown": f"thrown upwards at {spec.THROWN:g} m/s",
        "heavier": f"{spec.HEAVIER:g} times as heavy",
        "moon": f"on the Moon, g = {spec.MOON:g} m/s²",
    }
    found, expected = run.readings[trials.FURTHER], trials.expected_falls()
    rows = {words[name]: (found[name], expected[name]) for name in trials.FALLS}
    return tables.number_table("fall", {"measured [m]": 6, "stepped formula [m]": 6}, rows)


def interpretation(found: DropMetrics, case: Drop) -> tuple[Block, ...]:
    """Return the results of one run: the fall, its formula, and the absence of other motion."""
    return (
        Block("The fall", (fall_sentence(found, case), speed_sentence(found, case))),
        Block("The measurement and two formulas", formula_sentences(found, case)),
        Block("What did not happen", (straight_sentence(found), ground_sentence(found, case))),
    )


def fall_sentence(found: DropMetrics, case: Drop) -> str:
    """Say how far the box fell or rose, and between which heights."""
    verb = "fell" if found.drop >= 0 else "rose"
    return (
        f"In {found.duration:.2f} s of simulated time ({case.steps} outer steps) the box {verb} "
        f"{abs(found.drop):.6f} m, from {case.height:g} m to {case.height - found.drop:.6f} m."
    )


def speed_sentence(found: DropMetrics, case: Drop) -> str:
    """Compare the speed at the end with g t, the speed in both formulas."""
    expected = case.gravity * found.duration
    speeds = f"At the end it moved down at {found.final_speed:.4f} m/s; g t is {expected:.4f} m/s"
    if abs(found.final_speed - expected) <= SPEED_SHARE * expected:
        return (
            f"{speeds}. They agree to within float32: under constant acceleration the stepped "
            "velocity has no error of its own."
        )
    return f"{speeds}. They differ by {signed(found.final_speed - expected, 4)} m/s. {INSPECT}"


def formula_sentences(found: DropMetrics, case: Drop) -> tuple[str, ...]:
    """Compare the drop with the stepped formula and with continuous free fall."""
    stepped, continuous = drops_by_formula(found, case)
    gap = float(ahead_of_continuous(case.h, found.duration, case.gravity))
    error = f"{1e6 * found.formula_error:.2g} µm"
    first = f"The stepped formula gives {stepped:.6f} m for n = {case.steps * case.substeps}. "
    if found.formula_error <= FORMULA_TOLERANCE:
        first += f"No sample of the box differs by more than {error}, which is float32 rounding."
    else:
        first += f"The box differs by up to {error}: it was not stepped as assumed. {INSPECT}"
    second = (
        f"Continuous free fall gives {continuous:.6f} m. The box is "
        f"{ahead_or_behind(found.continuous_gap)} that, and {TERM} is {1000 * gap:.3f} mm: "
    )
    if abs(found.continuous_gap - gap) <= FORMULA_TOLERANCE:
        second += "the solver step causes the difference, not the measurement."
    else:
        second += f"the solver step does not explain the difference. {INSPECT}"
    return first, second


def straight_sentence(found: DropMetrics) -> str:
    """Say whether the box moved sideways or turned."""
    if found.sideways <= AT_REST and found.turning <= AT_REST:
        return (
            f"It neither moved sideways (at most {1e6 * found.sideways:.2g} µm) nor turned (at "
            f"most {found.turning:.2g} rad/s)."
        )
    return (
        f"It moved {found.sideways:.2g} m sideways and turned at up to {found.turning:.2g} rad/s: "
        "something touched it, or gravity does not point down."
    )


def ground_sentence(found: DropMetrics, case: Drop) -> str:
    """Say how far above the ground the box was at its lowest, or that it reached the ground."""
    left = case.clearance - found.lowest
    if left > 0:
        return (
            f"It did not reach the ground: at its lowest sample it was {1000 * left:.1f} mm above "
            "it. L03 is about landing."
        )
    return "It reached the ground within the window, so its metrics include more than free fall."


def drops_by_formula(found: DropMetrics, case: Drop) -> tuple[float, float]:
    """Return the drop by the stepped formula and that of continuous free fall [m]."""
    stepped = summed_drop(case.h, case.steps * case.substeps, case.gravity)
    return float(stepped), float(continuous_drop(found.duration, case.gravity))


def three_rows(found: DropMetrics, case: Drop) -> Sequence[Mapping[str, str]]:
    """Return measurement and both formulas side by side, for a table."""
    stepped, continuous = drops_by_formula(found, case)
    drops = {
        "measured": found.drop,
        "stepped, g h² n (n + 1) / 2": stepped,
        "continuous, g t² / 2": continuous,
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


def convergence(study: StepStudy) -> tuple[str, ...]:
    """Say how the difference to continuous free fall depends on the solver step."""
    first, last = (ahead_or_behind(gap) for gap in (study.gaps[0], study.gaps[-1]))
    coarse, fine = (f"{1000 * h:g} ms" for h in (study.h[0], study.h[-1]))
    ends = (
        f"With a solver step of {coarse} the box is {first} continuous free fall at the end; "
        f"with {fine} it is {last} it."
    )
    error = 100 * max(abs(g / e - 1) for g, e in zip(study.gaps, study.expected, strict=True))
    if error <= 100 * FIRST_ORDER_SHARE:
        return (
            ends,
            f"All {len(study.names)} runs agree with {TERM} to within {error:.1g} %. The method is "
            "of first order: half the step leaves half the difference.",
        )
    return ends, f"The run farthest from {TERM} differs from it by {error:.0f} %. {INSPECT}"
