"""What runs of landings, slides and bounces have in common by the laws of motion."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l03 import study_spec
from robo_genesis.sim.bodies.laws import (
    body_on_surface,
    never_still,
    reported_contacts,
    start,
)
from robo_genesis.sim.laws import apart, copied, kept, times
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

MEASURES = False

# Tolerances of the next state of a run in MuJoCo: ten times what float32 leaves in
# these runs.
NEXT = {"link_pos": 6e-7, "link_quat": 6e-6, "link_vel": 2e-5, "link_ang": 6e-4}


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample a body moves and touches as the contact model makes it, also in MuJoCo."""
    for name, case in run.cases.items():
        by_mujoco = name in study_spec.IN_MUJOCO
        broken = (
            in_mujoco(run, name)
            if by_mujoco
            else body_on_surface(run.traces[name], case)
        )
        yield from kept(name, broken)


def in_mujoco(run: Experiment, name: str) -> Iterator[Finding]:
    """Yield what a run of `mujoco_contacts.run_case` does not have."""
    trace, case, own_defaults = (
        run.traces[name],
        run.cases[name],
        name == study_spec.OWN_DEFAULTS,
    )
    yield from copied(trace, run.traces, study_spec.IN_MUJOCO)
    yield from times(trace, case.steps, case.dt)
    yield from start(trace, case)
    for array, of in mujoco_contacts.each_step(trace, case, own_defaults).items():
        yield from apart(
            "second-engine", array, getattr(trace, array)[1:, 0], of, NEXT[array]
        )
    yield from reported_contacts(trace, case)
    yield from never_still(trace, case)
