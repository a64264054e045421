"""Named checks of landings, slides and bounces: all pass, or the invariant that failed is named."""

from collections.abc import Iterator
from dataclasses import asdict

import numpy as np

from robo_genesis.core.checks import wrong_counts, wrong_masses, wrong_times
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l03 import friction, spec
from robo_genesis.lessons.l03.energy import kept_at_bounces
from robo_genesis.lessons.l03.metrics import (
    RESTING_BAND,
    BounceMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.sim import end_state
from robo_genesis.sim.contacts import SETTINGS, TOP

DEPTH_TOLERANCE = 1e-4
"""Tolerance of a reported depth against that of the positions [m]: corners differ a little."""

START_TOLERANCE = 2e-3
"""Tolerance of a settled cube's position against its start [m]: it sinks in."""


def landings(run: Experiment) -> dict[str, LandingMetrics]:
    """Return the metrics of the dropped cubes."""
    return {n: m for n, m in run.metrics.items() if isinstance(m, LandingMetrics)}


def slides(run: Experiment) -> dict[str, SlideMetrics]:
    """Return the metrics of the pushed cubes."""
    return {n: m for n, m in run.metrics.items() if isinstance(m, SlideMetrics)}


def bounces(run: Experiment) -> dict[str, BounceMetrics]:
    """Return the metrics of the balls."""
    return {n: m for n, m in run.metrics.items() if isinstance(m, BounceMetrics)}


def structure(run: Experiment) -> Iterator[str]:
    """The scene has two entities; the cube is one link, one geom, one joint, 6 DOFs and 7 qpos."""
    return wrong_counts(run.readings["model"], spec.EXPECTED_MODEL)


def mass(run: Experiment) -> Iterator[str]:
    """The engine's masses are density times volume."""
    expected = {case.shape: case.mass for case in run.cases.values()}
    return wrong_masses(run.readings["mass"], expected)


def settings(run: Experiment) -> Iterator[str]:
    """Frictions and substeps read back from the scenes are those of the cases."""
    for name in SETTINGS:
        for case, value in run.readings.get(name, {}).items():
            expected = getattr(run.cases[case], name)
            if not abs(value - expected) <= 1e-6:
                yield f"{case} has {name} {value:g}, expected {expected:g}"
    yield from (f"{name} was not read" for name in SETTINGS if not run.readings.get(name))


def stamps(run: Experiment) -> Iterator[str]:
    """The record of each case has one state at t = 0 and one after each outer step."""
    return wrong_times(run.cases, run.traces)


def start(run: Experiment) -> Iterator[str]:
    """Each run begins at the position of its case, a pushed cube with the speed of its case."""
    for name, case in run.cases.items():
        trace = run.traces[name]
        distance = np.abs(trace.link_pos[0, 0] - np.array(case.start)).max()
        if not distance <= (START_TOLERANCE if case.settle else spec.SAME_STATE):
            yield f"{name} starts {distance:g} m from {case.start}"
        if not abs(float(trace.link_vel[0, 0, 0]) - case.speed) <= 1e-6:
            yield f"{name} starts with {trace.link_vel[0, 0, 0]:g} m/s along x"


def one_factor(run: Experiment) -> Iterator[str]:
    """Compared cases differ in the declared factors and in nothing else."""
    allowed = {
        **{pair: {"substeps"} for pair in spec.FINER},
        spec.EQUAL_STEP: {"dt", "substeps"},
        ("low_on_050", "high_on_050"): {"friction", "start"},
        **{(f"{own}_on_050", f"{own}_on_030"): {"surface_friction"} for own in ("low", "high")},
    }
    finest = max(spec.BOUNCES, key=lambda name: spec.BOUNCES[name].substeps)
    allowed |= {(name, finest): {"substeps"} for name in spec.BOUNCES if name != finest}
    for (first, second), factors in allowed.items():
        a, b = (asdict(run.cases[name]) for name in (first, second))
        differ = {field for field in a if a[field] != b[field]}
        if differ != factors:
            yield f"{first} and {second} differ in {sorted(differ)}"


def lands(run: Experiment) -> Iterator[str]:
    """Each dropped cube touches the surface, and its centre stays above the upper face."""
    for name, found in landings(run).items():
        lowest = float(run.traces[name].link_pos[:, 0, 2].min())
        if found.touchdown is None or not (run.traces[name].contacts > 0).any():
            yield f"{name} never touches the surface"
        if lowest <= TOP:
            yield f"{name} falls to {lowest:g} m, the surface is at {TOP:g} m"


def reported_late(run: Experiment) -> Iterator[str]:
    """With one substep, a reported depth belongs to the state before: it is one step old."""
    for name in landings(run):
        case, trace = run.cases[name], run.traces[name]
        below = case.rest_height - trace.link_pos[:-1, 0, 2].astype(np.float64)
        error = np.abs(trace.penetration[1:, 0] - np.maximum(below, 0)).max()
        if case.substeps == 1 and not error <= DEPTH_TOLERANCE:
            yield f"{name}: reported and earlier depth differ by up to {error:g} m"


def equal_step_equal_states(run: Experiment) -> Iterator[str]:
    """Runs with equal solver steps and different outer steps share states at shared times."""
    short, long = (run.traces[name] for name in spec.EQUAL_STEP)
    every = round(long.dt / short.dt)
    for name in ("link_pos", "link_quat", "link_vel", "link_ang"):
        error = np.abs(getattr(short, name)[::every] - getattr(long, name)).max()
        if not error <= spec.SAME_STATE:
            yield f"{name} differs by up to {error:g}"


def settles(run: Experiment) -> Iterator[str]:
    """Each dropped cube settles at its resting height within the window."""
    for name, found in landings(run).items():
        if found.resting_time is None:
            off = f"{name} ends {found.resting_offset:g} m off its resting height"
            yield f"{off}, allowed are {RESTING_BAND:g} m"


def stops(run: Experiment) -> Iterator[str]:
    """Each pushed cube stops within the window by the declared rule."""
    for name, found in slides(run).items():
        if found.stop_distance is None:
            yield f"{name} does not stop in {run.traces[name].t[-1]:g} s"


def friction_orders(run: Experiment) -> Iterator[str]:
    """With less friction a cube travels farther; the smaller coefficient changes nothing."""
    far = {name: found.stop_distance or np.nan for name, found in slides(run).items()}
    for near, farther in (("high_on_050", "low_on_050"), ("low_on_050", "low_on_030")):
        if not far[farther] > far[near]:
            yield f"{farther} stops at {far[farther]:g} m, {near} at {far[near]:g} m"
    difference = abs(far["high_on_030"] - far["high_on_050"])
    if not difference <= spec.SAME_SLIDE:
        yield f"high_on_030 and high_on_050 stop {difference:g} m apart"


def near_coulomb(run: Experiment) -> Iterator[str]:
    """Each stopping distance is near v² / (2 μ g) with the larger coefficient, despite the hops."""
    for name, found in slides(run).items():
        case = run.cases[name]
        mu = friction.pair_friction(case)
        expected = friction.coulomb_distance(case.speed, mu, case.gravity)
        measured = found.stop_distance
        if measured is None or not abs(measured - expected) <= spec.COULOMB_SHARE * expected:
            yield f"{name} stops at {measured} m, expected {expected:g} m"


def level_in_flight(run: Experiment) -> Iterator[str]:
    """In the air, the energy that semi-implicit Euler conserves is constant to within float32."""
    for name, found in bounces(run).items():
        drift, start_energy = found.flight_drift, found.start_energy
        if drift is None or not drift <= spec.LEVEL_SHARE * start_energy:
            yield f"{name}: it changes by {drift} J of {start_energy:g} J"


def energy_converges(run: Experiment) -> Iterator[str]:
    """The finest step keeps at the bounce the energy of a linear spring; a coarse one does not."""
    by_step = sorted(bounces(run), key=lambda name: run.cases[name].h)
    kept = {name: bounces(run)[name].first_kept for name in by_step}
    missing = [f"{name} does not bounce" for name, share in kept.items() if share is None]
    if missing or not by_step:
        yield from missing or ["no ball bounces"]
        return
    spring = run.cases[by_step[0]].spring or (np.nan, np.nan)
    errors = [abs(float(share or 0) - 100 * kept_at_bounces(spring[1])) for share in kept.values()]
    if not (errors[0] <= spec.FINE_SHARE and max(errors) > 5 * spec.FINE_SHARE):
        yield f"the finest step is {errors[0]:.2f} % off, the worst {max(errors):.2f} %"


def posture(run: Experiment) -> list[str]:
    """The evidence of the first and the last state is complete and shows the cube in two places."""
    return end_state.problems(run.rendered, run.frames, run.traces["baseline"].link_pos)


CHECKS = (
    structure, mass, settings, stamps, start, one_factor, lands, reported_late,
    equal_step_equal_states, settles, stops, friction_orders, near_coulomb, level_in_flight,
    energy_converges, posture,
)  # fmt: skip

STUDY_CHECKS = (structure, mass, settings, stamps, start, posture)
"""The checks that the runs of the lecture must also pass."""
