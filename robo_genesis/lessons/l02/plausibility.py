"""What arrays of a dropped box cannot be, whatever metrics and checks they give."""

from robo_genesis.core.plausibility import refuse
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.sim.plausible_bodies import falling_box


def require_possible_runs(run: Experiment) -> None:
    """Require of each run what every drop has.

    Raises:
        BundleRefused: `stamps`, `pose` or `start`.
    """
    for name, case in run.cases.items():
        refuse(f"arrays/{name}.npz", falling_box(run.traces[name], case))
