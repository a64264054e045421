"""Tables of the studies of landings, slides and engines, as rows for a page to display."""

from collections.abc import Sequence

import numpy as np

from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.metrics import CLEAR, CaseMetrics, LandingMetrics
from robo_genesis.lessons.l03.study import Studies, distance_between, solver_step


def step_rows(run: Studies) -> Sequence[dict[str, str]]:
    """Return one row a solver step, for a table on a page."""
    rows = []
    for name in spec.STEPS_STUDIED:
        found = run.landings(name)
        depths = [1000 * of.penetration for of in found]
        high = [1000 * of.rebound for of in found]
        rows.append(
            {
                "solver step h [ms]": f"{1000 * solver_step(name):g}",
                "time constant [ms]": f"{1000 * run.time_constants[name]:g}",
                "penetration proxy, least to most [mm]": f"{min(depths):.2f} to {max(depths):.2f}",
                "cubes that rebound": f"{sum(of.rebound > CLEAR for of in found)} of {len(found)}",
                "highest rebound [mm]": f"{max(high):.2f}",
            }
        )
    return rows


def slide_rows(
    run: Studies, names: Sequence[str], stepped: bool = False
) -> Sequence[dict[str, str]]:
    """Return one row a slide, with Coulomb's distance beside it.

    Args:
        run: the studies.
        names: of the slides.
        stepped: whether to give the formula's value in solver steps.
    """
    rows = []
    for name in names:
        case, found = spec.STUDY_CASES[name], run.slide(name)
        friction = max(case.friction, case.surface_friction)
        formula = sliding.coulomb_distance(case.speed, friction, case.gravity)
        less = case.speed * case.h / 2 if stepped else 0.0
        stop, head = found.stop_distance, "v² / (2 μ g)" + (" − v h / 2" if stepped else "")
        rows.append(
            {
                "run": name,
                "μ of the pair": f"{friction:g}",
                "stopping distance [m]": "not observed" if stop is None else f"{stop:.5f}",
                f"{head} [m]": f"{formula - less:.5f}",
                "hop [mm]": f"{1000 * found.hop:.2f}",
                "largest angular speed [rad/s]": f"{found.spin:.2f}",
            }
        )
    return rows


def engine_rows(run: Studies) -> Sequence[dict[str, str]]:
    """Return one row a pair of runs: how far apart the engines are, from when on, with contacts."""
    rows = []
    for name, other in (*spec.ENGINE_PAIRS.items(), ("baseline", spec.OWN_DEFAULTS)):
        far = distance_between(run, name, other)
        over = np.flatnonzero(far > spec.ENGINES_APART)
        parts = f"{run.traces[other].t[over[0]]:.2f} s" if len(over) else "never"
        both = (run.traces[of].contacts[:, 0] for of in (name, other))
        found = (counts[over[0]] if len(over) else "–" for counts in both)
        high = (f"{1000 * rise(run.metrics[of]):.2f}" for of in (name, other))
        largest = far.max()
        rows.append(
            {
                "Genesis": name,
                "MuJoCo": other,
                "rebound or hop [mm]": " and ".join(high),
                "farthest apart": f"{1e6 * largest:.2g} µm"
                if largest < 1e-3
                else f"{1000 * largest:.2f} mm",
                "over 0.05 mm from": parts,
                "contacts there": " and ".join(map(str, found)),
            }
        )
    return rows


def rise(found: CaseMetrics) -> float:
    """Return how high a body comes above the surface after it touched it [m]."""
    return found.rebound if isinstance(found, LandingMetrics) else getattr(found, "hop", 0.0)
