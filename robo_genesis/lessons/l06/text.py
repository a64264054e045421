"""Tables and sentences of L06's lecture and lab, each a function of the experiment."""

from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, decimal, listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l06 import spec, study
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

MEASURES = False

SHOWN_TORQUES = (1, 3)
"""The joints with a torque in the table of variants: joint2 and joint4."""


def mm(value: float, digits: int = 2) -> str:
    """Return a length in millimetres."""
    return decimal(1000 * value, digits)


def mixed_table(run: Experiment) -> str:
    """Return residual and verdict of each row of the question with a target beyond reach."""
    found = run.readings["mixed"].values(), run.readings["mixed_accepted"].values()
    rows = [
        {
            "row": f"{k}",
            "target [m]": ", ".join(f"{value:g}" for value in spec.MIXED[k]).replace("-", "−"),
            "position residual [mm]": mm(residual, 3),
            "the row is": "accepted" if accepted else "**refused**",
        }
        for k, (residual, accepted) in enumerate(zip(*found, strict=True))
    ]
    return tables.markdown(rows)


def row_table(run: Experiment) -> str:
    """Return residual and distances of each environment."""
    heads = {
        "residual of the last command [mm]": 3,
        "first target after 1.8 s [mm]": 2,
        "last target at the end [mm]": 2,
        "motion after 1.8 s [mm]": 2,
    }
    found = {spec.LABELS[name]: run.metrics[name] for name in spec.WORLDS}
    rows = {
        label: [1e3 * v for v in (m.residual, m.first_distance, m.final_distance, m.moved_later)]
        for label, m in found.items()
    }
    return tables.number_table("run", heads, rows)


def alone_table(run: Experiment) -> str:
    """Return the largest differences between each row and the same run alone.

    A line of an environment is about the joints of the arm; the last line is about all fingers.
    """
    heads = {
        "position [µrad]": 2,
        "velocity [µrad/s]": 1,
        "control force [mN·m]": 2,
        "entries that differ [%]": 0,
    }
    pairs = {f"env_{k}": (run.traces[f"env_{k}"], run.traces[f"alone_{k}"]) for k in spec.ENVS}

    def largest(pair: tuple[Trace, Trace], joints: slice) -> FloatArray:
        found = study.largest_differences(*pair, joints).values()
        return np.array([1e6, 1e6, 1e3]) * list(found)

    rows: dict[str, list[Any]] = {}
    for name, pair in pairs.items():
        differ, compared = study.entries_that_differ(*pair)
        rows[spec.LABELS[name]] = [*largest(pair, slice(ARM)), 100 * differ / compared]
    fingers = np.max([largest(pair, slice(ARM, None)) for pair in pairs.values()], axis=0)
    units = zip(fingers, ("µm", "µm/s", "mN"), strict=True)
    rows["fingers of all four"] = [*(f"{decimal(value, 2)} {unit}" for value, unit in units), ""]
    return tables.number_table("run", heads, rows)


CLAIMED = {
    "permuted": "the worlds in the order {order}",
    "beside": "environments {kept}, while {reset} are reset and commanded after {after} s",
    "again": "environments {reset} from their reset on, against their first start",
    "plain": "the plain robot beside other gains and loads, against environment 0",
}


def equal_table(run: Experiment) -> str:
    """Return how many entries differ where runs must be equal to the last bit."""
    words = {
        "order": ", ".join(map(str, spec.ORDER)),
        "kept": listed([name[-1] for name in spec.BESIDE]),
        "reset": listed([name[-1] for name in spec.AGAIN]),
        "after": f"{spec.RESET_AFTER * spec.FIRST.dt:g}",
    }
    rows = []
    for claim, names in study.pairs().items():
        counted = [
            study.entries_that_differ(run.traces[one], run.traces[other]) for one, other in names
        ]
        differ, compared = (sum(column) for column in zip(*counted, strict=True))
        rows.append(
            {
                "what changed": CLAIMED[claim].format(**words),
                "numbers compared": f"{compared:,}".replace(",", " "),
                "that differ": f"{differ}",
            }
        )
    return tables.markdown(rows)


def variant_table(run: Experiment) -> str:
    """Return gains, mass, torques and distances of four robots with one target."""
    torques = [f"torque of joint{k + 1} (computed) [N·m]" for k in SHOWN_TORQUES]
    heads = {"KP of joint2 [N·m/rad]": 0, "mass of the hand [kg]": 2}
    heads |= dict.fromkeys(torques, 2) | {"target to hand [mm]": 2}
    rows = {}
    for name, world in spec.VARIANTS.items():
        trace, m = run.traces[name], run.metrics[name]
        expected = mujoco_kinematics.gravity_effort(trace.q[-1].astype(float), world.load)
        pairs = [(trace.control_force[-1, k], expected[k]) for k in SHOWN_TORQUES]
        both = [f"{decimal(found, 2)} ({decimal(right, 2)})" for found, right in pairs]
        mass = run.readings["hand_mass"][name]
        rows[spec.LABELS[name]] = (world.kp[1], mass, *both, 1e3 * m.final_distance)
    return tables.number_table("robot", heads, rows)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs."""
    m = run.metrics
    accepted = [name[-1] for name, is_ in run.readings["mixed_accepted"].items() if is_]
    moved = {k: m[f"env_{k}"].moved_later for k in spec.ENVS}
    apart = max(
        study.largest_differences(run.traces[f"env_{k}"], run.traces[f"alone_{k}"], slice(ARM))["q"]
        for k in spec.ENVS
    )
    named, others = ([moved[k] for k in spec.ENVS if (k in spec.LATER) == is_] for is_ in (1, 0))
    still = max(others)
    lines = [
        f"One of the four targets is beyond reach. Rows {listed(accepted)} are accepted.",
        f"After the second command, the named environments moved by {mm(min(named))} mm or more, "
        + (f"the others by {1e6 * still:.2g} µm or less." if still else "the others did not move."),
        "Positions of arm joints in a row and in the same run alone differ by up to "
        f"{1e6 * apart:.2f} µrad.",
        *(
            f"The hand stops {mm(m[name].final_distance)} mm from its target ({spec.LABELS[name]})."
            for name in spec.VARIANTS
        ),
    ]
    return bullets(lines)
