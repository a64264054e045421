"""What runs of landings, slides and bounces have in common by the laws of motion."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l03 import study_spec
from robo_genesis.sim.bodies.laws import body_on_surface, never_still, reported_contacts
from robo_genesis.sim.laws import computed_again, copied, kept, times
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

MEASURES = False

MOTION = ("link_pos", "link_quat", "link_vel", "link_ang", "penetration")
AGAIN = dict.fromkeys(MOTION, 1e-5)
"""Tolerances of a run that is computed again, by array. If settings change by the rounding of
float64, the runs change by up to 9e-7. Genesis with equal settings is at least 1.8e-5 apart."""

AGAIN_BY_DEFAULTS = dict.fromkeys(MOTION, 2e-5) | {"link_ang": 4e-3}
"""Those of `study_spec.OWN_DEFAULTS`, whose angular velocity is only rounding: it changes by
4e-4."""


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """At each sample a body moves and touches as the contact model makes it; MuJoCo runs repeat."""
    for name, case in run.cases.items():
        by_mujoco = name in study_spec.IN_MUJOCO
        broken = in_mujoco(run, name) if by_mujoco else body_on_surface(run.traces[name], case)
        yield from kept(name, broken)


def in_mujoco(run: Experiment, name: str) -> Iterator[Finding]:
    """Yield what a run of `mujoco_contacts.run_case` does not have."""
    trace, case, own_defaults = run.traces[name], run.cases[name], name == study_spec.OWN_DEFAULTS
    yield from times(trace, case.steps, case.dt)
    yield from copied(
        trace, {n: of for n, of in run.traces.items() if n not in study_spec.IN_MUJOCO}
    )
    again = mujoco_contacts.run_case(case, own_defaults)
    yield from computed_again(trace, again, AGAIN_BY_DEFAULTS if own_defaults else AGAIN)
    yield from reported_contacts(trace, case)
    yield from never_still(trace, case)
