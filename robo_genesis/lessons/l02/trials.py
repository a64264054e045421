"""What the lecture measures beside its runs: geometry, balls in trays, falls after `build`."""

from collections.abc import Mapping
from typing import Any

from robo_genesis.core.checks import Findings, above, below, equal, within
from robo_genesis.core.experiment import Experiment, Readings, counts
from robo_genesis.sim.bodies.free_fall import summed_drop
from robo_genesis.sim.common_checks import usable_frame

from . import spec

# Groups of a bundle's metrics: counts of geometry, heights of balls, distances fallen.
SHAPES, TRAYS, FURTHER = "shapes", "trays", "further"

# The two trays: several convex pieces, and one convex hull.
PIECES, HULL = "pieces", "hull"

FALLS = ("higher", "thrown", "heavier", "moon")


READINGS = {
    SHAPES: counts(spec.COUNTS),
    TRAYS: Readings(dict.fromkeys((PIECES, HULL), "m")),
    FURTHER: Readings(dict.fromkeys(FALLS, "m")),
}


def count_shapes(entities: Mapping[str, Any]) -> dict[str, int]:
    """Return the counts of the visual and collision geometry of entities, by name."""
    found: dict[str, int] = {}
    for name, entity in entities.items():
        for what, geoms in (("seen", entity.vgeoms), ("felt", entity.geoms)):
            found[f"{name}_{what}"] = sum(
                len(geom.get_trimesh().faces) for geom in geoms
            )
        found[f"{name}_pieces"] = len(entity.geoms)
    return found


def shape_rows(entities: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return one row for each entity, for a table on the page."""
    found = count_shapes(entities)
    return [
        {
            "entity": name,
            "made by": type(entity.morph).__name__,
            "visual triangles": found[f"{name}_seen"],
            "collision triangles": found[f"{name}_felt"],
            "collision geoms": found[f"{name}_pieces"],
            "mass [kg]": float(entity.get_mass()),
            "DOFs": entity.n_dofs,
            "qpos": entity.n_qs,
        }
        for name, entity in entities.items()
    ]


def two_geometries(run: Experiment) -> Findings:
    """The box is one geom and collides with what is drawn; the hammer has two geoms. The
    duck collides with fewer triangles than are drawn, the tray with several pieces for
    one drawn mesh.
    """
    found = run.readings[SHAPES]
    for name, geoms in (("box", 1), ("hammer", 2)):
        yield equal(f"{name}_pieces", found[f"{name}_pieces"], geoms)
    yield equal("box_felt", found["box_felt"], found["box_seen"])
    yield above("duck_pieces", found["duck_pieces"], 0)
    yield below("duck_felt", found["duck_felt"], found["duck_seen"])
    yield above("tray_pieces", found["tray_pieces"], 1)


def invisible_lid(run: Experiment) -> Findings:
    """A ball rests on the floor of a tray of several collision pieces, and on the rim
    of a tray with a single one.
    """
    found = run.readings[TRAYS]
    yield within("ball_in_pieces_m", found[PIECES], spec.BALL, spec.RESTING)
    yield within("ball_on_the_hull_m", found[HULL], spec.RIM + spec.BALL, spec.RESTING)
    if run.rendered:
        yield usable_frame(spec.TRAYS, run.frames[spec.TRAYS])


def expected_falls() -> dict[str, float]:
    """Return the distance fallen by the stepped formula under each change [m]."""
    case = spec.BASELINE
    n = case.steps * case.substeps
    drop, moon = (summed_drop(case.h, n, g) for g in (case.gravity, spec.MOON))
    seconds = case.steps * case.dt
    return dict(
        zip(FALLS, (drop, drop - spec.THROWN * seconds, drop, moon), strict=True)
    )


def further_falls(run: Experiment) -> Findings:
    """After build, another height, speed, mass and gravity are accepted, and the
    stepped formula holds with each.
    """
    for name, expected in expected_falls().items():
        yield within(
            f"{name}_m", run.readings[FURTHER][name], expected, spec.FURTHER_TOLERANCE
        )


CHECKS = (two_geometries, invisible_lid, further_falls)
