"""Texts of L01: what the doctor printed, metrics, and the sentence that the lab generates."""

import textwrap

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment

from . import spec

MEASURES = False

# Longest line of printed text that a phone shows without scrolling [characters]
COLUMNS = 42


def doctor_lines(steps: list[dict[str, str]]) -> str:
    """Return what the steps of a report found, in lines of at most `COLUMNS` characters."""
    ran = [step for step in steps if step["state"] != "not run"]
    lines = [
        f"{n:2}  {s['step']}: {s['state']}; {s['found']}" for n, s in enumerate(ran, 1)
    ]
    return "\n".join(
        textwrap.fill(line, COLUMNS, subsequent_indent="    ") for line in lines
    )


def metric_table(run: Experiment) -> str:
    """Return the metrics of the run."""
    return tables.six_digits(run.metrics)


# What the lab says, by whether the measured heights are the computed ones.
CONCLUSION = {
    True: "After {steps} outer steps the sphere's centre is at {height:.6f} m. No height differs "
    "from the computed one by more than {error:.2g} µm, which is the rounding of float32 numbers: "
    "the engine follows the stepping rule.",
    False: "After {steps} outer steps the sphere's centre is at {height:.6f} m. A height differs "
    "from the computed one by {error:.2g} µm, which is more than rounding explains. Check version, "
    "gravity and step.",
}


def conclusion(run: Experiment) -> str:
    """Compare the measured height with the computed one."""
    found = run.metrics["baseline"]
    text = CONCLUSION[found.formula_error <= spec.FORMULA_TOLERANCE]
    values = {"height": found.final_height, "error": 1e6 * found.formula_error}
    return text.format(steps=run.cases["baseline"].steps, **values)
