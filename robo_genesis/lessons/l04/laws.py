"""What runs of a driven robot have in common by its mechanics."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l04 import study_spec
from robo_genesis.sim.arm.laws import (
    assigned_path,
    driven_in_mujoco,
    driven_run,
    model_joints,
)
from robo_genesis.sim.laws import copied, kept

MEASURES = False


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample links, forces and velocities are those of the robot, also in MuJoCo."""
    yield from kept("the joint map", model_joints(run.joints))
    for name, case in run.cases.items():
        if name in study_spec.SECOND_RUNS:
            broken = in_mujoco(run, name)
        elif name == study_spec.ASSIGNED:
            broken = assigned_path(
                run.traces[name], case, run.links, run.traces.values()
            )
        else:
            broken = driven_run(run.traces[name], case, run.links)
        yield from kept(name, broken)


def in_mujoco(run: Experiment, name: str) -> Iterator[Finding]:
    """Yield what a run in MuJoCo does not have."""
    trace, case, second = (
        run.traces[name],
        run.cases[name],
        study_spec.SECOND_RUNS[name],
    )
    yield from copied(trace, run.traces, study_spec.SECOND_RUNS)
    yield from driven_in_mujoco(
        trace, case, run.links, second.timestep, second.integrator
    )
