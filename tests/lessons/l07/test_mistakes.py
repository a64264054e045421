"""Each symptom is found where it appears, and not where nothing is wrong."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from robo_genesis.lessons.l07 import mistakes


class Balls:
    """Four falling balls, as a scene and as its entity; a list of bools is read rightly or not."""

    def __init__(self, right: bool) -> None:
        self.right, self.z = right, np.ones(4)

    def reset(self, envs_idx=(True,) * 4) -> None:
        wrong = isinstance(envs_idx, list) and not self.right
        self.z[np.array([bool(one) for one in envs_idx], int if wrong else bool)] = 1

    def step(self) -> None:
        self.z = self.z - 0.1

    def get_pos(self):
        return torch.tensor(np.stack([self.z] * 3, axis=1))


@pytest.mark.parametrize("right", [True, False])
def test_a_list_of_bools(right):
    balls = Balls(right)
    assert mistakes.list_of_bools(balls, balls, torch).shown is not right


@pytest.mark.parametrize("key", [-1, (-1,)])
def test_the_key_of_the_background(key):
    link = SimpleNamespace(idx=3, entity=SimpleNamespace(idx=7))
    scene = SimpleNamespace(segmentation_idx_dict={0: key, 18: (7, 3)})
    found = mistakes.background_key(scene, SimpleNamespace(idx=7, links=[link]))
    assert found.shown is (key == -1)


@pytest.mark.parametrize("wrong", [None, "outside", "accepted", "touches", "descending"])
def test_the_symptoms_of_the_scenes(wrong):
    readings = {
        "pixels": {"outside_wrist": 1.0 * (wrong == "outside"), "wide_wrist": 9.0},
        "reach": {"below_accepted": 2 - (wrong == "accepted"), "below_touches": wrong != "touches"},
        "contacts": {"wide_descending": wrong != "descending"},
    }
    found = mistakes.symptoms(SimpleNamespace(readings=readings))
    assert all(one.passed for one in found) is (wrong is None)
