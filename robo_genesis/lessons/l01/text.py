"""Tables and sentences of L01, each a function of the experiment."""

import textwrap

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


def doctor_table(run: Experiment) -> str:
    """Return one row for each step of the doctor: its result, and what a pass rules out."""
    found = run.readings[machine.DOCTOR]
    rows = [
        {
            "step": f"{number} `{step}` {'passes' if found[step] else 'does not pass'}",
            "what passing rules out": RULES_OUT[step],
        }
        for number, step in enumerate(machine.STEPS, start=1)
    ]
    return tables.markdown(rows)


def doctor_lines(steps: list[dict[str, str]]) -> str:
    """Return the steps of a report of the doctor, in lines of at most `COLUMNS` characters."""
    lines = [f"{n:2}  {s['step']}: {s['state']}; {s['found']}" for n, s in enumerate(steps, 1)]
    return "\n".join(textwrap.fill(line, COLUMNS, subsequent_indent="    ") for line in lines)


def start_table(run: Experiment) -> str:
    """Return the times of both starts, part by part [s]."""
    found = run.readings[machine.TIMES]
    rows = {
        words: [found[f"{start}_{part}"] for start in machine.STARTS]
        for part, words in PARTS.items()
    }
    rows["together"] = [sum(of) for of in zip(*rows.values(), strict=True)]
    return tables.number_table("part", {f"{start} start [s]": 3 for start in machine.STARTS}, rows)


def start_sentence(run: Experiment) -> str:
    """Say by which factor the second start is faster."""
    found = run.readings[machine.TIMES]
    first, second = (sum(found[f"{s}_{part}"] for part in PARTS) for s in machine.STARTS)
    if second < first:
        return (
            f"The first start took {first:.1f} s and the second {second:.1f} s: the first took "
            f"{first / second:.1f} times as long."
        )
    return (
        f"In this run the second start took {second:.1f} s and the first {first:.1f} s, so the "
        "kept kernels saved nothing. Another program may have slowed it down."
    )


def metric_table(run: Experiment) -> str:
    """Return the metrics of the run."""
    return tables.six_digits(run.metrics)


def conclusion(run: Experiment) -> str:
    """Compare the measured height with the computed one."""
    found, case = run.metrics["baseline"], run.cases["baseline"]
    agrees = found.formula_error <= spec.FORMULA_TOLERANCE
    return (
        f"After {case.steps} outer steps the sphere's centre is at {found.final_height:.6f} m. "
        f"The largest difference from the computed height over all states is "
        f"{1e6 * found.formula_error:.2g} µm. "
        + (
            "That is the rounding of float32 numbers: the engine follows the stepping rule."
            if agrees
            else "That is more than rounding explains. Check version, gravity and step."
        )
    )
