"""The decimal numbers that prose of L09 may hold: configured inputs and calculations by hand."""

import numpy as np
from scipy.special import stdtrit

from robo_genesis.core import statistics
from robo_genesis.lessons.l09 import spec

GOOD = np.array([6, 8, 7, 9, 5, 8, 7, 6])  # Successes of 16, in practice
MEAN, LOW, HIGH = statistics.of_groups(GOOD / 16)

CONFIGURED = {
    "duration of an episode [s]": spec.TRIED.steps * spec.TRIED.dt,
    "learning rate at the beginning": 0.002,
    "where Student's t of a 95 % interval is taken": 0.975,
    "t of eight networks": round(float(stdtrit(7, 0.975)), 3),
    "mean share of an example": MEAN,
    "the same [%]": 100 * MEAN,
    "1 minus it": 1 - MEAN,
    "spread of its successes": round(float(np.std(GOOD, ddof=1)), 2),
    "spread of its shares [%]": round(float(np.std(GOOD, ddof=1)) / 0.16, 2),
    "half width of its interval [%]": round(100 * (HIGH - MEAN), 1),
    "its lower end [%]": round(100 * LOW, 1),
    "its upper end [%]": round(100 * HIGH, 1),
    "variance of its successes": round(float(np.var(GOOD, ddof=1)), 2),
    "the same for tosses of a coin": round(16 * MEAN * (1 - MEAN), 2),
    "output for a finger in an example [mm]": 19.9,
}
