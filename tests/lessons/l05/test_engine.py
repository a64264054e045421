"""Questions, answers and reaches in the real engine."""

from dataclasses import replace

import pytest

from robo_genesis.lessons.l05 import spec, study
from robo_genesis.lessons.l05.run import solve_all
from robo_genesis.sim.arm import kinematics

pytestmark = pytest.mark.engine


def test_answers_depend_on_their_start_alone_and_are_measured_where_the_engine_says(
    lab,
):
    of = spec.MANY_STARTS
    case = replace(of, positions=of.positions[:20], starts=spec.RANDOM_STARTS[:20])
    trace, errors = solve_all(lab.scene, lab.franka, lab.joints, case)
    again, _ = solve_all(lab.scene, lab.franka, lab.joints, case)
    assert (trace.q == again.q).all()
    found = study.answers(trace, case)
    apart, angle = kinematics.distances(errors)
    assert found["position"] == pytest.approx(apart, abs=spec.SAME_POSE[0])
    assert found["rotation"] == pytest.approx(angle, abs=1e-5)
    assert found["accepted"].any()
