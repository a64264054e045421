"""Depth and creep of a body on soft contacts, by the contact model that both engines share.

A contact is a spring and a damper, whose constants follow from its time constant T. Of
the force that they need, it gives the share d, the impedance, which grows with depth. So
a body sinks in, and it creeps along a surface while friction carries a load.
"""

from typing import Any, NamedTuple

# Default of Genesis for contacts, unless two solver steps are longer [s].
DEFAULT_TIME_CONSTANT = 0.01

# Impedance of a contact as a function of depth, the default of both engines: the least,
# the most, the width [m], the middle of the width, and the power.
IMPEDANCE = (0.9, 0.95, 0.001, 0.5, 2.0)


def time_constant(h: float, requested: float | None = None) -> float:
    """Return the time constant of a contact in Genesis at solver step `h` [s].

    Args:
        h: the solver step [s].
        requested: `constraint_timeconst` [s], None for the default.
    """
    return max(DEFAULT_TIME_CONSTANT if requested is None else requested, 2 * h)


def impedance(depth: float) -> float:
    """Return the impedance d of a contact at a depth [m]."""
    least, most, width, middle, power = IMPEDANCE
    x = min(depth / width, 1.0)
    low = x**power / middle ** (power - 1)
    high = (1 - x) ** power / (1 - middle) ** (power - 1)
    return least + (most - least) * (low if x < middle else 1 - high)


class Load(NamedTuple):
    """What one of the equal contacts of a body carries.

    `normal` and `friction` are its forces [N]; `inverse_mass` is that of both bodies at
    the contact [1/kg]. `may_leave` is whether an edge of the pyramid is free where the
    load would pull it; else the formulas count with a force that pulls.
    """

    normal: float
    friction: float
    inverse_mass: float
    may_leave: bool = False


def impratio(case: Any) -> float:
    """Return the ratio of frictional to normal impedance; for None Genesis chooses by the cone."""
    return case.impratio or (100.0 if case.cone == "elliptic" else 1.0)


def depth_and_creep(case: Any, in_mujoco: bool = False) -> tuple[float, float]:
    """Return the depth [m] and the creep [m/s] of a body; both grow with (1−d)/d.

    The impedance d depends on the depth, so both are found by iteration. With the
    pyramid, Genesis divides both μ² by impratio, MuJoCo one of them.

    Args:
        case: a `ContactRun` with `friction` μ and `load`, that of each contact.
        in_mujoco: whether the pyramid is that of MuJoCo.
    """
    d, mu, load, ratio = IMPEDANCE[0], case.friction, case.load, impratio(case)
    seconds = IMPEDANCE[1] * time_constant(case.h, case.time_constant)
    k, b = 1 / seconds**2, 2 / seconds
    square = mu**2 / ratio
    edges = 1 + (mu**2 if in_mujoco else square)
    one_edge = load.may_leave and load.friction > mu * load.normal / 2
    for _ in range(100):
        soft = (1 - d) / d * load.inverse_mass
        if case.cone == "elliptic":
            depth = soft * load.normal / (k * d)
            creep = soft * load.friction / ratio / b
        elif not one_edge:
            depth = soft * load.normal * square * edges / 2 / (k * d)
            creep = soft * load.friction * edges / ratio / b
        else:  # the edge that points down is free
            pressing = load.normal - load.friction / mu
            depth = soft * pressing * square * edges / (k * d)
            pulling = 1.5 * load.friction / mu - load.normal / 2
            creep = soft * pulling * 2 * square * edges / mu / b
        d = (d + impedance(depth)) / 2
    return depth, creep
