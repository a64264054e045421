"""Each symptom is found where it appears, and not where nothing is wrong."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from robo_genesis.core.trace import Episodes
from robo_genesis.lessons.l08 import mistakes
from robo_genesis.sim.arm import picking


def batch(case, good, opening=0.0, moved=0.0, late=False):
    """Return made-up episodes that all succeed or all fail."""
    length, at = case.steps + 1, np.arange(case.steps + 1)
    ends = np.cumsum([6, 13 if late else 5, 3, 5, 8, 5, 3, 5])
    phase = (at[:, None] >= ends).sum(axis=1).astype(np.int8)[:, None].repeat(16, axis=1)
    held = (phase >= picking.LIFT) & (phase < picking.OPEN) & good
    place = np.tile(np.column_stack([case.starts, np.full(16, case.size[2] / 2)]), (length, 1, 1))
    place[phase >= picking.CLOSE, 0] += moved
    place[held, 2] += 0.1
    place[(phase >= picking.MOVE) & good, :2] = case.bowl_at
    q = np.tile(np.float32(case.q_start), (length, 16, 1))
    q[..., -2:] = opening / 2
    quat = np.tile(np.float32([1, 0, 0, 0]), (length, 16, 1))
    force = np.stack([held, held], axis=-1) * np.float32(12)
    return Episodes(at * case.dt, phase, q, np.float32(place), quat, force, held.astype(np.int8))


@pytest.mark.parametrize("wrong", [True, False])
@pytest.mark.parametrize(
    ("mistake", "symptoms"),
    [
        (mistakes.empty_hand, [{"good": False}]),
        (mistakes.too_high, [{"good": True, "opening": 0.05}, {"good": False}]),
        (mistakes.pushed, [{"good": False, "moved": 0.03, "late": True}]),
    ],
)
def test_a_grasp_in_the_wrong_place(monkeypatch, mistake, symptoms, wrong):
    found = symptoms if wrong else [{"good": True, "opening": 0.05}] * len(symptoms)
    left = iter(found)
    monkeypatch.setattr(picking, "run", lambda world, joints, case: (batch(case, **next(left)), 0))
    assert mistake(None, None).shown is wrong


@pytest.mark.parametrize("entries", [4, 0])
def test_contacts_without_the_mask(entries):
    shape = (16, entries)
    contacts = {name: torch.zeros(shape) for name in ("geom_a", "valid_mask")}
    contacts["force_a"] = torch.ones((*shape, 3))
    world = SimpleNamespace(
        scene=SimpleNamespace(reset=lambda: None, step=lambda: None),
        body=SimpleNamespace(get_contacts=lambda with_entity: contacts),
        robot=None,
    )
    assert mistakes.no_mask(world).shown is (entries > 0)


def test_a_start_that_is_solved_is_refused(monkeypatch):
    found = mistakes.solved(None)
    assert found.shown
    assert "1 of 16" in found.evidence
    monkeypatch.setattr(picking, "build", lambda gs, case: None)
    assert not mistakes.solved(None).shown
