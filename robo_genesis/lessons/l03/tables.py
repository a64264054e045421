"""Tables of landings, slides and engines: functions of the experiment, and rows."""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import checks, friction, spec, study
from robo_genesis.lessons.l03.metrics import CLEAR, LandingMetrics
from robo_genesis.lessons.l03.study import distance_between, landings_at, slide, solver_step
from robo_genesis.sim.contacts import ContactCase

Rows = Sequence[dict[str, str]]
Metrics = Mapping[str, CaseMetrics]


def landings(run: Experiment) -> str:
    """Return the metrics of the dropped cubes."""
    return tables.six_digits(checks.landings(run))


def slides(run: Experiment) -> str:
    """Return the metrics of the pushed cubes."""
    return tables.six_digits(checks.slides(run))


def bounces(run: Experiment) -> str:
    """Return the metrics of the balls."""
    return tables.six_digits(checks.bounces(run))


def steps(run: Experiment) -> str:
    """Return the landings of each solver step with the engine's time constant of a contact."""
    return tables.markdown(step_rows(run.metrics, run.readings[study.GROUP]))


def pushed(run: Experiment) -> str:
    """Return the slides with the engine's default friction model beside Coulomb's distance."""
    return tables.markdown(slide_rows(run.metrics, study.PUSHED))


def cones(run: Experiment) -> str:
    """Return the slides with all friction models beside Coulomb's distance in steps."""
    names = [*study.PUSHED, *spec.CLEAN_SLIDES, *spec.CONVEX_SLIDES]
    return tables.markdown(slide_rows(run.metrics, names, stepped=True))


def first_impulses(run: Experiment) -> str:
    """Return the impulses of the first outer step of the pushed cubes."""
    rows = []
    for name in study.PUSHED:
        case = spec.REPEATED[name]
        lost, gained = study.first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        rows.append(
            {
                "cube": name,
                "lost along x [m/s]": f"{lost:.4f}",
                "given upwards by the contact [m/s]": f"{gained:.4f}",
                "their ratio": f"{lost / gained:.4f}",
                "μ of the pair": f"{mu:g}",
                "μ g dt, friction under the weight [m/s]": f"{mu * case.gravity * case.dt:.4f}",
            }
        )
    return tables.markdown(rows)


def engines(run: Experiment) -> str:
    """Return how far the pairs of runs in two engines are apart."""
    return tables.markdown(engine_rows(run.traces, run.metrics))


def landing_rows(cases: Mapping[str, ContactCase]) -> Rows:
    """Return one row per case: its steps and the resulting numbers of states and solver steps."""
    return [
        {
            "case": f"`{name}`",
            "dt [ms]": f"{1000 * case.dt:g}",
            "substeps": str(case.substeps),
            "h [ms]": f"{1000 * case.h:g}",
            "states": str(case.steps + 1),
            "solver steps": str(case.steps * case.substeps),
        }
        for name, case in cases.items()
    ]


def step_rows(metrics: Metrics, time_constants: Mapping[str, float]) -> Rows:
    """Return one row per solver step, with the engine's time constant of a contact [s]."""
    rows = []
    for name in spec.STEPS_STUDIED:
        found = landings_at(metrics, name)
        depths = [1000 * of.penetration for of in found]
        rows.append(
            {
                "solver step h [ms]": f"{1000 * solver_step(name):g}",
                "time constant [ms]": f"{1000 * time_constants[name]:g}",
                "penetration proxy, least to most [mm]": f"{min(depths):.2f} to {max(depths):.2f}",
                "cubes that rebound": f"{sum(of.rebound > CLEAR for of in found)} of {len(found)}",
                "highest rebound [mm]": f"{max(1000 * of.rebound for of in found):.2f}",
            }
        )
    return rows


def slide_rows(metrics: Metrics, names: Sequence[str], stepped: bool = False) -> Rows:
    """Return one row per slide, with Coulomb's distance.

    Args:
        metrics: of the slides, by case.
        names: the slides to show.
        stepped: whether to give the value of the formula in solver steps.
    """
    rows = []
    formula = "v² / (2 μ g)" + (" − v h / 2" if stepped else "")
    for name in names:
        case, found = spec.STUDY_CASES[name], slide(metrics, name)
        mu = friction.pair_friction(case)
        distance = friction.coulomb_distance(case.speed, mu, case.gravity)
        distance -= case.speed * case.h / 2 if stepped else 0.0
        stop = found.stop_distance
        rows.append(
            {
                "run": name,
                "μ of the pair": f"{mu:g}",
                "stopping distance [m]": "not observed" if stop is None else f"{stop:.5f}",
                f"{formula} [m]": f"{distance:.5f}",
                "hop [mm]": f"{1000 * found.hop:.2f}",
                "largest angular speed [rad/s]": f"{found.spin:.2f}",
            }
        )
    return rows


def engine_rows(traces: Mapping[str, ContactTrace], metrics: Metrics) -> Rows:
    """Return one row per pair of runs: the distance between the engines, and its first excess."""
    rows = []
    for pair in (*spec.ENGINE_PAIRS.items(), ("baseline", spec.OWN_DEFAULTS)):
        distance = distance_between(traces, *pair)
        excess = np.flatnonzero(distance > spec.ENGINES_APART)
        since, counts = "never", ["–", "–"]
        if len(excess):
            since = f"{traces[pair[1]].t[excess[0]]:.2f} s"
            counts = [str(traces[name].contacts[excess[0], 0]) for name in pair]
        heights = [f"{1000 * rise(metrics[name]):.2f}" for name in pair]
        mm = 1000 * float(distance.max())
        rows.append(
            {
                "Genesis": pair[0],
                "MuJoCo": pair[1],
                "rebound or hop [mm]": " and ".join(heights),
                "farthest apart": f"{1000 * mm:.2g} µm" if mm < 1 else f"{mm:.2f} mm",
                "over 0.05 mm from": since,
                "contacts there": " and ".join(counts),
            }
        )
    return rows


def rise(found: CaseMetrics) -> float:
    """Return the largest height of a body above the surface after the first contact [m]."""
    return found.rebound if isinstance(found, LandingMetrics) else getattr(found, "hop", 0.0)
