"""Worlds of L06 without Genesis: answers by damped least squares in NumPy, runs by MuJoCo."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import beginning
from lessons.experiments import experiment_of
from robot_runs import LINKS, answer, driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l06 import checks, spec, study
from robo_genesis.lessons.l06.metrics import world_metrics
from robo_genesis.lessons.l06.pages import LECTURE
from robo_genesis.lessons.l06.run import Environment

ROUNDING = np.float32(1.2e-7)

COMPARED = (9, 0, 0, 9, 0, 0, 9, 4, 1e-3, 9, 0, 0, 9, 9, 1)
PRESSED = (*COMPARED, 0.1, 180, 150, 180, 150, 0, 0, 0, 0)
"""Plausible comparisons, height of the lowest pressed hand, and forces."""


def run_of(world: Environment) -> Trace:
    """Return the run of one world."""
    first, last = (answer(world.positions[k], world.q_start, 50).q for k in (0, -1))
    targets = np.repeat(first[None].astype(float), world.steps, axis=0)
    targets[world.switch :] = last
    return driven(world.commanding(targets), LINKS, world.load)


def swept(runs) -> dict:
    """Return readings of the sweep: those of recorded runs, plausible ones of others."""
    m = {name: world_metrics(runs[name], spec.VARIANTS[name]) for name in spec.SWEPT}
    readings = {"sweep_end": {}, "sweep_overshoot": {}}
    for (kp, kv, load), row in spec.SWEEP.items():
        recorded = m[
            "stiff_robot" if kp > kv else "loaded_robot" if load else "plain_robot"
        ]
        share = 0.5 if kp > kv and load else 1.0
        end = m["loaded_robot"].final_distance if share < 1 else recorded.final_distance
        readings["sweep_end"][row] = share * end
        readings["sweep_overshoot"][row] = recorded.overshoot if kp < 8 else 0.05
    return readings


@pytest.fixture(scope="session")
def worlds(joints) -> Experiment:
    """A run of the lecture, without a camera, that passes its checks."""
    runs = {name: run_of(world) for name, world in spec.WORLDS.items()}
    for k in spec.ENVS:
        runs[f"alone_{k}"] = replace(runs[f"env_{k}"], q=runs[f"env_{k}"].q + ROUNDING)
    runs |= {
        name: run_of(w) for name, w in spec.VARIANTS.items() if name != "plain_robot"
    }
    runs["plain_robot"] = beginning(runs["env_0"], spec.SWITCH)
    for name, world in spec.COPIES.items():
        runs[name] = beginning(runs[f"env_{name[-1]}"], world.steps)
    masses = {
        name: spec.HAND_MASS + world.load for name, world in spec.VARIANTS.items()
    }
    equality = study.LECTURE_READINGS[study.EQUALITY].units
    residuals = [study.residual(position, joints) for position in spec.MIXED]
    known = swept(runs) | {
        "model": spec.EXPECTED_MODEL,
        "mixed": dict(zip(study.READINGS["mixed"].units, residuals, strict=True)),
        "mixed_accepted": {f"env_{k}": int(r < 1) for k, r in enumerate(residuals)},
        "hand_mass": masses,
        study.EQUALITY: dict(zip(equality, PRESSED, strict=True)),
    }
    all_checks = (*checks.WITHOUT_CAMERA, *checks.LECTURE)
    page = replace(LECTURE, checks=all_checks, camera=False)
    return experiment_of(page, runs, known, LINKS, {}, joints)
