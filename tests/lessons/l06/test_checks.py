"""The named checks pass for plausible worlds, and each fails when one input changes."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import put, reading, shift, trace
from lessons.experiments import require_spoilers

from robo_genesis.lessons.l06 import spec
from robo_genesis.lessons.l06.run import commands
from robo_genesis.sim.arm.engine_kinematics import IkAnswer, NotAccepted
from robo_genesis.sim.arm.kinematics import HAND

PLAIN, STIFF, LOADED, _ = spec.VARIANTS


def moved_hand(name, by, samples):
    return trace(name, link_pos=shift((samples, HAND, 0), by))


def still(name):
    return trace(
        name, link_pos=lambda at: put(slice(spec.SWITCH, None), at[spec.SWITCH])(at)
    )


def swapped(run, one, other):
    return replace(
        run, traces={**run.traces, one: run.traces[other], other: run.traces[one]}
    )


CHANGES = [
    ("mapping", reading("model", "dofs", 8)),
    ("stamps", trace("env_3", t=lambda t: 2 * t)),
    ("acceptance_per_row", reading("mixed_accepted", "env_2", 1)),
    ("acceptance_per_row", reading("mixed", "row_2_m", 2.4)),
    # an answer that was commanded beyond its tolerance
    ("acceptance_per_row", trace(LOADED, target=shift(..., 1e-2))),
    ("arrived", moved_hand("alone_1", 0.05, slice(-1, None))),
    ("row_equals_alone", trace("alone_2", qd=shift(40, 1e-4))),
    ("row_equals_alone", trace("alone_0", target=shift(..., 1e-5))),
    ("permuted_rows", trace("permuted_3", q=shift(7, 1e-6))),
    ("pressed_on_the_floor", reading("equality", "pressed_permuted_differ", 1)),
    ("pressed_on_the_floor", reading("equality", "pressed_again_differ", 1)),
    ("pressed_on_the_floor", reading("equality", "pressed_again_compared", 0)),
    ("pressed_on_the_floor", reading("equality", "pressed_height", 0.05)),
    ("old_forces_after_a_reset", reading("equality", "force_1_after", 9.0)),
    ("old_forces_after_a_reset", reading("equality", "force_3_next", 9.0)),
    ("old_forces_after_a_reset", reading("equality", "joints_3_changed", 1)),
    ("answers_depend_on_the_row", reading("equality", "one_start_differ", 1)),
    ("answers_depend_on_the_row", reading("equality", "one_start_compared", 0)),
    ("answers_depend_on_the_row", reading("equality", "restarts_apart", 0.0)),
    ("sweep_repeats_the_runs", reading("sweep_end", spec.SWEEP[1.0, 1.0, 0.0], 0.1)),
    ("price_of_stiffness", reading("sweep_overshoot", spec.SWEEP[2.0, 1.0, 0.5], 0.0)),
    ("price_of_stiffness", reading("sweep_end", spec.SWEEP[2.0, 1.0, 2.0], 0.1)),
    ("price_of_stiffness", lambda run: swapped(run, STIFF, "unlimited_robot")),
    ("stiffest_fail", reading("sweep_overshoot", spec.SWEEP[16.0, 2.0, 0.0], 4e-3)),
    ("untouched_keep_their_state", moved_hand("env_0", 2e-5, slice(300, None))),
    # a neighbour that leaked into a row, and an environment without its second command
    ("untouched_keep_their_state", trace("beside_2", q=shift(35, 1e-6))),
    ("untouched_keep_their_state", still("env_1")),
    ("partial_reset", trace("again_1", q=shift(3, 1e-6))),
    ("own_gains_and_mass", reading("hand_mass", LOADED, spec.HAND_MASS)),
    # a load in another row, a stiff row that kept its gains, a plain row with a
    # neighbour's
    ("own_gains_and_mass", lambda run: swapped(run, STIFF, LOADED)),
    ("own_gains_and_mass", lambda run: trace(STIFF, q=run.traces[PLAIN].q)(run)),
    ("own_gains_and_mass", lambda run: trace(PLAIN, q=run.traces[STIFF].q)(run)),
]


def test_each_check_fails_when_its_input_changes(worlds):
    require_spoilers(worlds, CHANGES)


def test_a_row_that_is_not_accepted_is_not_commanded():
    worlds = [spec.WORLDS[f"env_{k}"] for k in spec.ENVS]
    q, error = (
        np.tile(np.float32(spec.FIRST.q_start), (4, 1)),
        np.zeros((4, 6), np.float32),
    )
    assert commands(worlds, IkAnswer(q, error)) == pytest.approx(q)
    error[2, 0] = 1e-3
    q[3, 0] = np.nan
    with pytest.raises(NotAccepted, match=r"Rows \[2, 3\] are refused"):
        commands(worlds, IkAnswer(q, error))
