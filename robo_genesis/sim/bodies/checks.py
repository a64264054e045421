"""Named checks of lessons about free bodies."""

from itertools import chain

from robo_genesis.core.checks import Findings, model_counts
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.common_checks import read_back
from robo_genesis.sim.laws import kept

from .contacts import SETTINGS
from .laws import repeated_steps, reported_depth
from .rigid_bodies import MODEL_COUNTS


def structure(run: Experiment) -> Findings:
    """The scene has two entities; the body is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return model_counts(run.readings["model"], MODEL_COUNTS)


def settings(run: Experiment) -> Findings:
    """Frictions and substeps read back from the scenes are those of the cases."""
    return read_back(run, *SETTINGS)


def laws_of_motion(run: Experiment) -> Findings:
    """Each reported depth is that of the body's shape, and MuJoCo repeats most steps of Genesis.

    In at most a fifth of the contacts of a run, a depth is up to 40 µm less.
    """
    for name, case in run.cases.items():
        trace, in_mujoco = run.traces[name], run.page.runs[name].note
        steps = () if in_mujoco else repeated_steps(trace, case)
        yield from kept(name, chain(reported_depth(trace, case), steps))
