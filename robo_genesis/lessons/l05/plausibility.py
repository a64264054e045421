"""What arrays of a reach cannot be, whatever metrics and checks they give."""

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05.run import SolveCase
from robo_genesis.sim.arm.laws import assigned_postures, driven_run
from robo_genesis.sim.laws import refuse

MEASURES = False


def require_possible_runs(run: Experiment) -> None:
    """Require of each run the mechanics of the robot, or of assigned postures.

    A run is one that commands the posture in its own record.

    Raises:
        BundleRefused: `stamps`, `start`, `law`, `pose` or `motion`.
    """
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            breaches = assigned_postures(trace, case.start, run.links)
        else:
            breaches = driven_run(trace, case.commanding(trace.target[0]), run.links)
        refuse(f"arrays/{name}.npz", breaches)
