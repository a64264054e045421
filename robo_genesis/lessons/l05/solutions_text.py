"""Tables and sentences of the page about many solutions."""

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import decimal
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.franka import JOINT_NAMES

MEASURES = False

THRESHOLDS = (0.05, 0.1, 0.3, 0.5, 1.0)
"""Largest joint differences within which two answers count as one [rad]."""

CRITERIA = {
    "nearest to the present posture": ("from_start", min),
    "farthest from the limits": ("margin", max),
    "largest manipulability": ("manipulability", max),
}
"""What chooses one of several answers: a key of `study.answers`, and which value is best."""

QUANTITIES = {
    "manipulability": ("manipulability", 1, 3),
    "distance from limits [rad]": ("margin", 1, 3),
    "largest angle from the present posture [rad]": ("from_start", 1, 3),
    "distance left [mm]": ("position", 1000, 4),
    "angle left [mrad]": ("rotation", 1000, 4),
}
"""Columns of `records`: key of `study.answers`, factor and significant digits."""


def records(run: Experiment, name: str) -> list[dict[str, str]]:
    """Return what is known of each answer of a run as rows of a table."""
    case, q = spec.QUESTIONS[name], run.traces[name].q[1:, : kinematics.ARM]
    found, (lower, upper) = study.answers(run.traces[name], case), spec.ARM_LIMITS
    nearest = np.minimum(q - lower, upper - q).argmin(axis=1)
    rows = []
    for k in range(case.steps):
        row = {
            "answer": str(k + 1),
            "target x, y, z [m]": ", ".join(f"{value:g}" for value in case.positions[k]),
            "accepted": "yes" if found["accepted"][k] else "no",
            "joint1 [rad]": decimal(q[k, 0], 3),
            "nearest to a limit": JOINT_NAMES[nearest[k]],
        }
        shown = {
            label: (max(by * found[key][k], 0), n) for label, (key, by, n) in QUANTITIES.items()
        }
        rows.append(row | {label: f"{round(x, 6):.{n}g}" for label, (x, n) in shown.items()})
    return rows


def chosen(run: Experiment) -> dict[str, int]:
    """Return by criterion the number of the accepted answer, from 0, that it chooses."""
    found = study.many_answers(run)
    numbers = np.flatnonzero(found["accepted"]).tolist()
    return {n: best(numbers, key=found[key].__getitem__) for n, (key, best) in CRITERIA.items()}


def count_table(run: Experiment) -> str:
    """Return how many answers are distinct for several thresholds."""
    q = run.traces["many_starts"].q[1:, : kinematics.ARM][study.many_answers(run)["accepted"]]
    rows = [{"threshold [rad]": t, "distinct answers": study.clusters(q, t)} for t in THRESHOLDS]
    return tables.markdown(rows)


def family_table(run: Experiment) -> str:
    """Return the curves on which the accepted answers are."""
    rows = []
    for number, (curve, inside) in enumerate(study.solution_families(run), start=1):
        length = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
        row = {"curve": number, "answers": len(inside), "length [rad]": f"{length:.1f}"}
        rows.append(row | {f"{JOINT_NAMES[k]} [rad]": span(curve[:, k], 2) for k in (0, 1, 3)})
    return tables.markdown(rows)


def span(values: FloatArray, digits: int) -> str:
    """Return the smallest and the largest of values (n,)."""
    return f"{decimal(values.min(), digits)} … {decimal(values.max(), digits)}"


def choice_table(run: Experiment) -> str:
    """Return the answers that the criteria choose."""
    rows, shown = records(run, "many_starts"), ("answer", "joint1 [rad]", *[*QUANTITIES][:3])
    found = chosen(run).items()
    return tables.markdown([{"criterion": n} | {s: rows[k][s] for s in shown} for n, k in found])


def unreachable_table(run: Experiment) -> str:
    """Compare the engine's answer for the target beyond reach with the nearest posture found."""
    found = study.answers(run.traces["unreachable"], spec.UNREACHABLE)
    pairs = {
        "engine's answer": (found["position"][0], found["rotation"][0]),
        "nearest that we found": kinematics.distances(study.nearest()[1]),
    }
    heads = dict.fromkeys(("distance [m]", "angle [rad]", "weighted distance [m]"), 3)
    rows = {name: (*pair, study.weighted(*pair)) for name, pair in pairs.items()}
    return tables.number_table("posture", heads, rows)


def reach_table(run: Experiment) -> str:
    """Return how many targets of each plane are accepted, and what their answers span."""
    rows = []
    for name in spec.PLANES:
        found = study.answers(run.traces[name], spec.QUESTIONS[name])
        yes = found["accepted"].astype(bool)
        row = {"plane": name, "targets": len(yes), "accepted": int(yes.sum())}
        row |= {head: span(found[QUANTITIES[head][0]][yes], 3) for head in [*QUANTITIES][:2]}
        left = span(1000 * found["position"][~yes], 1)
        rows.append(row | {"distance left where refused [mm]": left})
    return tables.markdown(rows)
