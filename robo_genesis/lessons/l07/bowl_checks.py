"""Named checks of balls that fall into a bowl, and the measuring page of these runs."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from robo_genesis.core.checks import Finding, above, at_most, below, equal, nearly, noted, within
from robo_genesis.core.experiment import Experiment, MeasuringPage, runs_of
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l07 import bowls
from robo_genesis.lessons.l07.bowls import BALLS, DENSITY, HEIGHT, BowlCase
from robo_genesis.sim.bodies.free_fall import GRAVITY, summed_drop
from robo_genesis.sim.common_checks import stamps
from robo_genesis.sim.laws import UNTURNED, ZERO, apart, kept, times, unit_quaternions

FALLEN, FALLING = 5e-6, 1e-4  # Tolerances of place [m] and velocity [m/s] in free fall
FLOOR = (0.001, 0.003)  # How far the lowest ball ends below and above the bowl's floor [m]
FLAT, GAP, SHARE = 1e-5, 2e-5, 1e-3  # Of a flat face [m], of points outside hulls [m], of masses
GAIN = 0.05  # Share of energy that contacts return in one outer step: up to 0.018 in the runs


def sunk(run: Experiment, name: str) -> int:
    """Return how many balls inside the bowl have their centre below the upper face of its foot."""
    return int((bowls.heights_inside(run.traces[name]) < run.cases[name].floor).sum())


def one_hull_holds_none(run: Experiment) -> Iterator[Finding]:
    """A bowl of one hull holds none of the balls: at y = 0 its top is level with the rim."""
    yield equal("in_one_hull.inside_percent", run.metrics["in_one_hull"].inside, 0.0)
    heights = run.readings["top_one_hull"].values()
    yield within("one_hull.lowest_top_m", min(heights), HEIGHT, FLAT)


def others_hold_all(run: Experiment) -> Iterator[Finding]:
    """All other bowls hold all twelve balls of 16 mm, also with other steps, starts and hulls; the
    lowest ball ends near the bowl's floor, and none has sunk in.
    """
    for name, case in (bowls.BIG | bowls.ATTACKS).items():
        if case.choice != "one_hull":
            inside, lowest = run.metrics[name].inside, run.metrics[name].lowest
            yield equal(f"{name}.inside_percent", inside, 100.0)
            yield above(f"{name}.lowest_m", lowest, case.floor - FLOOR[0])
            yield below(f"{name}.over_floor_m", (lowest or np.inf) - case.floor, FLOOR[1])
            yield equal(f"{name}.sunk", sunk(run, name), 0)


def hulls_cover(run: Experiment) -> Iterator[Finding]:
    """The hulls of both decompositions leave no gap: they cover the bowl within 0.02 mm."""
    for name, distance in run.readings["uncovered"].items():
        yield at_most(f"{name}.uncovered_m", distance, GAP)


def finer_is_closer(run: Experiment) -> Iterator[Finding]:
    """One hull has more than four times the volume of the mesh; default, finer decomposition and
    pieces follow in this order, and the pieces fill the mesh exactly.
    """
    solid, seen = run.readings["collision_volume"], run.readings["visual_volume"]["one_hull"]
    yield above("one_hull.volume_ratio", solid["one_hull"] / seen, 4.0)
    for more, less in pairwise(("one_hull", "default", "fine", "pieces")):
        yield below(f"{less}.volume_cm3", solid[less], solid[more])
    yield nearly("pieces.volume_ratio", solid["pieces"] / seen, 1.0, SHARE)


def mass_is_of_collision(run: Experiment) -> Iterator[Finding]:
    """A free bowl weighs density times the volume of its collision geometry; with the density
    corrected by the ratio of the volumes, it weighs density times the volume of the mesh.
    """
    right = {"corrected": run.readings["visual_volume"]["default"]}
    for name, volume in {**run.readings["collision_volume"], **right}.items():
        mass = run.readings["bowl_mass"][name]
        yield nearly(f"{name}.mass_kg", mass, 1e-6 * DENSITY * volume, SHARE)


def small_balls_count_as_inside(run: Experiment) -> Iterator[Finding]:
    """All balls of 4 mm count as inside in each run, whether they sank in or not."""
    for name in bowls.SMALL:
        yield equal(f"{name}.inside_percent", run.metrics[name].inside, 100.0)
        yield noted(f"{name}.sunk", sunk(run, name))


def fast_small_balls_sink(run: Experiment) -> Iterator[Finding]:
    """With steps of 1 ms, balls of 4 mm sink into the foot if v T / e exceeds their radius: from
    above the rim some do, in hulls and in pieces, and from a start inside the bowl none.
    """
    for name, case in bowls.SMALL.items():
        if case.h < bowls.T / 5:
            label, found = f"{name}.sunk", sunk(run, name)
            yield above(label, found, 0) if case.depth > case.radius else equal(label, found, 0)
            yield noted(f"{name}.depth_m", case.depth)


def laws_of_motion(run: Experiment) -> Iterator[Finding]:
    """The balls fall freely until one can touch a bowl, and all together never gain energy."""
    for name, case in run.cases.items():
        yield from kept(name, falling_balls(run.traces[name], case))


def falling_balls(trace: BodyTrace, case: BowlCase) -> Iterator[Finding]:
    """Yield what no run of `bowls.run_case` has."""
    yield from times(trace, case.steps, case.dt)
    yield from unit_quaternions(trace.link_quat)
    fallen = summed_drop(case.h, case.substeps * np.arange(case.steps + 1))
    free = slice(int((case.drop > fallen).sum()) or 1)  # states in which nothing can touch
    down = np.array([0.0, 0.0, 1.0])
    place = case.starts - fallen[free, None, None] * down
    motion = -GRAVITY * trace.t[free, None, None] * down
    yield from apart("motion", "free link_pos [m]", trace.link_pos[free], place, FALLEN)
    yield from apart("motion", "free link_vel [m/s]", trace.link_vel[free], motion, FALLING)
    yield from apart("motion", "free link_quat", trace.link_quat[free], UNTURNED, 0.0)
    yield from apart("motion", "free link_ang [rad/s]", trace.link_ang[free], ZERO, 0.0)
    height = trace.link_pos[..., 2].astype(np.float64).sum(axis=1)
    moving, turning = (
        (np.asarray(of, np.float64) ** 2).sum(axis=(1, 2)) / 2
        for of in (trace.link_vel, trace.link_ang)
    )
    energy = GRAVITY * height + moving + 0.4 * case.radius**2 * turning
    gained = np.maximum(np.stack([energy[1:] - energy[0], np.diff(energy)]) / energy[0], 0)
    room = np.array([[SHARE], [GAIN]])
    yield from apart("motion", "energy gained since the start, and in a step", gained, ZERO, room)


CHECKS = (
    stamps, one_hull_holds_none, others_hold_all, hulls_cover, finer_is_closer,
    mass_is_of_collision, small_balls_count_as_inside, fast_small_balls_sink, laws_of_motion,
)  # fmt: skip

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
