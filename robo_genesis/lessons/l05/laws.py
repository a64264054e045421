"""What reaches have in common by the mechanics of the robot."""

from robo_genesis.core.checks import Findings
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l05.run import SolveCase, command_path
from robo_genesis.sim.arm.laws import assigned_run, driven_run
from robo_genesis.sim.laws import kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Findings:
    """At each sample links and control forces are those of the driven or assigned robot."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, SolveCase):
            laws = assigned_run(trace, run.links, case.start.model)
        else:
            command = command_path(case, trace.target[-1])
            laws = driven_run(trace, case.commanding(command), run.links)
        yield from kept(name, laws)
