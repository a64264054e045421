"""The student's function in L07's lab, and a deliberate mistake."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core.checks import Finding, within
from robo_genesis.core.exercises import Mistake, as_test, quoted, refused
from robo_genesis.lessons.l07 import spec
from robo_genesis.sim.arm.joint_control import validate

MEASURES = False


@as_test
def effort(law: Callable[..., Any]) -> Iterator[Finding]:
    """Check `law(error, qd, kp, kv)`: the effort [N·m] that position control asks for."""
    yield within("at_rest_N_m", float(law(0.5, 0.0, 100.0, 10.0)), 50.0, 1e-9)
    yield within("at_the_target_N_m", float(law(0.0, 2.0, 100.0, 10.0)), -20.0, 1e-9)


def degrees(joints: Any) -> Mistake:
    """Give the target in degrees, and return what the course says about it."""
    wrong = replace(spec.BASELINE, q_target=np.degrees(spec.TURNED))  # the mistake
    refusal = refused(lambda: validate(wrong, joints))
    return Mistake("degrees", refusal is not None, quoted(refusal))
