"""The arrays of one measured run of joints or of free bodies, validated and read-only."""

from dataclasses import dataclass, fields

import numpy as np

from robo_genesis.core.scene import FloatArray


class TraceError(ValueError):
    """Arrays do not form one run: a shape or time is wrong, or a value is not finite."""


@dataclass(frozen=True, slots=True)
class TimeSeries:
    """The states of one run at t[k] = k · dt; t[0] is the state before the first step.

    A value that `scene.step()` produces has the time at which the step ends. `t`: (n+1,) [s].
    """

    t: FloatArray

    def __post_init__(self) -> None:
        for field in fields(self):
            array = np.array(getattr(self, field.name))
            if not np.isfinite(array).all():
                where = np.argwhere(~np.isfinite(array))[0].tolist()
                raise TraceError(f"{field.name} is not finite at index {where}.")
            array.setflags(write=False)
            object.__setattr__(self, field.name, array)
        states = self.t.shape[0] if self.t.ndim == 1 else 0
        for name, shape in self._expected(states).items():
            found = getattr(self, name).shape
            if found != shape or states < 2:
                raise TraceError(
                    f"{name} has shape {found}, expected {shape}: a run of {states - 1} steps has "
                    f"{states} states (t = 0 included) and {states - 1} values after a step."
                )
        if self.t[0] != 0.0:
            raise TraceError(
                f"t starts at {self.t[0]} s, expected 0: the state before the first step."
            )
        expected = np.arange(len(self.t)) * self.t[1]
        if self.t[1] <= 0 or not np.allclose(self.t, expected, rtol=0, atol=1e-9):
            k = int(np.argmax(np.abs(self.t - expected)))
            raise TraceError(f"t[{k}] is {self.t[k]} s, expected {expected[k]} s: k · dt.")

    def _expected(self, states: int) -> dict[str, tuple[int, ...]]:
        """Return the shape of each array of a run with a number of states."""
        return {"t": (states,)}

    @property
    def dt(self) -> float:
        """Outer time step [s]."""
        return float(self.t[1])

    @property
    def steps(self) -> int:
        """Number of outer steps n."""
        return len(self.t) - 1

    @property
    def t_step(self) -> FloatArray:
        """Times of the values after each step, t[1] … t[n], shape (n,) [s]."""
        return self.t[1:]


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

    q: FloatArray
    qd: FloatArray
    target: FloatArray
    control_force: FloatArray
    internal_force: FloatArray
    start_control_force: FloatArray
    start_qd: FloatArray
    effort_limit: FloatArray
    link_pos: FloatArray
    link_quat: FloatArray

    def _expected(self, states: int) -> dict[str, tuple[int, ...]]:
        dofs = self.q.shape[1] if self.q.ndim == 2 else 0
        links = self.link_pos.shape[1] if self.link_pos.ndim == 3 else 0
        return {
            "t": (states,),
            "q": (states, dofs),
            "start_control_force": (dofs,),
            "start_qd": (dofs,),
            "effort_limit": (dofs,),
            "link_pos": (states, links, 3),
            "link_quat": (states, links, 4),
        } | dict.fromkeys(("qd", "target", "control_force", "internal_force"), (states - 1, dofs))


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

    link_pos: FloatArray
    link_quat: FloatArray
    link_vel: FloatArray
    link_ang: FloatArray

    def _expected(self, states: int) -> dict[str, tuple[int, ...]]:
        links = self.link_pos.shape[1] if self.link_pos.ndim == 3 else 0
        shapes = dict.fromkeys(("link_pos", "link_vel", "link_ang"), (states, links, 3))
        return {"t": (states,), "link_quat": (states, links, 4)} | shapes


@dataclass(frozen=True, slots=True)
class ContactTrace(BodyTrace):
    """One run of free bodies on a surface: the arrays of `BodyTrace` and those of the contacts.

    | field | shape | meaning |
    |---|---|---|
    | `contacts` | (n+1, l) | number of contact points with the surface |
    | `penetration` | (n+1, l) | depth of the deepest contact [m], 0 without contact |

    The engine detects contacts at the beginning of a solver step. The contacts after `scene.step()`
    are those of the beginning of its last solver step: one solver step older than the positions.
    """

    contacts: np.ndarray
    penetration: FloatArray

    def _expected(self, states: int) -> dict[str, tuple[int, ...]]:
        shapes = BodyTrace._expected(self, states)
        links = shapes["link_pos"][1]
        return shapes | dict.fromkeys(("contacts", "penetration"), (states, links))


def first_time(t: np.ndarray, reached: np.ndarray) -> float | None:
    """Return the first t (n,) [s] at which `reached` (n,) is true, None if it never is."""
    return float(t[int(reached.argmax())]) if reached.any() else None


def settled_from(t: np.ndarray, inside: np.ndarray) -> float | None:
    """Return the t (n,) [s] from which `inside` (n,) holds to the end, None if it ends outside."""
    if not inside[-1]:
        return None
    outside = np.flatnonzero(~inside)
    return float(t[outside[-1] + 1]) if outside.size else float(t[0])
