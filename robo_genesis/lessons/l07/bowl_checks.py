"""Named checks of balls that fall into a bowl, and the measuring page of these runs."""

import numpy as np

from robo_genesis.core.checks import (
    Findings,
    above,
    at_most,
    below,
    equal,
    nearly,
    noted,
    within,
)
from robo_genesis.core.experiment import Experiment, MeasuringPage, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.sim.bodies.bowl import CHOICES, DENSITY, HEIGHT, WALL
from robo_genesis.sim.bodies.free_fall import GRAVITY, summed_drop
from robo_genesis.sim.bodies.laws import FALLEN, FALLING
from robo_genesis.sim.common_checks import stamps
from robo_genesis.sim.laws import apart, each_run

from . import bowls
from .bowls import BALLS, BowlCase

# Where the lowest ball ends, and how near to this height [m]
ENDS, NEAR = WALL + 0.001, 0.002
# Of a flat face [m], of masses
FLAT, SHARE = 1e-5, 1e-3


def one_hull_holds_none(run: Experiment) -> Findings:
    """A bowl of one hull holds none of the balls: at y = 0 its top is level with the rim."""
    yield equal("in_one_hull.inside_percent", run.metrics["in_one_hull"].inside, 0.0)
    heights = run.readings["top_one_hull"].values()
    yield within("one_hull.lowest_top_m", min(heights), HEIGHT, FLAT)


def others_hold_all(run: Experiment) -> Findings:
    """All other bowls hold all twelve balls of 16 mm, also with other steps, starts and
    hulls; the lowest ball ends near the bowl's floor, and none has sunk in.
    """
    for name in [*bowls.BIG, *bowls.ATTACKS][1:]:
        found = run.metrics[name]
        yield equal(f"{name}.inside_percent", found.inside, 100.0)
        yield within(f"{name}.lowest_m", found.lowest, ENDS, NEAR)
        yield equal(f"{name}.sunk", found.in_foot, 0)


def default_is_closer(run: Experiment) -> Findings:
    """One hull has more than four times the volume of the mesh; the default
    decomposition has less than one hull and more than the mesh, and the pieces fill the
    mesh exactly.
    """
    solid = run.readings["bowl_volume"]
    ratio = {choice: solid[choice] / solid["visual"] for choice in CHOICES}
    yield above("one_hull.volume_ratio", ratio["one_hull"], 4.0)
    yield below("default.volume_ratio", ratio["default"], ratio["one_hull"])
    yield above("default.share_of_pieces", ratio["default"] / ratio["pieces"], 1.0)
    yield nearly("pieces.volume_ratio", ratio["pieces"], 1.0, SHARE)


def mass_is_of_collision(run: Experiment) -> Findings:
    """A free bowl weighs density times the volume of its collision geometry."""
    for name, mass in run.readings["bowl_mass"].items():
        volume = 1e-6 * run.readings["bowl_volume"][name]
        yield nearly(f"{name}.mass_kg", mass, DENSITY * volume, SHARE)


def fast_small_balls_sink(run: Experiment) -> Findings:
    """With steps of 1 ms, balls of 4 mm sink into the foot if v T / e exceeds their
    radius: from above the rim some do, in hulls and in pieces, and from a start inside
    the bowl none. All balls count as inside.
    """
    for name, case in bowls.SMALL.items():
        label, found = f"{name}.sunk", run.metrics[name].in_foot
        judge = above if case.depth > case.radius else at_most
        yield judge(label, found, 0)
        yield noted(f"{name}.depth_m", case.depth)
        yield equal(f"{name}.inside_percent", run.metrics[name].inside, 100.0)


def laws_of_motion(run: Experiment) -> Findings:
    """The balls fall freely until one can touch a bowl."""
    return each_run(run, falling_balls)


def falling_balls(trace: BodyTrace, case: BowlCase) -> Findings:
    """Yield what no run of `bowls.run_case` has."""
    fallen = summed_drop(case.h, case.substeps * np.arange(case.steps + 1))
    free = slice((case.drop > fallen).sum() or 1)  # states without any contact
    down = np.array([0.0, 0.0, 1.0])
    place = case.starts - fallen[free, None, None] * down
    motion = -GRAVITY * trace.t[free, None, None] * down
    yield from apart("free link_pos [m]", trace.link_pos[free], place, FALLEN)
    yield from apart("free link_vel [m/s]", trace.link_vel[free], motion, FALLING)


CHECKS = (
    stamps,
    one_hull_holds_none,
    others_hold_all,
    default_is_closer,
    mass_is_of_collision,
    fast_small_balls_sink,
    laws_of_motion,
)

MESHES = MeasuringPage(
    runs=runs_of(bowls.CASES),
    kind=BodyTrace,
    links=BALLS,
    readings=bowls.READINGS,
    measure=bowls.bowl_metrics,
    checks=CHECKS,
    parameters=bowls.parameters,
    camera=False,
)
