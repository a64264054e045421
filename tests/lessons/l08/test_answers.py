"""What the lab's own answers say, in the real engine."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l08 import capstone, metrics, spec
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


def episodes(gs, case, **options):
    world = picking.build(gs, case)
    joints = describe(SimpleNamespace(readings={}), world.robot)
    return picking.run(world, joints, case, **options)


@pytest.mark.parametrize("name", ANSWERS)
def test_an_answer_of_the_lab_is_true(real_engine, name):
    changes, counted, least, most = ANSWERS[name]
    case = replace(spec.EXACT, starts=STARTS, **{"beliefs": STARTS} | changes)
    found = metrics.episodes_metrics(episodes(real_engine.gs, case)[0], case)
    assert least <= getattr(found, counted) <= most


OWN, ATTACK = (capstone.CASES[name] for name in ("own", "attack"))
FURTHER = {
    "half_the_step": replace(ATTACK, substeps=2 * ATTACK.substeps),
    "more_room": replace(OWN, size=(0.04, 0.046, 0.09)),
}


@pytest.mark.parametrize("name", FURTHER)
def test_the_rule_of_the_capstone_survives_further_attacks(real_engine, name):
    case = FURTHER[name]
    good = metrics.good(episodes(real_engine.gs, case)[0], case)
    assert (good == solutions("l08", "capstone")["fails"](case)).sum() <= 8


class Replayed(picking.Expert):
    """Sends the actions of the rows (n, e, 9), each as long as a row lasts."""

    actions: list[np.ndarray]

    def act(self, q, qd):
        self.since += 1
        return self.actions[(self.since[0] - 1) // spec.EXACT.commands]


@pytest.mark.parametrize(
    ("starts", "least", "most"),
    [(spec.FEW, 62, 64), (spec.FEW[spec.ORDER], 0, 6)],  # those of other episodes
)
def test_the_actions_of_the_rows_work_from_their_own_starts_alone(
    real_engine, monkeypatch, starts, least, most
):
    every = spec.EXACT.commands
    sent = episodes(real_engine.gs, spec.EXACT)[1].sent
    monkeypatch.setattr(Replayed, "actions", sent[every - 1 :: every], raising=False)
    case = replace(spec.EXACT, starts=starts)
    trace, _ = episodes(real_engine.gs, case, of=Replayed)
    assert least <= metrics.episodes_metrics(trace, case).in_bowl <= most
