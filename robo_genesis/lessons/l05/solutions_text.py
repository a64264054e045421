"""Tables and sentences of the page about many solutions."""

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, listed
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim.arm_kinematics import ARM
from robo_genesis.sim.franka import JOINT_NAMES

THRESHOLDS = (0.05, 0.1, 0.3, 0.5, 1.0)
"""Largest joint differences within which two answers count as one [rad]."""

CRITERIA = {
    "nearest to the start": ("from_start", min),
    "farthest from the limits": ("margin", max),
    "largest manipulability": ("manipulability", max),
}
"""What chooses one of several answers: a key of `study.answers`, and which value is best."""

MEASURES = {
    "distance left [mm]": ("position", 1000, 4),
    "angle left [mrad]": ("rotation", 1000, 4),
    "manipulability": ("manipulability", 1, 3),
    "distance from limits [rad]": ("margin", 1, 3),
    "largest angle from the start [rad]": ("from_start", 1, 3),
}
"""Columns of `records`: key of `study.answers`, factor and significant digits."""


def records(run: Experiment, name: str) -> list[dict[str, str]]:
    """Return what is known of each answer of a run as rows of a table."""
    case, q = spec.QUESTIONS[name], run.traces[name].q[1:, :ARM]
    found, (lower, upper) = study.answers(run.traces[name], case), spec.ARM_LIMITS
    nearest = np.minimum(q - lower, upper - q).argmin(axis=1)
    return [
        {
            "answer": str(k + 1),
            "target x, y, z [m]": ", ".join(f"{value:g}" for value in case.positions[k]),
            "accepted": "yes" if found["accepted"][k] else "no",
            "joint1 [rad]": f"{q[k, 0]:.3f}",
            "nearest to a limit": JOINT_NAMES[nearest[k]],
        }
        | {
            label: f"{max(factor * found[key][k], 0):.{digits}g}"
            for label, (key, factor, digits) in MEASURES.items()
        }
        for k in range(case.steps)
    ]


def chosen(run: Experiment) -> dict[str, int]:
    """Return by criterion the number of the accepted answer, from 0, that it chooses."""
    found = many_answers(run)
    numbers = np.flatnonzero(found["accepted"]).tolist()
    return {
        name: best(numbers, key=found[key].__getitem__) for name, (key, best) in CRITERIA.items()
    }


def many_answers(run: Experiment) -> dict[str, FloatArray]:
    """Return what is known of the answers from many starts."""
    return study.answers(run.traces["many_starts"], spec.MANY_STARTS)


def count_table(run: Experiment) -> str:
    """Return how many answers are distinct for several thresholds."""
    q = run.traces["many_starts"].q[1:, :ARM][many_answers(run)["accepted"]]
    return tables.markdown(
        [{"threshold [rad]": t, "distinct answers": study.clusters(q, t)} for t in THRESHOLDS]
    )


def family_sentences(run: Experiment) -> str:
    """Say how many answers were accepted, and on which curves they are."""
    found, families = many_answers(run), study.solution_families(run)
    accepted = found["accepted"]
    lengths = [np.linalg.norm(np.diff(curve, axis=0), axis=1).sum() for curve, _ in families]
    margin = found["margin"][accepted]
    elbow = np.concatenate([curve[:, 3] for curve, _ in families])
    return bullets([
        f"{accepted.sum()} of {len(accepted)} starts led to an accepted answer.",
        f"They are on {len(families)} curves within the limits, with "
        f"{listed([str(len(inside)) for _, inside in families])} answers and lengths of "
        f"{listed([f'{length:.1f}' for length in lengths])} rad.",
        f"On all curves, `joint4` stays between {elbow.min():.2f} and {elbow.max():.2f} rad: the "
        "hand's distance from the shoulder determines the elbow's angle.",
        f"{(margin < 0.01).sum()} accepted answers are within 0.01 rad of a joint limit.",
    ])  # fmt: skip


def choice_table(run: Experiment) -> str:
    """Return the answers that the criteria choose."""
    rows, left_out = records(run, "many_starts"), ("accepted", "target x, y, z [m]")
    return tables.markdown(
        [
            {"criterion": name} | {key: rows[k][key] for key in rows[k] if key not in left_out}
            for name, k in chosen(run).items()
        ]
    )


def unreachable_table(run: Experiment) -> str:
    """Compare the engine's answer for the target beyond reach with the nearest posture found."""
    found = study.answers(run.traces["unreachable"], spec.UNREACHABLE)
    pairs = {
        "engine's answer": (found["position"][0], found["rotation"][0]),
        "nearest that we found": kinematics.distances(study.nearest()[1]),
    }
    return tables.markdown(
        [
            {
                "posture": name,
                "distance [m]": f"{apart:.3f}",
                "angle [rad]": f"{angle:.3f}",
                "weighted distance [m]": f"{study.weighted(apart, angle):.3f}",
            }
            for name, (apart, angle) in pairs.items()
        ]
    )


def reach_sentences(run: Experiment) -> str:
    """Say how many targets of each plane are accepted, and what the values of these span."""
    lines = []
    for name in spec.PLANES:
        found = study.answers(run.traces[name], spec.QUESTIONS[name])
        yes = found["accepted"].astype(bool)
        spans = {
            key: (found[key][yes].min(), found[key][yes].max())
            for key in ("manipulability", "margin")
        }
        lines.append(
            f"Of the {len(yes)} targets in the {name} plane, {yes.sum()} are accepted, with a "
            "manipulability of {:.3f} to {:.3f} ".format(*spans["manipulability"])
            + "and a distance of {:.3f} to {:.2f} rad from the limits.".format(*spans["margin"])
        )
    return bullets(lines)
