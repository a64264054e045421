"""Tables of the lecture and the deeper pages: functions of the experiment, and rows."""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.metrics import CaseMetrics
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import (
    friction,
    spec,
    study,
    study_contact,
    study_spec,
    tables,
    theory,
)
from robo_genesis.lessons.l03.metrics import CLEAR, LandingMetrics
from robo_genesis.lessons.l03.study import slide

MEASURES = False

Rows = Sequence[dict[str, str]]
Metrics = Mapping[str, CaseMetrics]


def milliseconds(seconds: float) -> str:
    """Write a time in milliseconds: `0.125 ms`."""
    return f"{1000 * seconds:.3g} ms"


def millimetres(length: float) -> str:
    """Write a length in millimetres with three significant digits: `7.54 mm`."""
    value = 1000 * length
    return f"{value:#.3g} mm" if abs(value) >= 0.01 else "0 mm"


def span(values: Sequence[float], digits: int = 2) -> str:
    """Write the smallest and the largest value: `0.94 to 0.96`."""
    return f"{min(values):.{digits}f} to {max(values):.{digits}f}"


def steps(run: Experiment) -> str:
    """Return the landings by solver step: time constant, depth by hand and measured, rebounds."""
    rows = []
    for name in study_spec.STEP_CASES:
        case, found = study.case_of(name), study.landings_of(run.metrics, name)
        rebounding = sum(of.rebound > CLEAR for of in found)
        rows.append(
            {
                "h": milliseconds(case.h),
                "T in force": milliseconds(run.readings[study.GROUP][name]),
                "h / T": f"{study.share_of_step(name):.3g}",
                "depth": f"{span([1000 * of.penetration for of in found], 1)} mm",
                "depth / (v T / e)": span(study.depth_shares(run.metrics, name)),
                "rebounds": f"{rebounding} of {len(found)}",
            }
        )
    return tables.markdown(rows)


def depths(run: Experiment) -> str:
    """Return depth by hand and measured from the lab's height, for both time constants."""
    finest = min(study_spec.STEP_CASES, key=study.share_of_step)
    rows = []
    for scene in (finest, study_spec.STIFF):
        name = f"{scene}_10000"
        case, found = study.ROWS[scene][name], run.metrics[name].penetration
        rows.append(
            {
                "T": milliseconds(theory.contact_seconds(case)),
                "h": milliseconds(case.h),
                "v": f"{theory.impact_speed(case):.2f} m/s",
                "v T / e": millimetres(theory.depth(case)),
                "measured": millimetres(found),
                "nine heights, measured / (v T / e)": span(study.depth_shares(run.metrics, scene)),
            }
        )
    return tables.markdown(rows)


def before_after(run: Experiment) -> str:
    """Return the stopping distances on both tables, by the cube's own coefficient."""
    rows = []
    for lane in ("low", "high"):
        names = [f"{lane}_on_{of}_elliptic" for of in ("050", "030")]
        cases = [run.cases[name] for name in names]
        found = [slide(run.metrics, name).stop_distance for name in names]
        before, after = (f"{of.surface_friction:g}" for of in cases)
        rows.append(
            {
                "friction of the cube": f"{cases[0].friction:g}",
                f"stops after (table {before})": metres(found[0]),
                f"stops after (table {after})": metres(found[1]),
                f"μ of the pair, table {before}": f"{friction.pair_friction(cases[0]):g}",
                f"μ of the pair, table {after}": f"{friction.pair_friction(cases[1]):g}",
            }
        )
    return tables.markdown(rows)


def metres(length: float | None) -> str:
    """Write a distance in metres with tenths of a millimetre."""
    return "not observed" if length is None else f"{length:.4f} m"


def clean_slides(run: Experiment) -> str:
    """Return the slides with the elliptic cone beside Coulomb's distance."""
    rows = []
    for name in study.clean(run):
        case, found = run.cases[name], slide(run.metrics, name)
        mu = friction.pair_friction(case)
        continuous = friction.coulomb_distance(case.speed, mu, case.gravity)
        rows.append(
            {
                "cube on table": f"{case.friction:g} on {case.surface_friction:g}",
                "h": milliseconds(case.h),
                "measured": metres(found.stop_distance),
                "v² / (2 μ g)": metres(continuous),
                "v² / (2 μ g) − v h / 2": metres(continuous - case.speed * case.h / 2),
                "hop": millimetres(found.hop),
            }
        )
    return tables.markdown(rows)


def hops_by_step(run: Experiment) -> str:
    """Return the hops by solver step for both coefficients, with the formula of one step."""
    rows = []
    for name, cases in study_spec.HOP_STEP_CASES.items():
        case = cases[f"{name}_low"]
        row = {
            "h": milliseconds(case.h),
            "h / T": f"{case.h / theory.contact_seconds(case):.3g}",
        }
        for lane in ("low", "high"):
            of = cases[f"{name}_{lane}"]
            mu = friction.pair_friction(of)
            row[f"μ = {mu:g}"] = millimetres(slide(run.metrics, f"{name}_{lane}").hop)
            row[f"formula, μ = {mu:g}"] = millimetres(theory.hop(of))
        rows.append(row)
    return tables.markdown(rows)


def hops_by_speed(run: Experiment) -> str:
    """Return the hops by the speed of the push at a solver step of 5 ms."""
    return tables.markdown(
        [
            {
                "push": f"{case.speed:g} m/s",
                "hop": millimetres(slide(run.metrics, name).hop),
                "formula": millimetres(theory.hop(case)),
            }
            for name, case in study_spec.HOP_SPEED_CASES.items()
        ]
    )


def settings_of_cones(run: Experiment) -> str:
    """Return the pushed cubes by what the setting of the cone switches."""
    rows = []
    kinds = (("", "convex", "1"), ("_convex", "convex", "1"), ("_elliptic", "signorini", "100"))
    for suffix, resolution, impratio in kinds:
        for name in (f"{of}{suffix}" for of in study_spec.HOPPED):
            case, found = run.cases[name], slide(run.metrics, name)
            mu = friction.pair_friction(case)
            distance = found.stop_distance
            apparent = (
                "not observed"
                if distance is None
                else f"{friction.apparent_friction(case.speed, distance, case.gravity):.3f}"
            )
            rows.append(
                {
                    "cone": case.cone,
                    "resolution": resolution,
                    "impratio": impratio,
                    "μ": f"{mu:g}",
                    "hop": millimetres(found.hop),
                    "turns at up to": f"{found.spin:.2f} rad/s",
                    "stops after": metres(distance),
                    "apparent μ": apparent,
                }
            )
    return tables.markdown(rows)


def first_impulses(run: Experiment) -> str:
    """Return the impulses of the first outer step of the pushed cubes."""
    rows = []
    for name in study_spec.HOPPED:
        case = run.cases[name]
        lost, gained = study.first_impulses(run.traces[name], case)
        mu = friction.pair_friction(case)
        rows.append(
            {
                "μ of the pair": f"{mu:g}",
                "lost along x": f"{lost:.3f} m/s",
                "gained upwards": f"{gained:.3f} m/s",
                "their ratio": f"{lost / gained:.3f}",
                "formula, upwards": f"{theory.upward_blow(case):.3f} m/s",
                "μ g dt, under the weight": f"{mu * case.gravity * case.dt:.3f} m/s",
            }
        )
    return tables.markdown(rows)


def stops_by_step(run: Experiment) -> str:
    """Return the stopping distances of both pushed cubes by solver step."""
    low, high = (study_contact.runs_of_lane(lane) for lane in ("low", "high"))
    return tables.markdown(
        [
            {
                "h": milliseconds(case.h),
                "μ = 0.5 stops after": metres(slide(run.metrics, one).stop_distance),
                "μ = 0.8 stops after": metres(slide(run.metrics, other).stop_distance),
                "μ = 0.8 takes": seconds(slide(run.metrics, other).stop_time),
            }
            for (one, case), other in zip(low.items(), high, strict=True)
        ]
    )


def seconds(time: float | None) -> str:
    """Write a time in seconds."""
    return "not observed" if time is None else f"{time:.2f} s"


def engines(run: Experiment) -> str:
    """Return how far the pairs of runs in two engines are apart."""
    return tables.markdown(engine_rows(run.traces, run.metrics))


def engine_rows(traces: Mapping[str, ContactTrace], metrics: Metrics) -> Rows:
    """Return one row per pair of runs: the distance between the engines, and its first excess."""
    rows = []
    for pair in (*study_spec.ENGINE_PAIRS.items(), ("baseline", study_spec.OWN_DEFAULTS)):
        distance = study_contact.distance_between(traces, *pair)
        excess = np.flatnonzero(distance > study_spec.ENGINES_APART)
        since, counts = "never", ["–", "–"]
        if len(excess):
            since = f"{traces[pair[1]].t[excess[0]]:.2f} s"
            counts = [str(traces[name].contacts[excess[0], 0]) for name in pair]
        heights = [f"{1000 * rise(metrics[name]):.2f}" for name in pair]
        rows.append(
            {
                "run": described(*pair),
                "rebound or hop [mm]": " and ".join(heights),
                "farthest apart": apart(float(distance.max())),
                "over 0.05 mm from": since,
                "contacts there": " and ".join(counts),
            }
        )
    return rows


def described(name: str, other: str) -> str:
    """Describe a pair of runs, in Genesis and in the other engine, by what distinguishes it."""
    case = study_spec.BY_BOTH[name]
    if case.speed:
        return f"push, {case.cone}, μ = {friction.pair_friction(case):g}"
    own = ", MuJoCo's own contact" if other == study_spec.OWN_DEFAULTS else ""
    return f"landing, h = {milliseconds(case.h)}{own}"


def apart(distance: float) -> str:
    """Write a distance between two runs [m]."""
    micrometres = 1e6 * distance
    if micrometres < 0.01:
        return "below 0.01 µm"
    return f"{micrometres:.2g} µm" if micrometres < 1000 else f"{1000 * distance:.2f} mm"


def rise(found: CaseMetrics) -> float:
    """Return the largest height of a body above the surface after the first contact [m]."""
    return found.rebound if isinstance(found, LandingMetrics) else getattr(found, "hop", 0.0)


def releases(run: Experiment) -> str:
    """Return release speed and rebound by time constant, beside the linear contact."""
    rows = []
    for scene in study_spec.RELEASE_CASES:
        cases, found = study.ROWS[scene].values(), study.landings_of(run.metrics, scene)
        speeds = [theory.impact_speed(case) for case in cases]
        shares = [of.upward_speed / v for of, v in zip(found, speeds, strict=True)]
        case = study.case_of(scene)
        rows.append(
            {
                "T": milliseconds(theory.contact_seconds(case)),
                "h": milliseconds(case.h),
                "upward speed / impact speed": span(shares, 3),
                "rebound": heights([of.rebound for of in found]),
                "linear contact": heights([theory.rebound(case) for case in cases]),
            }
        )
    return tables.markdown(rows)


def heights(rebounds: Sequence[float]) -> str:
    """Write the smallest and the largest rebound."""
    if max(rebounds) <= CLEAR:
        return "none"
    return f"{span([1000 * rebound for rebound in rebounds])} mm"


def kept_by_step(run: Experiment) -> str:
    """Return the energy that the ball keeps at its first bounce by solver step."""
    return tables.markdown(
        [
            {
                "substeps in 10 ms": str(case.substeps),
                "h": milliseconds(case.h),
                "kept at the first bounce": percent(run.metrics[name].first_kept),
                "left after 4 bounces": percent(run.metrics[name].later_kept),
                "total energy changes in a flight by": millijoule(run.metrics[name].flight_change),
            }
            for name, case in spec.BOUNCES.items()
        ]
    )


def percent(share: float | None) -> str:
    """Write a share in percent."""
    return "not observed" if share is None else f"{share:.1f} %"


def millijoule(energy: float | None) -> str:
    """Write an energy in millijoules."""
    return "not observed" if energy is None else f"{1000 * energy:.2f} mJ"
