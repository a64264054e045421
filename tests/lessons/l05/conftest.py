"""Reaches of L05 without Genesis: answers by damped least squares in NumPy, runs by MuJoCo."""

import numpy as np
import pytest
from lessons.experiments import experiment_of
from robot_runs import LINKS, answer, assigned, driven, solve

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.lessons.l05.pages import SOLUTIONS
from robo_genesis.lessons.l05.run import control_case
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.franka import Q_START


@pytest.fixture(scope="session")
def reaches(joints) -> Experiment:
    """The runs and answers of the page about many solutions, which pass its checks."""
    found = answer(spec.TARGET, Q_START, 100)
    runs = {
        n: driven(control_case(case, found), LINKS) for n, case in spec.CASES.items()
    }
    for name, case in spec.QUESTIONS.items():
        starts = case.starts
        if name == "vertical_restarted":  # where the first start fails, another one
            failed = ~study.answers(runs["vertical"], case)["accepted"]
            starts = np.where(
                failed[:, None], spec.RANDOM_STARTS[1 : 1 + case.steps], starts
            )
        target = kinematics.Pose(case.positions, case.quat)
        limits = spec.ARM_LIMITS
        q = solve(target, starts[:, :7], *limits, iterations=100, damping=0.01)
        postures = np.hstack([q, starts[:, 7:]])
        runs[name] = assigned(case.start, LINKS, runs["baseline"], postures)
    apart, angle = map(float, kinematics.distances(found.error))
    known = {
        "model": spec.EXPECTED_MODEL,
        "ik": {"residual_rad": angle, "low_residual_rad": angle, "low_tip_m": -0.0623}
        | dict.fromkeys(("residual_m", "low_residual_m"), apart),
        "ik_residuals": dict.fromkeys(spec.PRECISE, 4e-6),
        "iterations": dict.fromkeys(spec.PRECISE, 5),
    }
    return experiment_of(SOLUTIONS, runs, known, LINKS, {}, joints)
