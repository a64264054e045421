"""What the lab's own answers say, in the real engine."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.lessons.l08 import metrics, spec
from robo_genesis.sim.arm import picking
from robo_genesis.sim.arm.joints import describe

pytestmark = [pytest.mark.engine, pytest.mark.slow]

STARTS = spec.starts(8, seed=5)
NEAR = {"beliefs": STARTS - [0.005, 0]}
NOISE = {"beliefs": STARTS + np.random.default_rng(6).normal(0, 0.005, (64, 2))}
BOX = {"shape": "box", "size": (0.05, 0.05, 0.07)}

# What an answer changes, a metric, and its least and largest value.
ANSWERS = {
    "too_near": (NEAR, "carried", 0, 0),
    "too_near_box": (NEAR | BOX, "resting", 64, 64),
    "noise": (NOISE, "resting", 35, 50),
    "dense": ({"density": 8000.0}, "in_bowl", 60, 64),
    "dense_carried": ({"density": 8000.0}, "carried", 0, 43),
    "slippery": ({"friction": 0.1, "pads": 0.1}, "carried", 1, 60),
    "wide": (BOX | {"size": (0.05, 0.078, 0.07)}, "resting", 58, 64),
}


@pytest.mark.parametrize("name", ANSWERS)
def test_an_answer_of_the_lab_is_true(real_engine, name):
    changes, counted, least, most = ANSWERS[name]
    case = replace(spec.EXACT, starts=STARTS, **{"beliefs": STARTS} | changes)
    world = picking.build(real_engine.gs, case)
    joints = describe(SimpleNamespace(readings={}), world.robot)
    found = metrics.episodes_metrics(picking.run(world, joints, case)[0], case)
    assert least <= getattr(found, counted) <= most
