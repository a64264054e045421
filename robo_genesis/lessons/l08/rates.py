"""Batches of the page on rates: a grid of errors, two experts, boxes, a clock."""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import FloatArray, read_only
from robo_genesis.sim.arm.picking import PickCase

from . import spec

# Samples of 0.1 s, for 6 s.
STEPS: dict[str, Any] = {"dt": 0.1, "substeps": 20, "commands": 10, "steps": 60}

# Place of the cylinder, number of errors along each axis, and the largest one [m].
PLACE, CELLS, MOST = (0.5, -0.1), 16, 0.03

# Standard deviation of the error along each axis [m], and number of starts for both
# experts.
NOISE, PAIRS = 0.005, 128

# Place of the pads when the fingers close, from their command, with the opposite sign
# [m].
SAG = read_only((0.0048, -0.0009))

# Samples of the runs with clocks and strides, of which the slowest needs 60.
LONGER = 70

CLOCKS = (
    10,
    20,
    30,
    0,
)  # Outer steps after which the descent ends, 0 where it is measured

STRIDES = (
    0.024,
    0.012,
    0.006,
)  # Largest changes of a joint's command in one outer step [rad]

TIMED = 16  # Episodes with each clock, and with each stride

# Size of the box [m], and its largest yaw [rad].
OBLONG, TURNED = (0.05, 0.07, 0.06), np.pi / 4


def batch(
    starts: FloatArray, errors: FloatArray | float = 0.0, **more: Any
) -> PickCase:
    """Return episodes with these starts (e, 2) and errors (e, 2) of what the expert believes."""
    settings = STEPS | more
    return replace(spec.ASKEW, starts=starts, beliefs=starts + errors, **settings)


def cases() -> dict[str, PickCase]:
    """Return the batches that have metrics, by name."""
    rng = np.random.default_rng(5)
    line = np.linspace(-MOST, MOST, CELLS)
    errors = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    least, most = np.transpose(spec.REGION)
    starts = rng.uniform(least, most, (PAIRS, 2))
    noise = rng.normal(0.0, NOISE, (PAIRS, 2))
    yaws = rng.uniform(-TURNED, TURNED, PAIRS)
    timed = spec.starts(4, seed=6)
    return {
        "grid": batch(np.tile(PLACE, (len(errors), 1)), errors),
        "plain": batch(starts, noise),
        "corrected": batch(starts, noise + SAG),
        "compensated": batch(starts, noise, compensated=True),
        "elliptic": batch(starts, noise, cone="elliptic"),
        "timed": batch(
            np.tile(timed, (len(CLOCKS), 1)),
            timed=np.repeat(CLOCKS, TIMED),
            steps=LONGER,
        ),
        "paced": batch(
            np.tile(timed, (len(STRIDES), 1)),
            stride=np.repeat(STRIDES, TIMED),
            steps=LONGER,
        ),
        "boxes": batch(starts, shape="box", size=OBLONG, yaws=yaws),
    }


CASES = cases()


def parameters() -> dict[str, Any]:
    """Return every configured input of the page as JSON values, for the evidence key."""
    return inputs(CASES, counted=list(spec.EXPECTED_MODEL))
