from dataclasses import replace

import numpy as np
import pytest
from falling import falling

from robo_genesis.sim import laws as rules
from robo_genesis.sim.laws import apart, kept

RUN = falling(1.0)
TILTED = replace(RUN, link_quat=RUN.link_quat * np.float32(1.001))
NEARLY = replace(RUN, link_pos=RUN.link_pos + np.float32(3e-5))
FALL, SPEED = np.array([[0.0], [-0.2], [-0.6]]), np.array([[-1.0], [-3.0], [-5.0]])
"""Positions [m] and velocities [m/s] every 0.1 s: the mean velocities are -2 and -4 m/s."""


def codes(breaches):
    return [breach.code for breach in breaches]


@pytest.mark.parametrize(
    ("breaches", "found"),
    [
        (rules.times(RUN, 30, 0.01), []),
        (rules.times(RUN, 29, 0.01), ["stamps"]),
        (rules.times(RUN, 30, 0.0102), ["stamps"]),
        (rules.unit_quaternions(RUN.link_quat), []),
        (rules.unit_quaternions(TILTED.link_quat), ["pose"]),
        (rules.unit_quaternions(0 * RUN.link_quat), ["pose"]),
        (rules.mean_speed(FALL, SPEED, 0.1, 1e-9), []),
        (rules.mean_speed(FALL * 2, SPEED, 0.1, 0.9), ["motion"]),
        (rules.mean_speed(FALL * 2, SPEED, 0.1, 3.1), []),
        (rules.copied(RUN, {"short": falling(1.0, steps=20), "moved": NEARLY}, ()), []),
        (rules.copied(RUN, {"own": RUN}, {"own"}), []),
        (rules.copied(RUN, {"same": falling(1.0)}, ()), ["second-engine"]),
        (apart("a", "x", np.array([1.0, np.nan]), np.zeros(()), 2.0), ["a"]),
        (apart("a", "x", np.array([1.0, 2.0]), np.zeros(()), np.array([1.0, 2.0])), []),
        (
            apart("a", "x", np.array([1.0, 2.1]), np.zeros(()), np.array([1.0, 2.0])),
            ["a"],
        ),
        (apart("a", "x", np.zeros((0, 3)), np.zeros(()), 0.0), []),
    ],
)
def test_a_breach_has_the_code_of_its_rule(breaches, found):
    assert codes(breaches) == found


def test_a_check_names_the_first_law_that_a_run_breaks_and_the_entry_farthest_off():
    rows = np.array([[0.0, 0.2], [0.5, 0.0]])
    (wrong,) = kept("G1", apart("law", "effort [N·m]", rows, np.zeros(()), 0.1))
    assert (
        wrong.problem == "G1: effort [N·m] at index [1, 0] is 0.5, expected 0.0 ± 0.1"
    )
    assert (wrong.code, wrong.passed, wrong.recorded) == ("law", False, False)
    (right,) = kept("G1", apart("law", "effort [N·m]", rows, np.zeros(()), 0.5))
    assert right.passed
