"""Rows, trainings of small networks, and who commands what."""

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
import torch

from robo_genesis.lessons.l09 import cloning, spec
from robo_genesis.lessons.l09.cloning import AFTER, Acting, Clones, Rows, Scale
from robo_genesis.lessons.l09.experts import KINDS
from robo_genesis.lessons.l09.settings import INPUTS, Training

SMALL = Training(networks=2, width=8, steps=100, batch=32)


@pytest.fixture
def rows():
    """Rows of 4 episodes; in the second half of the last one, nothing is learned."""
    rng = np.random.default_rng(0)
    seen = {name: rng.random((12, 4, of), np.float32) for name, of in INPUTS.items()}
    used = np.ones((12, 4), bool)
    used[6:, -1] = False
    return Rows(seen, 2 * seen["q"] - 1, used)


def test_the_last_command_stays_at_the_end_of_a_chunk():
    found = cloning.chunks(np.arange(3.0).reshape(3, 1, 1), 2)
    assert found[:, 0, :, 0].tolist() == [[0, 1], [1, 2], [2, 2]]


def test_a_scale_restores_and_has_a_least_spread():
    values = np.array([[1.0, 3.0], [3.0, 3.0]])
    scale = Scale.of(values, 1e-3)
    assert scale.without(values)[:, 0].tolist() == [-1, 1]
    assert scale.without(values + 1e-3)[0, 1] == pytest.approx(1)
    assert scale.restored(scale.without(values)).tolist() == values.tolist()
    near = np.float32([[1], [1 + 2**-23]])
    assert Scale.of(near, 0.0).spread == 2**-24


def test_the_least_spread_of_a_training_is_that_of_inputs(rows):
    clones = Clones(replace(SMALL, least=9.0), rows)
    assert (clones.given.spread == 9).all()
    assert (clones.made.spread < 1).all()


def test_parts_of_rows_join_to_the_whole(rows):
    whole = cloning.joined(rows.of(slice(1)), rows.of(slice(1, None)))
    np.testing.assert_equal(whole, rows)


def test_a_training_repeats_to_the_bit_and_another_seed_does_not(rows):
    torch.set_num_threads(2)
    one = Clones(SMALL, rows)
    assert torch.get_num_threads() == 2
    rows.command[~rows.used] = 9.0
    again, other = Clones(SMALL, rows), Clones(replace(SMALL, seed=1), rows)
    assert np.array_equal(one.losses, again.losses)
    assert one.digests().tolist() == again.digests().tolist()
    assert one.digests()[1] == other.digests()[0]  # seeds count on
    assert len({*one.digests(), *other.digests()}) == 3


def test_a_linear_function_is_learned(rows):
    clones = Clones(replace(SMALL, steps=1000, width=32), rows)
    assert clones.losses.shape == (10, 2)
    assert (clones.losses[-1] < clones.losses[0] / 10).all()
    assert (clones.errors(rows) < 0.1).all()
    rows.command[rows.used] += 1
    assert clones.errors(rows) == pytest.approx([1, 1], abs=0.05)


def test_a_difference_is_one_to_the_position_of_the_arm_alone(rows):
    """Networks that learn a constant output answer with it."""
    q = np.broadcast_to(rows.seen["q"][:1], rows.command.shape)
    command = np.where(np.arange(9) < 7, q + 0.1, 0.03)
    constant = Rows(rows.seen | {"q": q}, command, rows.used)
    clones = Clones(replace(SMALL, difference=True, chunk=2), constant)
    found = clones({name: of[3] for name, of in rows.seen.items()})[:, 1]
    right = np.where(np.arange(9) < 7, rows.seen["q"][3] + 0.1, 0.03)
    assert found == pytest.approx(right, abs=1e-4)


def test_each_network_answers_for_its_part_of_the_rows(rows):
    clones = Clones(SMALL, rows)
    now = {name: of[5] for name, of in rows.seen.items()}
    inputs = clones.given.without(clones.inputs(now))
    for k, part in enumerate([slice(2), slice(2, 4)]):
        alone = [(weights[[k]], bias[[k]]) for weights, bias in clones.layers]
        right = cloning.forward(alone, inputs[None, part])[0]
        assert clones.outputs(now)[part, 0] == pytest.approx(right, abs=1e-6)


STARTS = np.array([[0.5, 0.0], [0.45, -0.1]])
CASE = replace(spec.TRIED, starts=STARTS, beliefs=STARTS)
GIVEN = CASE, np.ones((9, 2, 7)), np.array([True, False])
STATE = np.tile(CASE.q_start, (2, 1)), np.zeros((2, 9)), np.ones((2, 7))


def test_what_is_shown_is_clean_and_what_is_executed_is_noisy():
    shown = cloning.Showing(Training(noise=0.01), *GIVEN)
    expert = KINDS["prompt"](*GIVEN)
    pairs = [(shown.act(*STATE), expert.act(*STATE).copy()) for _ in range(20)]
    done, clean = map(np.stack, zip(*pairs, strict=True))
    rows = shown.rows()
    assert np.array_equal(rows.command, np.float32(clean))
    assert np.array_equal(rows.seen["last"][1:], rows.command[:-1])
    assert (done - clean)[..., :7].std() == pytest.approx(0.01, rel=0.15)
    assert not (done - clean)[..., 7:].any()
    assert rows.used.sum(axis=0).tolist() == [20, AFTER]  # done from the beginning
    assert rows.used[:AFTER].all()


def test_clones_execute_a_whole_chunk_before_they_look_again():
    chunk = np.arange(90.0).reshape(2, 5, 9)
    chunk[..., 7:] = 0.019, 0.021
    acting = Acting(Mock(training=spec.FIVE, return_value=chunk), *GIVEN)
    sent = np.stack([acting.act(*STATE) for _ in range(6)], axis=1)
    assert acting.clones.call_count == 2
    assert np.array_equal(sent[..., :7], chunk[:, [0, 1, 2, 3, 4, 0], :7])
    assert (sent[..., 7:] == [0, 0.04]).all()
    assert np.array_equal(acting.seen[3]["last"], np.float32(sent[:, 2]))


@pytest.mark.parametrize("kind", KINDS)
def test_the_machine_beside_clones_is_of_their_expert(kind):
    training = Training(expert=kind)
    acting = Acting(Mock(training=training, return_value=np.ones((2, 1, 9))), *GIVEN)
    assert type(acting.beside) is KINDS[kind]
    acting.act(*STATE)
    assert acting.seen[0]["phase"].argmax(axis=1).tolist() == acting.phase.tolist()
