"""The bowl of L07, and the checks of balls that fall into it, on made-up runs."""

import numpy as np
import pytest
from lessons.changed_runs import reading, shift, trace
from lessons.experiments import require_spoilers

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import BodyTrace
from robo_genesis.lessons.l07 import bowls, plots, text
from robo_genesis.lessons.l07.bowl_checks import MESHES, laws_of_motion
from robo_genesis.lessons.l07.bowls import BALLS
from robo_genesis.sim.bodies import bowl
from robo_genesis.sim.bodies.free_fall import GRAVITY, summed_drop
from robo_genesis.sim.bodies.rigid_bodies import times

SUNK = {"small_in_default_h1000us", "small_in_pieces_h1000us"}


def fallen(case, end):
    """Return a run of balls that fall freely, and stay at a height and a distance once there."""
    down = summed_drop(case.h, case.substeps * np.arange(case.steps + 1))[:, None]
    place = np.repeat(case.starts[None], case.steps + 1, axis=0)
    height = place[..., 2] - down
    rest = height < end[1]
    place[..., 2] = np.where(rest, end[1], height)
    place[rest] = [end[0], 0, end[1]]
    motion = np.zeros_like(place)
    motion[..., 2] = np.where(rest, 0, -GRAVITY * times(case)[:, None])
    unturned = np.broadcast_to([1, 0, 0, 0], (*place.shape[:2], 4))
    return BodyTrace(
        times(case), *map(np.float32, (place, unturned, motion, 0 * motion))
    )


def end_of(name, case):
    """Return the distance from the axis and the height at which the balls of a run end [m]."""
    beside, sunk = name == "in_one_hull", name in SUNK
    return 0.3 * beside, case.radius + bowl.WALL * (not beside) - 0.003 * sunk


@pytest.fixture(scope="module")
def run():
    volume = {"one_hull": 590.0, "default": 190.0, "pieces": 114.0, "visual": 114.0}
    mass = {of: 1e-6 * bowl.DENSITY * volume[of] for of in bowl.CHOICES}
    flat = {
        of: dict.fromkeys(MESHES.readings[of].units, bowl.HEIGHT)
        for of in MESHES.readings
    }
    known = flat | {
        "bowl_volume": volume,
        "bowl_mass": mass,
    }
    traces = {
        name: fallen(case, end_of(name, case)) for name, case in bowls.CASES.items()
    }
    return Experiment(MESHES, traces, BALLS, known, {}, False)


def test_volume_of_the_mesh_is_that_of_its_facets_and_of_the_pieces():
    def solid(profile):
        (r, z) = profile.T
        cones = np.diff(z) * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) / 3
        return bowl.SECTIONS / 2 * np.sin(2 * np.pi / bowl.SECTIONS) * cones.sum()

    outer, inner = map(solid, bowl.profiles())
    mesh, pieces = bowl.mesh(), bowl.pieces()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(outer - inner, rel=1e-9)
    assert sum(piece.volume for piece in pieces) == pytest.approx(mesh.volume, rel=1e-6)
    assert mesh.bounds[:, 2].tolist() == [0, bowl.HEIGHT]
    assert bowls.outside(pieces, mesh.triangles_center).max() < 1e-9
    assert bowls.outside([mesh.convex_hull], np.array([[0, 0, 0.06]]))[
        0
    ] == pytest.approx(0.01)


def test_balls_inside_are_counted_and_the_lowest_is_found(run):
    inside = run.metrics["in_default"]
    assert (inside.inside, inside.lowest) == (100, pytest.approx(bowl.WALL))
    assert (run.metrics["in_one_hull"].inside, run.metrics["in_one_hull"].lowest) == (
        0,
        None,
    )


SPOILED = {
    "one_hull_holds_none": reading("top_one_hull", "x_+0mm", 0.049),
    "others_hold_all": trace("in_pieces", link_pos=shift((..., 0), 0.2)),
    "default_is_closer": reading("bowl_volume", "one_hull", 300.0),
    "mass_is_of_collision": reading("bowl_mass", "default", 0.046),
    "fast_small_balls_sink": trace(
        "small_in_pieces_h1000us", link_pos=shift((..., 0), 0.2)
    ),
    "stamps": trace("in_pieces", t=lambda t: 2 * t),
}


def test_each_check_fails_on_its_own_fault(run):
    require_spoilers(run, SPOILED.items())


@pytest.mark.parametrize("array", ["link_pos", "link_vel"])
def test_no_ball_moves_otherwise_in_the_air(run, array):
    spoiled = trace("in_default", **{array: shift((3, 0, 2), 500.0)})(run)
    wrong = [one.label for one in laws_of_motion(spoiled) if not one.passed]
    assert [array in label for label in wrong] == [True]


def test_tables_and_figure_show_the_runs(run):
    assert "12 of 12" in text.bowl_table(run)
    assert "from inside" in text.bowl_runs(run, "SMALL")
    assert len(plots.bowl_section(run).axes) == len(bowls.CUT)
