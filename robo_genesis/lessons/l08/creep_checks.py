"""Named checks of held boxes; the docstring of each is its claim."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import (
    Findings,
    above,
    at_most,
    below,
    equal,
    nearly,
    within,
)
from robo_genesis.core.experiment import Experiment, MeasuringPage, Readings, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.grippers import CONTACTS, LINKS, HeldCase
from robo_genesis.sim.bodies.laws import UNTURNED
from robo_genesis.sim.bodies.soft_contact import depth_and_creep
from robo_genesis.sim.common_checks import read_back, stamps
from robo_genesis.sim.laws import apart, each_run
from robo_genesis.sim.throughput import KEPT

from . import creep

SHARE, STILL = (
    0.005,
    2e-7,
)  # Of a value against its formula; creep that float32 causes [m/s]
DEPTH = 1e-7  # Depth that float32 does not resolve [m]
SAME = 0.005  # Share by which creeps may differ that are called equal
BOUND = 0.0134  # Path in 10 s by the formula with d = 0.9, by hand [m]
STOPPED = 0.01  # Largest share of a creep that is called stopped

TURN = 1e-4  # Rotation of a held box; noslip turns it by up to 2e-5 rad

SPEED, SPIN = 6e-6, 2.5e-4  # Of a steady motion [m/s] and [rad/s]


def settings(run: Experiment) -> Findings:
    """Friction and time constant read back are those of the cases; each box has 8 contacts."""
    yield from read_back(run, "friction", "time_constant")
    for case, value in run.readings["contacts"].items():
        yield equal(f"{case}.contacts", value, CONTACTS)


def laws_of_motion(run: Experiment) -> Findings:
    """No box turns, and each slides at a constant speed."""
    return each_run(run, steady)


def steady(trace: BodyTrace, case: HeldCase) -> Findings:
    """Yield what no run of a held box has."""
    yield from apart("link_quat", trace.link_quat, UNTURNED, TURN)
    yield from apart("link_ang [rad/s]", trace.link_ang, np.zeros(3), SPIN)
    place = trace.link_pos.astype(np.float64)
    speed = (place[-1] - place[0]) / case.duration
    yield from apart("link_vel [m/s]", trace.link_vel, speed, SPEED)


def creeps_as_computed(run: Experiment) -> Findings:
    """Without noslip each box creeps as its formula says, within 0.5 %, in both
    engines: with both cones and all values of impratio, on both sides of the weight µN.
    """
    for name, (_, expected) in formulas(run).items():
        found = run.metrics[name].creep
        yield nearly(f"{name}.creep_m_s", found, expected, SHARE, STILL)


def sinks_as_computed(run: Experiment) -> Findings:
    """Without noslip the contacts of each box are as deep as its formula says, within
    0.5 % and 0.1 µm, in both engines.
    """
    for name, (depth, _) in formulas(run).items():
        found = run.metrics[name].depth
        yield nearly(f"{name}.depth_m", found, depth, SHARE, DEPTH)


def formulas(run: Experiment) -> dict[str, tuple[float, float]]:
    """Return depth [m] and creep [m/s] by the formulas, of the runs without noslip."""
    return {
        name: depth_and_creep(case, name in creep.TWINS)
        for name, case in run.cases.items()
        if not case.noslip
    }


def share_of(run: Experiment, name: str, other: str) -> float:
    """Return the creep of one run as a share of that of another."""
    return float(run.metrics[name].creep / run.metrics[other].creep)


def shares(
    run: Experiment, name: str, other: str = "base"
) -> Iterator[tuple[str, float]]:
    """Yield a label and the share of the creep in each engine."""
    for engine in ("", "mujoco_"):
        share = share_of(run, engine + name, engine + other)
        yield f"{engine}{name}.share_of_{other}", share


def friction_lets_creep(run: Experiment) -> Findings:
    """In both engines the creep grows with each step of friction from 0.3 to 2, at 10 N
    and 0.1 kg; it is more than doubled in all.
    """
    row = [*creep.SCANS["friction"]]
    for faster, slower in zip(row[1:], row, strict=False):
        for label, share in shares(run, faster, slower):
            yield above(label, share, 1)
    for label, share in shares(run, row[-1], row[0]):
        yield above(label, share, 2)


def what_counts(run: Experiment) -> Findings:
    """In both engines a step of 1 ms and 500 iterations change the creep by less than
    0.5 %. Half of the time constant halves it for µ = 0.3, within 1 %. Four times the
    force leaves at least half of it, and five times the mass makes it larger.
    """
    for name in ("h_1ms_base", "iterations_500_base"):
        for label, share in shares(run, name):
            yield nearly(label, share, 1, SAME)
    for label, share in shares(run, "T_5ms_mu_03", "mu_03"):
        yield nearly(label, share, 0.5, 0.01)
    for name, least in (("N_40", 0.5), ("m_05", 1)):
        for label, share in shares(run, name):
            yield above(label, share, least)


def noslip_ends_at_half(run: Experiment) -> Findings:
    """In both engines noslip leaves at most 1 % of the creep of boxes lighter than µN,
    and changes that of the box which is heavier by less than 0.5 %.
    """
    for one in creep.ROW:
        expected, room = (1, SAME) if one == "m_15" else (0, STOPPED)
        for label, share in shares(run, f"noslip_5_{one}", one):
            yield within(label, share, expected, room)


def round_cone_holds(run: Experiment) -> Findings:
    """In both engines the elliptic cone with impratio 100 leaves at most 1 % of the
    creep of each box, also of the one that is heavier than µN. With impratio 1 the
    creep is the same for all coefficients, and in Genesis so is the depth.
    """
    for one in creep.ROW:
        for label, share in shares(run, f"elliptic_{one}", one):
            yield at_most(label, share, STOPPED)
    for name in ("elliptic_1_mu_03", "elliptic_1_mu_2"):
        for label, share in shares(run, name, "elliptic_1_base"):
            yield nearly(label, share, 1, SAME)
        same = run.metrics["elliptic_1_base"].depth
        yield within(f"{name}.depth_m", run.metrics[name].depth, same, DEPTH)


def engines_agree(run: Experiment) -> Findings:
    """In MuJoCo a box creeps as in Genesis, within 0.5 % and 2 µm/s, except with the
    pyramid and another impratio than 1: there the box with µ = 2 creeps more than four
    times as fast in MuJoCo.
    """
    for name in creep.CASES:
        if not name.startswith("pyramid_1"):
            one, other = (run.metrics[of].creep for of in (name, f"mujoco_{name}"))
            yield nearly(f"mujoco_{name}.creep_m_s", other, one, SHARE, 10 * STILL)
    share = share_of(run, "mujoco_pyramid_100_mu_2", "pyramid_100_mu_2")
    yield above("mujoco_pyramid_100_mu_2.share", share, 4)


def pyramid_has_corners(run: Experiment) -> Findings:
    """In 0.2 s the box of 1.5 kg slides less than 2 mm along gravity. With gravity turned
    by 45° in the plane of the pads the pyramid holds it with √2 µN, so that it moves as
    the rest of its weight accelerates it, within 2 %. With the elliptic cone it moves less
    than 0.1 mm.
    """
    path, case = run.readings["turned"], run.cases["plain_m_15"]
    yield below("plain_0_m", path["plain_0"], 2e-3)
    rest = case.gravity - np.sqrt(2) * case.friction * case.force / case.mass
    times = case.settle, case.settle + case.duration
    free = rest * np.diff(np.square(times))[0] / 2
    yield nearly("plain_45_m", path["plain_45"], free, 0.02)
    for turn in ("0", "45"):
        yield below(f"elliptic_{turn}_m", path[f"elliptic_{turn}"], 1e-4)


def creeps_on(run: Experiment) -> Findings:
    """In 10 s the box slides 10 s times the creep of the formula, within 0.5 %, and
    less than the bound of its formula with d = 0.9.
    """
    case, path = run.cases["long"], run.metrics["long"].path
    yield nearly("long.path_m", path, case.duration * depth_and_creep(case)[1], SHARE)
    yield below("long.below_bound_m", path, BOUND)


CHECKS = (
    settings,
    stamps,
    laws_of_motion,
    creeps_as_computed,
    sinks_as_computed,
    friction_lets_creep,
    what_counts,
    noslip_ends_at_half,
    round_cone_holds,
    engines_agree,
    pyramid_has_corners,
    creeps_on,
)

TIMES = [f"{what}_{name}" for what in KEPT for name in creep.TIMED]

CREEP = MeasuringPage(
    runs=runs_of(creep.CASES)
    | runs_of(creep.TWINS, note="run in MuJoCo, not in Genesis"),
    kind=BodyTrace,
    links=LINKS,
    readings={
        "friction": Readings(dict.fromkeys(creep.CASES, "1")),
        "time_constant": Readings(dict.fromkeys(creep.CASES, "s")),
        "contacts": Readings(dict.fromkeys(creep.CASES, "1"), "exact"),
        "turned": Readings(dict.fromkeys(creep.TURNED, "m")),
        "step": Readings(dict.fromkeys(TIMES, "s"), "performance"),
    },
    measure=creep.held_metrics,
    checks=CHECKS,
    parameters=creep.parameters,
    camera=False,
)
