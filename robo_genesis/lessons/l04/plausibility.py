"""What arrays of a driven robot cannot be, whatever metrics and checks they give."""

from collections.abc import Iterator

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import study_spec
from robo_genesis.sim.arm.laws import assigned_path, driven_in_mujoco, driven_run
from robo_genesis.sim.laws import Breach, computed_again, copied, refuse, times
from robo_genesis.sim.mujoco import joints as mujoco_joints

MEASURES = False


def require_possible_runs(run: Experiment) -> None:
    """Require of each run in Genesis the mechanics of the robot; compute those in MuJoCo again.

    Raises:
        BundleRefused: `stamps`, `start`, `law`, `pose`, `motion` or `second-engine`.
    """
    for name, case in run.cases.items():
        if name in study_spec.SECOND_RUNS:
            breaches = in_mujoco(run, name)
        else:
            rules = assigned_path if name == study_spec.ASSIGNED else driven_run
            breaches = rules(run.traces[name], case, run.links)
        refuse(f"arrays/{name}.npz", breaches)


def in_mujoco(run: Experiment, name: str) -> Iterator[Breach]:
    """Yield what a run in MuJoCo does not have."""
    trace, case, second = run.traces[name], run.cases[name], study_spec.SECOND_RUNS[name]
    by_genesis = {n: of for n, of in run.traces.items() if n not in study_spec.SECOND_RUNS}
    yield from times(trace, case.steps, case.dt)
    yield from copied(trace, by_genesis)
    if second.integrator == "Euler":
        yield from driven_in_mujoco(trace, case, run.links, second.timestep, second.integrator)
    else:
        again = mujoco_joints.run_case(case, run.links, second.timestep, second.integrator)
        yield from computed_again(trace, again)
