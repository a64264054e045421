"""What arrays of an environment cannot be, whatever metrics and checks they give."""

from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.arm.franka import per_joint
from robo_genesis.sim.arm.laws import commanded, driven_run
from robo_genesis.sim.laws import refuse

MEASURES = False

NET_FORCE = per_joint(*(1e-2,) * 7, 0.6, 0.6)
"""Tolerance of an internal force [N·m or N]. A hand that turns sideways pushes its fingers, which
hold each other; that force, up to 0.34 N here, the rule does not know."""


def require_possible_runs(run: Experiment) -> None:
    """Require of each run the mechanics of a robot with the gains and commands of its world.

    The mechanics are those of the robot alone, so the motion of a load is not compared with them.

    Raises:
        BundleRefused: `stamps`, `start`, `law`, `pose` or `motion`.
    """
    for name, world in run.cases.items():
        trace = run.traces[name]
        what = trace, world.commanding(trace.target), run.links
        breaches = commanded(*what) if world.load else driven_run(*what, NET_FORCE)
        refuse(f"arrays/{name}.npz", breaches)
