"""What is recorded of one kind of clones, and what is counted."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.metrics import CaseMetrics, array, metric
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import TimeSeries

from .settings import Training

# The rungs of `ladder.of_object`, in their order.
RUNGS = ("held", "lifted", "carried", "released", "contained", "resting")


@dataclass(frozen=True, slots=True)
class Copies(TimeSeries):
    """The training of k networks, and e episodes in which they act.

    | field | shape | meaning |
    |---|---|---|
    | `t` | (n+1,) | steps of the optimiser |
    | `loss` | (n, k) | mean squared error of scaled outputs since the step before |
    | `error` | (k,) | median error of a joint's command in other demonstrations [rad] |
    | `weights` | (k,) | a digest of all weights of the network |
    | `rungs` | (e,) | rungs that the episode passes; network j acts in the j-th part |
    """

    t: FloatArray = array("steps", "state", "1", "steps of the optimiser", "float64")
    loss: FloatArray = array(
        "loss", "step network", "1", "mean squared error of scaled outputs"
    )
    error: FloatArray = array(
        "error_rad", "network", "rad", "median error of a command", "float64"
    )
    weights: np.ndarray = array("weights", "network", "1", "digest of weights", "int64")
    rungs: np.ndarray = array("rungs", "env", "1", "rungs passed", "int8")

    @property
    def good(self) -> np.ndarray:
        """Return which episodes (e,) succeed."""
        return np.asarray(self.rungs == len(RUNGS))

    @property
    def shares(self) -> FloatArray:
        """Return the share of successes of each network (k,)."""
        return self.good.reshape(len(self.weights), -1).mean(axis=1)


@dataclass(frozen=True, slots=True)
class CopiesMetrics(CaseMetrics):
    """How well clones learned, and how many of their episodes pass each rung."""

    loss: float = metric("%", "loss", "loss")
    error: float = metric("rad", "error of a command", "error_rad")
    held: float = metric("1", "held", "rungs")
    lifted: float = metric("1", "lifted", "rungs")
    carried: float = metric("1", "carried", "rungs")
    released: float = metric("1", "released", "rungs")
    contained: float = metric("1", "contained", "rungs")
    resting: float = metric("1", "success", "rungs")


def copies_metrics(trace: Copies, case: Training) -> CopiesMetrics:
    """Return the last loss, the median error of all networks, and counts."""
    passed = [(trace.rungs > k).sum() for k in range(len(RUNGS))]
    loss = 100 * float(trace.loss[-1].mean())
    return CopiesMetrics(loss, float(np.median(trace.error)), *passed)
