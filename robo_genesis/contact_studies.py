"""What a landing and a slide owe to the solver's step, to the friction model, and to the engine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis import l03, second_contacts, sliding
from robo_genesis.checks import Check, evaluate
from robo_genesis.contact_metrics import CLEAR, CaseMetrics, LandingMetrics, SlideMetrics
from robo_genesis.contacts import ContactCase
from robo_genesis.trace import ContactTrace

GROUP = "time_constant"
"""Of a bundle's metrics: what the engine gives a contact at each solver step [s]."""

LEFT_OVER = 5e-4
"""What the depth of a landing may still change by between the two finest steps [m]."""

STEPPED_APART = 2e-4
"""What a slide on four corners may differ from the stepped formula by [m]."""

NEARLY = 0.05
"""What a stopping distance may differ from Coulomb's by and be called nearly right, as a share."""

HOP = 0.01
"""From which clearance on a slide is called a hop [m]."""

RATIO_APART = 0.02
"""What the ratio of two impulses may differ from the coefficient of friction by."""

PUSHED_PAIRS = (("low_on_050", "low_elliptic"), ("high_on_050", "high_elliptic"))
"""The slides with either model of friction, the engine's default first."""


@dataclass(frozen=True, slots=True)
class Studies:
    """All runs of the lecture with their metrics, and the contacts' time constants by case [s]."""

    traces: Mapping[str, ContactTrace]
    metrics: Mapping[str, CaseMetrics]
    time_constants: Mapping[str, float]

    def landing(self, name: str) -> LandingMetrics:
        """Return the metrics of a run that lands."""
        found = self.metrics[name]
        if not isinstance(found, LandingMetrics):
            raise KeyError(f"{name} is no landing")
        return found

    def slide(self, name: str) -> SlideMetrics:
        """Return the metrics of a run that slides."""
        found = self.metrics[name]
        if not isinstance(found, SlideMetrics):
            raise KeyError(f"{name} is no slide")
        return found


def first_impulses(trace: ContactTrace, case: ContactCase) -> tuple[float, float]:
    """Return what the first outer step took from v_x and gave to v_z against gravity [m/s].

    Both are an impulse of the contact divided by the mass.
    """
    before, after = (trace.link_vel[k, 0].astype(np.float64) for k in (0, 1))
    return float(before[0] - after[0]), float(after[2] - before[2] + case.gravity * case.dt)


def apart(run: Studies, first: str, second: str) -> np.ndarray:
    """Return the distance of two runs' centres at each shared state, (n+1,) [m]."""
    paths = (run.traces[name].link_pos[:, 0].astype(np.float64) for name in (first, second))
    one, other = paths
    return np.linalg.norm(one - other, axis=1)


def time_constants(run: Studies) -> list[str]:
    """The engine gives a contact a time constant of 10 ms, and never less than two solver steps."""
    return [
        f"{name}: the engine has {run.time_constants[name]:g} s, expected "
        f"{second_contacts.time_constant(case.h):g} s"
        for name, case in l03.STEP_CASES.items()
        if abs(run.time_constants[name] - second_contacts.time_constant(case.h)) > 1e-8
    ]


def records_each_step(run: Studies) -> list[str]:
    """With every solver step recorded, the baseline moves as it does with every second one."""
    fine, coarse = run.traces["h_5000us"].link_pos, run.traces["baseline"].link_pos
    shared = fine[:: l03.BASELINE.substeps]
    far = float(np.abs(shared - coarse[: len(shared)]).max())
    return [] if far <= l03.SAME_STATE else [f"they are up to {far:g} m apart"]


def rebound_goes(run: Studies) -> list[str]:
    """The baseline's cube leaves the surface again; with no other solver step it does."""
    rebound = run.landing("baseline").rebound
    problems = [] if rebound > CLEAR else [f"the baseline rebounds by {rebound:g} m only"]
    return problems + [
        f"{name} rebounds by {run.landing(name).rebound:g} m"
        for name, case in l03.STEP_CASES.items()
        if case.h != l03.BASELINE.h and run.landing(name).rebound > CLEAR
    ]


def depth_converges(run: Studies) -> list[str]:
    """The two smallest solver steps sink in alike, and the largest one more than twice as far."""
    by_step = sorted(l03.STEP_CASES, key=lambda name: l03.STEP_CASES[name].h)
    finest, fine, coarsest = (run.landing(by_step[k]).penetration for k in (0, 1, -1))
    problems = []
    if abs(fine - finest) > LEFT_OVER:
        problems.append(f"the finest two are {abs(fine - finest):g} m apart")
    if not coarsest > 2 * finest:
        problems.append(f"the coarsest sinks in by {coarsest:g} m, the finest by {finest:g} m")
    return problems


def default_cone_hops(run: Studies) -> list[str]:
    """With the engine's default friction model, both pushed cubes leave the surface."""
    return [
        f"{name} is never higher than {run.slide(name).hop:g} m"
        for name, _ in PUSHED_PAIRS
        if not run.slide(name).hop > HOP
    ]


def stops_nearly_right(run: Studies) -> list[str]:
    """And yet the cube of the surface's friction stops near v² / (2 μ g)."""
    name = PUSHED_PAIRS[0][0]
    case, found = l03.REPEATED[name], run.slide(name).stop_distance
    expected = sliding.coulomb_distance(case.speed, case.surface_friction, case.gravity)
    if found is not None and abs(found - expected) <= NEARLY * expected:
        return []
    return [f"{name} stops at {found} m, Coulomb has {expected:g} m"]


def hop_is_paid_by_friction(run: Studies) -> list[str]:
    """In the first step v_x loses μ times what v_z gains: the impulses obey Coulomb's law."""
    problems = []
    for name, _ in PUSHED_PAIRS:
        case = l03.REPEATED[name]
        lost, gained = first_impulses(run.traces[name], case)
        friction = max(case.friction, case.surface_friction)
        if not abs(lost / gained - friction) <= RATIO_APART:
            problems.append(f"{name} loses {lost:g} m/s along x and gains {gained:g} m/s upwards")
    return problems


def elliptic_stays_down(run: Studies) -> list[str]:
    """With the elliptic cone the cubes stay on the surface, on four corners at every sample."""
    problems = []
    for name in l03.CONE_CASES:
        corners = set(run.traces[name].contacts[:, 0].tolist())
        if run.slide(name).hop > CLEAR or corners != {4}:
            problems.append(f"{name} rises by {run.slide(name).hop:g} m, with {corners} contacts")
    return problems


def elliptic_is_stepped_coulomb(run: Studies) -> list[str]:
    """There, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."""
    problems = []
    for name, case in l03.CONE_CASES.items():
        friction = max(case.friction, case.surface_friction)
        expected = sliding.stepped_distance(case.speed, friction, case.h, case.gravity)
        found = run.slide(name).stop_distance
        if found is None or abs(found - expected) > STEPPED_APART:
            problems.append(f"{name} stops at {found} m, expected {expected:g} m")
    return problems


def engines_land_alike(run: Studies) -> list[str]:
    """With equal settings, MuJoCo's cubes land as the engine's do at every sample."""
    far = {"baseline": float(apart(run, "baseline", "mujoco_baseline").max())}
    for name, case in l03.STEP_CASES.items():
        other = f"mujoco_dt{round(1000 * case.h)}_sub1"
        if other in run.traces:
            here = run.traces[name].link_pos
            there = run.traces[other].link_pos[: len(here)]
            far[name] = float(np.abs(here - there).max())
    return [f"{name} is up to {of:g} m apart" for name, of in far.items() if of > l03.ENGINES_APART]


def engines_hop_alike(run: Studies) -> list[str]:
    """With equal settings, MuJoCo's pyramid makes the same hop."""
    return [
        f"{name} rises by {run.slide(name).hop:g} m, in MuJoCo by "
        f"{run.slide(f'mujoco_{name}').hop:g} m"
        for name, _ in PUSHED_PAIRS
        if abs(run.slide(name).hop - run.slide(f"mujoco_{name}").hop) > l03.ENGINES_APART
    ]


def elliptic_cones_part(run: Studies) -> list[str]:
    """MuJoCo's elliptic cone lets the cubes hop, the engine's does not: one word, two models."""
    return [
        f"{name} rises by {run.slide(f'mujoco_{name}').hop:g} m in MuJoCo"
        for _, name in PUSHED_PAIRS
        if not run.slide(f"mujoco_{name}").hop > HOP
    ]


STUDIED = (
    time_constants,
    records_each_step,
    rebound_goes,
    depth_converges,
    default_cone_hops,
    stops_nearly_right,
    hop_is_paid_by_friction,
    elliptic_stays_down,
    elliptic_is_stepped_coulomb,
    engines_land_alike,
    engines_hop_alike,
    elliptic_cones_part,
)


def run_checks(run: Studies) -> tuple[Check, ...]:
    """Run the studies' checks."""
    return evaluate(STUDIED, run)


def step_rows(run: Studies) -> Sequence[dict[str, str]]:
    """Return one row a solver step, for a table on a page."""
    return [
        {
            "solver step h [ms]": f"{1000 * case.h:g}",
            "time constant of the contact [ms]": f"{1000 * run.time_constants[name]:g}",
            "penetration proxy [mm]": f"{1000 * run.landing(name).penetration:.3f}",
            "highest clearance afterwards [mm]": f"{1000 * run.landing(name).rebound:.3f}",
        }
        for name, case in l03.STEP_CASES.items()
    ]


def slide_rows(run: Studies, names: Sequence[str]) -> Sequence[dict[str, str]]:
    """Return one row a slide, with Coulomb's distance beside it."""
    rows = []
    for name in names:
        case, found = l03.STUDY_CASES[name], run.slide(name)
        friction = max(case.friction, case.surface_friction)
        stepped = sliding.stepped_distance(case.speed, friction, case.h, case.gravity)
        stop = found.stop_distance
        rows.append(
            {
                "run": name,
                "μ of the pair": f"{friction:g}",
                "stopping distance [m]": "not observed" if stop is None else f"{stop:.5f}",
                "v² / (2 μ g) − v h / 2 [m]": f"{stepped:.5f}",
                "highest clearance [mm]": f"{1000 * found.hop:.2f}",
                "largest angular speed [rad/s]": f"{found.spin:.2f}",
            }
        )
    return rows


def engine_rows(run: Studies) -> Sequence[dict[str, str]]:
    """Return one row a case that both engines ran: how far apart they are, and from when on."""
    rows = []
    pairs = {name: f"mujoco_{name}" for name in l03.REPEATED}
    pairs |= {name: f"mujoco_{name}" for _, name in PUSHED_PAIRS}
    pairs["baseline "] = l03.OWN_DEFAULTS
    for name, other in pairs.items():
        far = apart(run, name.strip(), other)
        over = np.flatnonzero(far > l03.ENGINES_APART)
        rows.append(
            {
                "Genesis": name.strip(),
                "MuJoCo": other,
                "farthest apart": f"{1e6 * far.max():.2g} µm" if far.max() < 1e-3
                else f"{1000 * far.max():.2f} mm",
                "more than 0.05 mm from": f"{run.traces[other].t[over[0]]:.2f} s"
                if len(over) else "never",
            }
        )  # fmt: skip
    return rows
