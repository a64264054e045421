"""Tables of L01, and the sentence that the lab generates, each a function of the experiment."""

import textwrap
from collections.abc import Iterator, Sequence

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l01 import machine, spec

MEASURES = False

RULES_OUT = {
    "version": "another version of the engine, with other defaults",
    "libraries": "missing graphics libraries, without which the engine does not start",
    "backend": "settings that are not valid, and an engine that does not start",
    "model_file": "an incomplete installation",
    "build": "a compiler that does not work, and calls in the wrong order",
    "render": "a camera without a picture",
    "names": "another robot model than the lessons have",
    "target": "a start or a target beyond a joint's limits",
    "reset": "a state that is not what was assigned",
    "stamps": "values that are not finite, and steps of another length",
    "saturation": "a robot that does not move towards its target",
}
"""What each step of the doctor rules out."""

COLUMNS = 42
"""Longest line of printed text that a phone shows without scrolling [characters]."""

PARTS = {
    "import": "import of the package",
    "init": "`gs.init`",
    "scene": "scene and entities",
    "build": "`scene.build`",
    "first_step": "first step",
    "more_steps": f"{spec.MORE_STEPS} further steps",
}


@tables.as_table
def doctor_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return one row for each step of the doctor: its result, and what a pass rules out."""
    for number, step in enumerate(machine.STEPS, start=1):
        verdict = "passes" if run.readings[machine.DOCTOR][step] else "does not pass"
        yield {"step": f"{number} `{step}` {verdict}", "what passing rules out": RULES_OUT[step]}


def doctor_lines(steps: list[dict[str, str]]) -> str:
    """Return the steps of a report of the doctor, in lines of at most `COLUMNS` characters."""
    lines = [f"{n:2}  {s['step']}: {s['state']}; {s['found']}" for n, s in enumerate(steps, 1)]
    return "\n".join(textwrap.fill(line, COLUMNS, subsequent_indent="    ") for line in lines)


def start_table(run: Experiment) -> str:
    """Return the times of both starts, part by part [s], and how they compare."""
    found = run.readings[machine.TIMES]
    rows: dict[str, Sequence[float]] = {
        words: [found[f"{start}_{part}"] for start in machine.STARTS]
        for part, words in PARTS.items()
    }
    first, second = (sum(of) for of in zip(*rows.values(), strict=True))
    ratio = {"first divided by second": (f"{first / second:.1f}", "")}
    heads = {f"{start} start [s]": 3 for start in machine.STARTS}
    return tables.timed_table("part", heads, {**rows, "together": (first, second), **ratio})


def metric_table(run: Experiment) -> str:
    """Return the metrics of the run."""
    return tables.six_digits(run.metrics)


CONCLUSION = {
    True: "After {steps} outer steps the sphere's centre is at {height:.6f} m. No height differs "
    "from the computed one by more than {error:.2g} µm, which is the rounding of float32 numbers: "
    "the engine follows the stepping rule.",
    False: "After {steps} outer steps the sphere's centre is at {height:.6f} m. A height differs "
    "from the computed one by {error:.2g} µm, which is more than rounding explains. Check version, "
    "gravity and step.",
}
"""What the lab says, by whether the measured heights are the computed ones."""


def conclusion(run: Experiment) -> str:
    """Compare the measured height with the computed one."""
    found = run.metrics["baseline"]
    text = CONCLUSION[found.formula_error <= spec.FORMULA_TOLERANCE]
    values = {"height": found.final_height, "error": 1e6 * found.formula_error}
    return text.format(steps=run.cases["baseline"].steps, **values)
