"""Named checks that several lessons use."""

import numpy as np

from robo_genesis.core.check_spec import READ_BACK, START_TOLERANCE, TIME_TOLERANCE
from robo_genesis.core.checks import (
    Finding,
    Findings,
    above,
    at_most,
    equal,
    model_counts,
    within,
)
from robo_genesis.core.experiment import Experiment

from .arm.franka import JOINT_NAMES, MODEL_COUNTS
from .camera.frames import FrameError, require_frame

# A robot or a body that moves changes a larger share of the pixels than this, and moves
# farther [m].
CHANGED, MOVED = 5e-3, 1e-3


def structure(run: Experiment) -> Findings:
    """The robot has the links, joints and DOFs of its model file."""
    yield from model_counts(run.readings["model"], MODEL_COUNTS)
    yield equal("joint_names", run.joints.names, JOINT_NAMES)


def stamps(run: Experiment) -> Findings:
    """Each run has a state at t = 0 and one after each of its configured outer steps, at k · dt."""
    for name, case in run.cases.items():
        t = run.traces[name].t
        yield equal(f"{name}.steps", len(t) - 1, case.steps)
        apart = np.abs(t - np.arange(len(t)) * case.dt).max()
        yield at_most(f"{name}.time_error_s", apart, TIME_TOLERANCE)


def read_back(run: Experiment, *names: str) -> Findings:
    """Require of settings that the engine returns the values of the cases."""
    for name in names:
        for case, value in run.readings[name].items():
            expected = getattr(run.cases[case], name)
            yield within(f"{case}.{name}", value, expected, READ_BACK)


def start(run: Experiment) -> Findings:
    """Each run begins with the body at rest at the height of its case."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        height = trace.link_pos[0, 0, 2]
        yield within(f"{name}.start_height_m", height, case.height, START_TOLERANCE)
        yield equal(f"{name}.start_velocity_m_s", np.abs(trace.link_vel[0]).max(), 0.0)
        yield equal(f"{name}.start_turning_rad_s", np.abs(trace.link_ang[0]).max(), 0.0)


def posture(run: Experiment) -> Findings:
    """Two camera frames that differ, or a schematic whose links moved, show both ends of the run.

    More than 0.5 % of the pixels differ, or a link moved by more than 1 mm.
    """
    views = {*run.page.frames} - {"initial", "final"} if run.rendered else set()
    frames = {name: frame for name, frame in run.frames.items() if name not in views}
    expected = ["final", "initial"] if run.rendered else []
    yield equal("frames", sorted(frames), expected)
    if not run.rendered:
        # A schematic draws the first run.
        links = run.traces[next(iter(run.cases))].link_pos
        yield above("moved_m", np.abs(links[-1] - links[0]).max(), MOVED)
    elif sorted(frames) == expected:
        for name in expected:
            yield usable_frame(name, frames[name])
        changed = (frames["initial"] != frames["final"]).any(axis=-1)
        yield above("changed_pixels", changed.sum(), CHANGED * changed.size)


def usable_frame(name: str, frame: np.ndarray) -> Finding:
    """Require a camera frame that is not empty."""
    try:
        require_frame(frame)
    except FrameError as error:
        return Finding(f"{name}.usable", False, False, f"True. {error}")
    return Finding(f"{name}.usable", True, True, "True")
