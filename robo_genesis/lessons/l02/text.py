"""Tables of a dropped box, and the sentences that the lab generates."""

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, format_value, signed
from robo_genesis.lessons.l02 import spec, study
from robo_genesis.sim.bodies.free_fall import continuous_drop, summed_drop

MEASURES = False

# Lengths below the first are written in mm, below the second in µm [m].
TENTH, MILLIMETRE = 0.1, 1e-3

# What the lab says if a check passed, with the metrics of the baseline.
SENTENCES = {
    "falls": "The box fell {drop} in {duration}, and was faster after every step.",
    "clear_of_ground": "The box did not reach the ground. L03 is about landing.",
    "stepped_formula": "No sample differs from g h² n (n + 1) / 2 by more than {formula_error}. At "
    "the end the box is {continuous_gap} farther down than g t² / 2: the solver step causes this.",
    "speed": "At the end the box moved down at {final_speed}, which is g t: under constant "
    "acceleration the velocity has no error.",
    "straight_down": "The box did not move sideways and did not turn.",
}

ADVICE = (
    "Look first at the times of the samples, the first state, gravity, and contacts."
)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the baseline, or what the checks found in its place."""
    values = {
        n: readable(value, unit) for n, value, unit in run.metrics["baseline"].items()
    }
    return bullets(
        tables.sentence_of(check, SENTENCES[check.name], values, ADVICE)
        for check in run.outcomes()
        if check.name in SENTENCES
    )


def readable(value: float | None, unit: str) -> str:
    """Write a value with a unit of its size: `0.0689 µm`, `4.90 mm` and `0.2011 m`."""
    if value is None or unit != "m" or value == 0 or abs(value) >= TENTH:
        return format_value(value, unit).replace("-", "−")
    size, name = (1e3, "mm") if abs(value) >= MILLIMETRE else (1e6, "µm")
    return f"{size * value:.3g} {name}".replace("-", "−")


def model_table(run: Experiment) -> str:
    """Return the engine's counts of the scene and the box, and the box's mass."""
    return tables.markdown(
        [{**run.readings["model"], "mass [kg]": run.readings["body"]["mass"]}]
    )


def metric_table(run: Experiment) -> str:
    """Return the metrics of the baseline."""
    return tables.metric_table(
        {spec.LABELS["baseline"]: run.metrics["baseline"]}, readable
    )


def three_drops(run: Experiment) -> str:
    """Return a table of the measured drop and both formulas."""
    found, case = run.metrics["baseline"], run.cases["baseline"]
    drops = {
        "measured": found.drop,
        "stepped, g h² n (n + 1) / 2": summed_drop(
            case.h, case.steps * case.substeps, case.gravity
        ),
        "continuous, g t² / 2": continuous_drop(found.duration, case.gravity),
    }
    heads = {"distance [m]": 6, "against the measurement [mm]": 0}
    rows = {
        name: (drop, signed(1000 * (drop - found.drop), 4))
        for name, drop in drops.items()
    }
    return tables.number_table("drop", heads, rows)


def substep_table(run: Experiment) -> str:
    """Return the drops of all solver steps."""
    names = (
        "h [ms]",
        "measured drop [m]",
        "farther than g t² / 2 [mm]",
        "g h t / 2 [mm]",
    )
    rows = {}
    for name in study.by_step(run):
        case, of = run.cases[name], run.metrics[name]
        gaps = 1000 * of.continuous_gap, 1000 * study.expected_gap(run, name)
        rows[f"{case.substeps}"] = f"{1000 * case.h:g}", of.drop, *gaps
    return tables.number_table(
        "substeps", dict(zip(names, (0, 6, 3, 3), strict=True)), rows
    )
