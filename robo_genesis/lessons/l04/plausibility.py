"""What arrays of the lesson's cases cannot be, whatever metrics and checks they give."""

import numpy as np

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l04 import spec


def require_possible_runs(run: Experiment) -> None:
    """Require of each case its steps, its time step, and a joint that moves and is driven.

    Raises:
        BundleRefused: `stamps` or `constant`.
    """
    for name, case in spec.CASES.items():
        file, trace = f"arrays/{name}.npz", run.traces[name]
        expect("stamps", file, "number of steps", trace.steps, case.steps)
        if not np.allclose(trace.t, np.arange(case.steps + 1) * case.dt, rtol=0, atol=1e-9):
            expect("stamps", file, "dt of the stamps [s]", trace.dt, case.dt)
        require_motion(file, trace)


def require_motion(file: str, trace: Trace) -> None:
    """Refuse an array of one constant.

    Raises:
        BundleRefused: `constant`.
    """
    for name, values in (
        (f"position of {spec.STEPPED_JOINT}", trace.q[:, spec.ENTRY]),
        (f"velocity of {spec.STEPPED_JOINT}", trace.qd[:, spec.ENTRY]),
        ("control force", trace.control_force),
        ("internal force", trace.internal_force),
    ):
        if (values == values.flat[0]).all():
            raise BundleRefused(
                "constant",
                f"{file}: {name} is {values.flat[0]:g} at every sample, expected one "
                f"that changes. {AGAIN}",
            )
