"""What arrays of landings, slides and bounces cannot be, whatever metrics and checks they give."""

from collections.abc import Iterator, Mapping

from robo_genesis.core.plausibility import Breach, computed_again, copied, refuse, times
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import spec
from robo_genesis.sim import mujoco_contacts
from robo_genesis.sim.contacts import ContactCase
from robo_genesis.sim.plausible_bodies import body_on_surface, reported_contacts

BY_MUJOCO = {*spec.OTHER_ENGINE, spec.OWN_DEFAULTS}


def require_possible_runs(run: Experiment) -> None:
    """Require of each run in Genesis the laws of motion; compute each run in MuJoCo again.

    Raises:
        BundleRefused: `stamps`, `pose`, `start`, `contact`, `motion` or `second-engine`.
    """
    by_genesis = {name: of for name, of in run.traces.items() if name not in BY_MUJOCO}
    for name, case in run.cases.items():
        trace = run.traces[name]
        if name in BY_MUJOCO:
            breaches = in_mujoco(trace, case, name == spec.OWN_DEFAULTS, by_genesis)
        else:
            breaches = body_on_surface(trace, case)
        refuse(f"arrays/{name}.npz", breaches)


def in_mujoco(
    trace: ContactTrace,
    case: ContactCase,
    own_defaults: bool,
    by_genesis: Mapping[str, ContactTrace],
) -> Iterator[Breach]:
    """Yield what a run in MuJoCo does not have; the arguments as of `mujoco_contacts.run_case`."""
    yield from times(trace, case.steps, case.dt)
    yield from copied(trace, by_genesis)
    yield from computed_again(trace, mujoco_contacts.run_case(case, own_defaults))
    yield from reported_contacts(trace, case)
