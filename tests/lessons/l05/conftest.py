"""Reaches of L05 without Genesis: answers by damped least squares in NumPy, runs by MuJoCo."""

from dataclasses import replace

import numpy as np
import pytest
from robot_runs import LINKS, answer, assigned, driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05 import restarts, spec
from robo_genesis.lessons.l05.pages import SOLUTIONS
from robo_genesis.lessons.l05.run import control_case
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.franka import Q_START


@pytest.fixture(scope="session")
def reaches(joints) -> Experiment:
    """A run of the page about many solutions that passes its checks."""
    found = answer(spec.TARGET, Q_START, 100)
    runs = {n: driven(control_case(case, found), LINKS) for n, case in spec.CASES.items()}
    refused = answer(spec.BEYOND_REACH, Q_START, 20).q.astype(float)[None]
    apart, angle = kinematics.distances(found.error)
    solver = {"residual_m": float(apart), "residual_rad": float(angle), "jacobian_difference": 0.0}
    runs["unreachable"] = assigned(spec.UNREACHABLE.start, LINKS, runs["baseline"], refused)
    many = np.repeat(refused, spec.RESTARTS, axis=0)
    runs["many_starts"] = assigned(spec.MANY_STARTS.start, LINKS, runs["baseline"], many)
    return Experiment(
        page=replace(SOLUTIONS, runs={name: SOLUTIONS.runs[name] for name in runs}),
        traces=runs,
        links=LINKS,
        readings={
            "model": spec.EXPECTED_MODEL, "ik": solver, "ik_repeated": {"entries_that_differ": 0},
            "ik_restarts": dict.fromkeys(restarts.COMPARED, 0),
        },
        frames={},
        rendered=False,
        joints=joints,
    )  # fmt: skip


@pytest.fixture(scope="session")
def solved(reaches):
    """The plausible runs with answers from many starts and for the targets of both planes."""
    traces = dict(reaches.traces)
    for name in ("many_starts", *spec.PLANES):
        case = spec.QUESTIONS[name]
        target = kinematics.Pose(case.positions, case.quat)
        q = kinematics.solve(
            target, case.starts[:, :7], *spec.ARM_LIMITS, iterations=100, damping=0.01
        )
        postures = np.hstack([q, case.starts[:, 7:]])
        traces[name] = assigned(case.start, LINKS, traces["baseline"], postures)
    return replace(reaches, traces=traces)
