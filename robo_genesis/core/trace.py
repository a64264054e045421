"""The arrays of one measured run of joints or of free bodies, validated and read-only."""

from dataclasses import dataclass, fields, replace

import numpy as np

from .metrics import Stored, array
from .scene import FloatArray


class TraceError(ValueError):
    """Arrays do not form one run: a shape or time is wrong, or a value is not finite."""


@dataclass(frozen=True, slots=True)
class TimeSeries:
    """The states of one run at t[k] = k · dt; t[0] is the state before the first step.

    A value that `scene.step()` produces has the time at which the step ends. `t`:
    (n+1,) [s].
    """

    t: FloatArray = array(
        "t_s", "state", "s", "time of each state, the first before any step", "float64"
    )

    @classmethod
    def arrays(cls) -> dict[str, Stored]:
        """Return how each array is stored, by its field."""
        return {one.name: one.metadata["stored"] for one in fields(cls)}

    def __post_init__(self) -> None:
        states = np.shape(self.t)[0] if np.ndim(self.t) == 1 else 0
        lengths = {"state": states, "step": states - 1, "axis": 3, "wxyz": 4}
        for name, (_, dims, *_) in self.arrays().items():
            values = np.array(getattr(self, name))
            if not np.isfinite(values).all():
                where = np.argwhere(~np.isfinite(values))[0].tolist()
                raise TraceError(f"{name} is not finite at index {where}.")
            # The first array with DOFs or links says how many.
            if values.ndim == len(dims):
                lengths = dict(zip(dims, values.shape, strict=True)) | lengths
            expected = tuple(lengths.get(dim, 0) for dim in dims)
            if values.shape != expected or states < 2:
                raise TraceError(
                    f"{name} has shape {values.shape}, expected {expected}: a run of {states - 1} "
                    f"steps has {states} states (t = 0 included) and {states - 1} values after a "
                    "step."
                )
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        expected = np.arange(len(self.t)) * self.t[1]
        if self.t[1] <= 0 or not np.allclose(self.t, expected, rtol=0, atol=1e-9):
            k = int(np.argmax(np.abs(self.t - expected)))
            raise TraceError(
                f"t[{k}] is {self.t[k]} s, expected {expected[k]} s: k · dt."
            )

    @property
    def dt(self) -> float:
        """Outer time step [s]."""
        return float(self.t[1])

    @property
    def steps(self) -> int:
        """Number of outer steps n."""
        return len(self.t) - 1


LINK_POS = array("link_pos_m", "state link axis", "m", "link position in the world")
LINK_QUAT = array("link_quat_wxyz", "state link wxyz", "1", "link orientation")


@dataclass(frozen=True, slots=True)
class Trace(TimeSeries):
    """One run of n steps on d DOFs and l links.

    | field | shape | meaning |
    |---|---|---|
    | `t` | (n+1,) | time of each state [s] |
    | `q` | (n+1, d) | position [rad or m] |
    | `qd` | (n, d) | velocity after each step [rad/s or m/s] |
    | `target` | (n, d) | position command of each step [rad or m] |
    | `control_force` | (n, d) | `get_dofs_control_force` after each step [N·m or N] |
    | `internal_force` | (n, d) | `get_dofs_force` after each step [N·m or N] |
    | `start_control_force` | (d,) | control force after the command, before the first step |
    | `start_qd` | (d,) | velocity before the first step [rad/s or m/s] |
    | `effort_limit` | (d,) | bound read back with `get_dofs_force_range` [N·m or N] |
    | `link_pos` | (n+1, l, 3) | link positions in the world [m] |
    | `link_quat` | (n+1, l, 4) | link orientations in the world, (w, x, y, z) |
    """

    q: FloatArray = array("q_rad_or_m", "state dof", None, "position")
    qd: FloatArray = array(
        "qd_rad_s_or_m_s", "step dof", None, "velocity after each step"
    )
    target: FloatArray = array(
        "target_rad_or_m", "step dof", None, "position command of each step", "float64"
    )
    control_force: FloatArray = array(
        "control_force_Nm_or_N",
        "step dof",
        None,
        "get_dofs_control_force after each step",
    )
    internal_force: FloatArray = array(
        "internal_force_Nm_or_N", "step dof", None, "get_dofs_force after each step"
    )
    start_control_force: FloatArray = array(
        "start_control_force_Nm_or_N",
        "dof",
        None,
        "control force before the first step",
    )
    start_qd: FloatArray = array(
        "start_qd_rad_s_or_m_s", "dof", None, "velocity before the first step"
    )
    effort_limit: FloatArray = array(
        "effort_limit_Nm_or_N", "dof", None, "get_dofs_force_range, read back"
    )
    link_pos: FloatArray = LINK_POS
    link_quat: FloatArray = LINK_QUAT


@dataclass(frozen=True, slots=True)
class BodyTrace(TimeSeries):
    """One run of n steps of free bodies with l links in total.

    | field | shape | meaning |
    |---|---|---|
    | `t` | (n+1,) | time of each state [s] |
    | `link_pos` | (n+1, l, 3) | link positions in the world [m] |
    | `link_quat` | (n+1, l, 4) | link orientations in the world, (w, x, y, z) |
    | `link_vel` | (n+1, l, 3) | velocities of the link frames' origins [m/s] |
    | `link_ang` | (n+1, l, 3) | angular velocities in the world's axes [rad/s] |
    """

    link_pos: FloatArray = LINK_POS
    link_quat: FloatArray = LINK_QUAT
    link_vel: FloatArray = array(
        "link_vel_m_s", "state link axis", "m/s", "velocity of the link's origin"
    )
    link_ang: FloatArray = array(
        "link_ang_rad_s", "state link axis", "rad/s", "angular velocity"
    )


@dataclass(frozen=True, slots=True)
class ContactTrace(BodyTrace):
    """One run of free bodies on a surface: the arrays of `BodyTrace` and those of the contacts.

    | field | shape | meaning |
    |---|---|---|
    | `contacts` | (n+1, l) | number of contact points with the surface |
    | `penetration` | (n+1, l) | depth of the deepest contact [m], 0 without contact |

    The engine detects contacts at the beginning of a solver step. The contacts after
    `scene.step()` are those of the beginning of its last solver step: one solver step
    older than the positions.
    """

    contacts: np.ndarray = array(
        "contacts",
        "state link",
        "1",
        "contact points with the surface at the beginning of the last solver step",
        "int32",
    )
    penetration: FloatArray = array(
        "penetration_m", "state link", "m", "depth of the deepest of them"
    )


@dataclass(frozen=True, slots=True)
class Episodes(TimeSeries):
    """Runs of e environments of one scene, in each of which a robot handles an object.

    | field | shape | meaning |
    |---|---|---|
    | `t` | (n+1,) | time of each sample [s] |
    | `phase` | (n+1, e) | number of the phase of the command that led to the sample |
    | `q` | (n+1, e, d) | positions of the robot's joints [rad or m] |
    | `object_pos` | (n+1, e, 3) | place of the object in the world [m] |
    | `object_quat` | (n+1, e, 4) | its orientation, (w, x, y, z) |
    | `force` | (n+1, e, 2) | normal force of the left and the right finger on the object [N] |
    | `touches` | (n+1, e) | whether any part of the robot touches the object, 1 or 0 |
    """

    phase: np.ndarray = array(
        "phase", "state env", "1", "phase of the last command", "int8"
    )
    q: FloatArray = array("q_rad_or_m", "state env dof", None, "position")
    object_pos: FloatArray = array(
        "object_pos_m", "state env axis", "m", "place of the object in the world"
    )
    object_quat: FloatArray = array(
        "object_quat_wxyz", "state env wxyz", "1", "its orientation"
    )
    force: FloatArray = array(
        "force_N", "state env finger", "N", "normal force of each finger on the object"
    )
    touches: np.ndarray = array(
        "touches", "state env", "1", "whether the robot touches the object", "int8"
    )

    def of(self, rows: slice) -> "Episodes":
        """Return the runs of some environments."""
        names = [field.name for field in fields(self) if field.name != "t"]
        return replace(self, **{name: getattr(self, name)[:, rows] for name in names})


@dataclass(frozen=True, slots=True)
class Demonstrations(Episodes):
    """Episodes with what a policy would learn from them.

    `target`: (n, e, d), the last position command before each sample but the first [rad
        or m].
    """

    target: FloatArray = array(
        "target_rad_or_m",
        "step env dof",
        None,
        "last position command before the next sample",
    )


def first_time(t: np.ndarray, reached: np.ndarray) -> float | None:
    """Return the first t (n,) [s] at which `reached` (n,) is true, None if it never is."""
    return t[reached.argmax()] if reached.any() else None


def settled_from(t: np.ndarray, inside: np.ndarray) -> float | None:
    """Return the t (n,) [s] from which `inside` (n,) holds to the end, None if it ends outside."""
    if not inside[-1]:
        return None
    outside = np.flatnonzero(~inside)
    return t[outside[-1] + 1] if outside.size else t[0]
