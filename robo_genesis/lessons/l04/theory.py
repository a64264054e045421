"""Models of one joint, in closed form and in steps, and responses as shares of their step."""

from dataclasses import dataclass

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace


@dataclass(frozen=True, slots=True)
class IdealJoint:
    """One linear joint, I ë + D ė + KP e = 0, without gravity, limits or neighbours.

    | field | meaning |
    |---|---|
    | `inertia` | I, effective inertia [kg·m²] |
    | `damping` | D = KV + the joint's passive damping [N·m·s/rad] |
    | `kp` | KP [N·m/rad] |
    """

    inertia: float
    damping: float
    kp: float

    @property
    def omega(self) -> float:
        """Natural frequency ω = √(KP / I) [rad/s]."""
        return np.sqrt(self.kp / self.inertia)

    @property
    def zeta(self) -> float:
        """Damping ratio ζ = D / (2 √(KP I))."""
        return self.damping / (2 * np.sqrt(self.kp * self.inertia))

    @property
    def overshoot(self) -> float:
        """Overshoot as a share of the step: exp(−π ζ / √(1 − ζ²)), zero for ζ ≥ 1."""
        if self.zeta >= 1:
            return 0.0
        return np.exp(-np.pi * self.zeta / np.sqrt(1 - self.zeta**2))

    def response(self, t: FloatArray) -> FloatArray:
        """Return the response (n,) to a unit step from rest at times `t` (n,) [s], for ζ ≠ 1.

        Åström and Murray, Feedback Systems, section on second-order systems.
        """
        omega, zeta, t = self.omega, self.zeta, np.asarray(t, dtype=np.float64)
        root = np.sqrt(complex(zeta**2 - 1))  # imaginary for an underdamped joint
        slow, fast = omega * (zeta - root), omega * (zeta + root)  # both decay
        decay = (fast * np.exp(-slow * t) - slow * np.exp(-fast * t)) / (fast - slow)
        return 1 - decay.real


def stepped_joint(
    joint: IdealJoint,
    passive: float,
    step: float,
    h: float,
    steps: int,
    limit: float = np.inf,
    gravity: float = 0.0,
) -> FloatArray:
    """Return the distance from the target (steps+1,) [rad] of one joint that a solver steps.

    The integrator is semi-implicit: the damping acts at the velocity at the end of the
    step. The damping of the controller stays in the equation while its effort is
    clipped, as in Genesis.

    Args:
        joint: inertia, whole damping and KP.
        passive: the part of its damping that the model file declares [N·m·s/rad].
        step: height of the commanded step [rad].
        h: length of one solver step [s].
        steps: number of solver steps.
        limit: of the effort [N·m].
        gravity: effort that holds the joint [N·m], constant.
    """
    kv = joint.damping - passive
    q, qd = -step, 0.0
    path = [q]
    inertia = joint.inertia + h * joint.damping
    for _ in range(steps):
        tau = min(max(-joint.kp * q - kv * qd, -limit), limit)
        qd += h * (tau - passive * qd - gravity) / inertia
        q += h * qd
        path.append(q)
    return np.array(path)


def step_share(step: Trace, hold: Trace, entry: int) -> FloatArray:
    """Return (q_step − q_hold) / step (n+1,): a response without the effects common to both runs.

    For a linear joint the two motions add up. Subtracting the run that holds its start
    therefore removes gravity.
    """
    height = float(step.target[0, entry]) - float(hold.target[0, entry])
    difference = step.q[:, entry].astype(np.float64) - hold.q[:, entry].astype(
        np.float64
    )
    return difference / height


def overshoot_share(share: FloatArray) -> float:
    """Return the overshoot of a response to a unit step, as a share of the step."""
    return float(max(0.0, share.max() - 1))
