"""Each symptom is found where it appears, and not where nothing is wrong."""

from types import SimpleNamespace

import pytest
import torch
from lessons.l08.made_batches import episodes

from robo_genesis.lessons.l08 import mistakes
from robo_genesis.sim.arm import picking

GOOD, BAD = {"good": True, "opening": 0.05}, {"good": False, "opening": 0.0}
PUSHED = BAD | {"moved": 0.03, "late": True}


@pytest.fixture
def outcomes(monkeypatch):
    """Return a list of the outcomes of the batches that will be run."""
    found = []
    run = lambda world, joints, case: (episodes(case, **found.pop(0)), None)  # noqa: E731
    monkeypatch.setattr(picking, "run", run)
    return found


@pytest.mark.parametrize("name", ["empty_hand", "too_high", "pushed"])
@pytest.mark.parametrize("wrong", [True, False])
def test_a_grasp_in_the_wrong_place(outcomes, name, wrong):
    symptoms = {"empty_hand": [BAD], "too_high": [GOOD, BAD], "pushed": [PUSHED]}[name]
    outcomes += symptoms if wrong else [GOOD] * len(symptoms)
    assert getattr(mistakes, name)(None, None).shown is wrong


@pytest.mark.parametrize("speed", [0.3, 0.015])
def test_a_mass_without_its_inertia(outcomes, monkeypatch, speed):
    outcomes += [BAD, GOOD]
    monkeypatch.setattr(mistakes, "set_link_mass", lambda body, link, mass, rows: mass)
    monkeypatch.setattr(mistakes, "spin", lambda world: world.spin)
    body = SimpleNamespace(links=[SimpleNamespace(name="box")])
    light, dense = (SimpleNamespace(spin=of, body=body) for of in (speed, 0.015))
    assert mistakes.mass_alone(light, dense, None).shown is (speed > 0.015)


@pytest.mark.parametrize("entries", [4, 0])
def test_contacts_without_the_mask(entries):
    contacts = {"valid_mask": torch.zeros((16, entries)), "force_a": torch.ones((16, entries, 3))}
    scene = SimpleNamespace(reset=lambda: None, step=lambda: None)
    body = SimpleNamespace(get_contacts=lambda with_entity: contacts)
    world = SimpleNamespace(scene=scene, body=body, robot=None)
    assert mistakes.no_mask(world).shown is (entries > 0)


def test_a_start_that_is_solved_is_refused(monkeypatch):
    assert "1 of 16" in mistakes.solved(None).evidence
    assert mistakes.solved(None).shown
    monkeypatch.setattr(picking, "build", lambda gs, case: None)
    assert not mistakes.solved(None).shown
