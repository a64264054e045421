"""Tables of a dropped box, and the sentences that the lab generates."""

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, decimal, readable, signed
from robo_genesis.sim.bodies.free_fall import continuous_drop, summed_drop

from . import checks, spec

MEASURES = False

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


@tables.as_table
def three_drops(run: Experiment) -> tables.Rows:
    """Return a table of the measured drop and both formulas."""
    found, case = run.metrics["baseline"], run.cases["baseline"]
    steps = run.traces["baseline"].steps * case.substeps
    for name, drop in (
        ("measured", found.drop),
        ("stepped, g h² n (n + 1) / 2", summed_drop(case.h, steps, case.gravity)),
        ("continuous, g t² / 2", continuous_drop(found.duration, case.gravity)),
    ):
        yield {
            "drop": name,
            "distance [m]": decimal(drop, 6),
            "against the measurement [mm]": signed(1000 * (drop - found.drop), 4),
        }


@tables.as_table
def substep_table(run: Experiment) -> tables.Rows:
    """Return the drops of all solver steps."""
    for name in checks.by_step(run):
        case, m = run.cases[name], run.metrics[name]
        yield {
            "substeps": f"{case.substeps}",
            "h [ms]": f"{1000 * case.h:g}",
            "measured drop [m]": decimal(m.drop, 6),
            "farther than g t² / 2 [mm]": decimal(1000 * m.continuous_gap, 3),
            "g h t / 2 [mm]": decimal(1000 * checks.expected_gap(run, name), 3),
        }
