"""Studies of the lecture and the deeper pages: theory, named checks, tables, sentences, figures."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import slide_on_corners
from lessons.l03.conftest import SECONDS
from lessons.l03.test_contacts import changed, failing, shift, with_reading, with_trace

from robo_genesis.lessons.l03 import (
    friction,
    spec,
    study,
    study_contact,
    study_plots,
    study_spec,
    study_tables,
    study_text,
    theory,
)  # fmt: skip
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

PAGES = ("lecture", "contact", "energy", "mistakes")


# Theory


def critically_damped(v, seconds, n=200_000):
    """Return depth and velocity of ẍ = −2 ẋ / T − x / T² by small steps, until it would pull."""
    h = 4 * seconds / n
    x, depths, speeds = 0.0, [], []
    for _ in range(n):
        push = 2 * v / seconds + x / seconds**2
        if push < 0:
            break
        v -= h * push
        x += h * v
        depths.append(x)
        speeds.append(v)
    return np.array(depths), np.array(speeds)


def test_depth_and_release_are_those_of_the_equation():
    case = study_spec.RELEASE_CASES["release_5ms"]["release_5ms_10000"]
    depths, speeds = critically_damped(theory.impact_speed(case), 0.005)
    assert depths.max() == pytest.approx(theory.depth(case), rel=1e-3)
    assert -speeds[-1] == pytest.approx(theory.release_speed(case), rel=1e-3)
    rise = speeds[-1] ** 2 / (2 * case.gravity) - depths[-1]
    assert rise == pytest.approx(theory.rebound(case), rel=1e-2)


def test_numbers_by_hand():
    case = spec.BASELINE
    assert theory.impact_speed(case) == pytest.approx(np.sqrt(2 * 9.81 * 0.235))
    assert theory.contact_seconds(case) == 0.01
    assert theory.contact_seconds(spec.LANDINGS["dt20_sub1"]) == 0.04
    assert theory.contact_seconds(replace(case, time_constant=0.002)) == 0.01  # two solver steps
    assert theory.rebound(case) == 0
    slow = replace(spec.PUSHED, speed=1.0)  # 2 · 0.5 · 0.5 / 1.25 m/s
    assert theory.upward_blow(slow) == pytest.approx(0.4)
    assert theory.hop(slow) == pytest.approx(0.16 / 19.62)


def test_the_hop_does_not_depend_on_a_step_beyond_half_the_default_time_constant():
    hops = [theory.hop(replace(spec.PUSHED, substeps=n)) for n in (1, 2, 4)]
    assert hops[0] == hops[1] == pytest.approx(4 * hops[2])


def test_the_shortest_time_constant_is_two_steps():
    assert mujoco_contacts.time_constant(0.02) == 0.04
    assert mujoco_contacts.time_constant(0.001) == 0.01
    assert mujoco_contacts.time_constant(0.0001, 0.002) == 0.002
    assert mujoco_contacts.time_constant(0.005, 0.002) == 0.01
    assert mujoco_contacts.load(spec.LANDINGS["dt20_sub1"]).geom_solref[0].tolist() == [0.04, 1]
    stiff = next(iter(study_spec.STIFF_CASES[study_spec.STIFF].values()))
    assert mujoco_contacts.load(stiff).geom_solref[0].tolist() == [0.002, 1]
    own = mujoco_contacts.load(spec.BASELINE, own_defaults=True)
    assert own.geom_solref[0].tolist() == [0.02, 1]


# Checks


@pytest.mark.parametrize("page", PAGES)
def test_a_sound_study_passes_every_check(experiments, page):
    assert failing(experiments[page]) == []


def with_time_constant(value):
    return with_reading(study.GROUP, {n: SECONDS[n] for n in LECTURE_SCENES} | {"h_20000us": value})


LECTURE_SCENES = [*study_spec.STEP_CASES, *study_spec.STIFF_CASES]


def rebounding(run):
    name = "h_500us_10000"
    up = spec.BASELINE.rest_height + 0.002 - run.traces[name].link_pos[-20, 0, 2]
    return shift(name, up, first=-20, end=-19)(run)


def deeper(run):
    name = "h_125us_10000"
    deepest = int(run.traces[name].link_pos[:, 0, 2].argmin())
    return shift(name, -0.003, first=deepest, end=deepest + 1)(run)


def one_corner_less(contacts):
    contacts[5] -= 1
    return contacts


def as_other(name, other):
    return lambda run: with_trace(run, name, run.traces[other])


def as_slide(name, case, **changes):
    return lambda run: with_trace(run, name, slide_on_corners(replace(case, **changes)))


def staying_down(position):
    landed = np.maximum.accumulate(position[:, 0, 2] < spec.BASELINE.rest_height)
    position[landed, 0, 2] = np.minimum(position[landed, 0, 2], spec.BASELINE.rest_height)
    return position


def never_rebounding(run):
    for name in study_spec.STEP_CASES["h_5000us"]:
        run = changed(name, "link_pos", staying_down)(run)
    return run


def lifted(name, by):
    """Return a function that adds to the height of a whole run after its first state."""
    return shift(name, by, first=1)


FAILING = {
    "another time constant": ("lecture", with_time_constant(0.01), {"time_constants"}),
    "a time constant that is no number": (
        "lecture", with_time_constant(np.nan), {"time_constants"}),
    "a record of each step that moves otherwise": (
        "lecture", shift(study_spec.AS_BASELINE, 1e-5, first=20, end=40), {"records_each_step"}),
    "a rebound that stays with smaller steps": ("lecture", rebounding, {"rebound_goes"}),
    "a depth that depends on the start at fine steps": (
        "lecture", deeper, {"scatter_shrinks", "depth_by_hand"}),
    "a clean slide that hops": (
        "lecture", shift("low_on_030_elliptic", 0.001, first=10, end=12),
        {"clean_slides_stay_down"}),
    "a clean slide on three corners": (
        "lecture", changed("low_on_030_elliptic", "contacts", one_corner_less),
        {"clean_slides_stay_down"}),
    "a clean slide that stops elsewhere": (
        "lecture", shift("low_on_050_elliptic", 0.001, axis=0, first=10),
        {"clean_slides_are_coulomb_s"}),
    "no rebound at all": ("lecture", never_rebounding, {"records_each_step", "rebound_goes"}),
    "another rule of friction": (
        "lecture",
        as_slide("low_on_050_elliptic", spec.PUSHED, friction=0.3, surface_friction=0.3,
                 cone="elliptic"),
        {"clean_slides_are_coulomb_s", "larger_friction_rules"}),
    "a hop that a finer step does not reduce": (
        "lecture", lifted("hop_2500us_low", 0.02), {"hop_follows_step"}),
    "a hop that stays at the finest step": (
        "lecture", lifted("hop_100us_high", 0.02), {"hop_follows_step"}),
    "a slow push that hops": (
        "lecture", lifted("hop_200mm_s", 0.002), {"hop_follows_speed"}),
    "pushed cubes that stay down": (
        "contact", as_slide("high_on_050", spec.BESIDE),
        {"default_cone_hops", "hop_is_paid_by_friction", "half_the_step_contradicts",
         "engines_hop_alike"}),
    "a blow that friction does not explain": (
        "contact", shift("low_on_050", -0.1, "link_vel", 0, first=1, end=2),
        {"hop_is_paid_by_friction"}),
    "a stop far from Coulomb's": (
        "contact", shift("low_on_050", 0.05, axis=0, first=10), {"stops_nearly_right"}),
    "a round cone that stays down": (
        "contact", as_other("low_on_050_convex", "low_on_050_elliptic"),
        {"the_cone_alone_hops", "engines_hop_alike"}),
    "engines that land apart": (
        "contact", as_other("mujoco_baseline", study_spec.OWN_DEFAULTS), {"engines_land_alike"}),
    "engines that hop apart, from another lane": (
        "contact", as_other("mujoco_low_on_050", "high_on_050"), {"start", "engines_hop_alike"}),
    "a release that is too fast": (
        "energy", shift("release_5ms_10000", 0.2, "link_vel", 2, first=220), {"release_speed"}),
    "a soft contact that rebounds": (
        "energy", shift("release_10ms_10000", 0.01, first=270), {"stiff_contacts_rebound"}),
}  # fmt: skip


@pytest.mark.parametrize("name", FAILING)
def test_a_wrong_study_fails_its_checks(experiments, name):
    page, spoil, names = FAILING[name]
    assert set(failing(spoil(experiments[page]))) == names


def test_a_stop_that_half_the_step_repeats_fails_the_claim_that_it_changes(experiments):
    run = experiments["contact"]
    for name in ("high_on_050", study_spec.HALF_THE_STEP):
        run = with_trace(run, name, slide_on_corners(run.cases[name]))
    assert "half_the_step_contradicts" in failing(run)


def test_the_verdict_on_convergence_follows_the_finest_steps(experiments):
    run = experiments["contact"]
    assert "does not converge" in study_text.stop_conclusions(run)
    for step in study_spec.STOP_CASES:
        name = f"{step}_high"
        run = with_trace(run, name, slide_on_corners(run.cases[name]))
    said = study_text.stop_conclusions(run)
    assert "does not converge" not in said
    assert "Two steps alone" not in said


# Tables, sentences and figures


def test_rows_of_a_study_describe_the_runs_in_both_engines(experiments):
    run = experiments["contact"]
    rows = study_tables.engine_rows(run.traces, run.metrics)
    runs = [row["run"] for row in rows]
    assert len(set(runs)) == len(study_spec.ENGINE_PAIRS) + 1
    assert runs[0] == "landing, h = 5 ms"
    assert "push, pyramidal, μ = 0.8" in runs
    assert runs[-1] == "landing, h = 5 ms, MuJoCo's own contact"
    assert (rows[0]["over 0.05 mm from"], rows[0]["contacts there"]) == ("never", "– and –")
    assert rows[-1]["over 0.05 mm from"] != "never"
    with pytest.raises(KeyError, match="baseline is not a slide"):
        study.slide(run.metrics, "baseline")


def test_a_distance_between_runs_takes_shared_times_and_no_lanes(experiments):
    traces = experiments["contact"].traces
    fine = study_contact.distance_between(traces, "dt10_sub1", "mujoco_dt20_sub1")
    assert len(fine) == 76  # every second state of the finer one
    assert fine[0] == 0


def test_the_step_decides_the_table_of_depths(experiments):
    table = study_tables.steps(experiments["lecture"])
    assert len(table.strip().splitlines()) == 2 + len(study_spec.STEP_CASES)
    assert "| 20\u00a0ms | 40\u00a0ms | 0.5 |" in table
    assert "| 0.125\u00a0ms | 10\u00a0ms | 0.0125 |" in table


def test_slides_on_corners_have_the_distances_of_the_formula(experiments):
    table = study_tables.clean_slides(experiments["lecture"])
    distance = friction.stepped_distance(2.0, 0.3, 0.005)
    assert f"| {distance:.4f}\u00a0m |" in table
    rows = study_tables.before_after(experiments["lecture"]).splitlines()
    high = next(row for row in rows if row.startswith("| 0.8"))
    assert len({cell.strip() for cell in high.split("|")[2:4]}) == 1  # both tables


def test_a_study_without_a_rebound_says_so(experiments):
    run = never_rebounding(experiments["lecture"])
    down = {
        name: replace(found, rebound=0.0)
        for name, found in run.metrics.items()
        if name in study_spec.flat(study_spec.STEP_CASES)
    }
    quiet = replace(run, accepted=dict(run.metrics) | down)
    assert "No cube rebounds at any of these steps." in study_text.step_conclusions(quiet)
    finest = replace(down["h_125us_10000"], rebound=0.01)
    loud = replace(run, accepted=dict(quiet.metrics) | {"h_125us_10000": finest})
    assert "the smallest step included" in study_text.step_conclusions(loud)


def test_a_stop_that_was_not_observed_is_said(experiments):
    run = experiments["contact"]
    gone = {
        f"{step}_high": replace(run.metrics[f"{step}_high"], stop_distance=None, stop_time=None)
        for step in study_spec.STOP_CASES
    }
    without = replace(run, accepted=dict(run.metrics) | gone)
    assert "too few runs stop" in study_text.stop_conclusions(without)
    assert "not observed" in study_tables.stops_by_step(without)


SHOWN = {
    "lecture": (
        study_tables.steps, study_tables.depths, study_tables.before_after,
        study_tables.hops_by_step, study_tables.hops_by_speed, study_text.step_conclusions,
        study_text.depth_conclusion, study_text.friction_conclusion, study_text.hop_conclusions,
    ),
    "contact": (
        study_tables.settings_of_cones, study_tables.first_impulses, study_tables.stops_by_step,
        study_tables.engines, study_text.stop_conclusions,
    ),
    "energy": (
        study_tables.releases, study_tables.kept_by_step, study_text.release_conclusions,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("page", "function"), [(p, f) for p, of in SHOWN.items() for f in of])
def test_what_is_shown_has_no_raw_numbers(experiments, page, function):
    text = function(experiments[page])
    assert text
    assert "nan" not in text
    assert "e-0" not in text


def test_figures_have_labelled_axes(experiments):
    for page, names in (
        ("lecture", ("landings_by_step", "depths_by_step", "hops")),
        ("contact", ("cones", "stops")),
        ("energy", ("releases",)),
    ):
        for name in names:
            axes = getattr(study_plots, name)(experiments[page]).axes
            assert any(ax.get_xlabel() for ax in axes), name
            assert any(ax.get_ylabel() for ax in axes), name


# The second engine


def test_mujoco_turns_in_the_world_s_axes(contact_traces):
    trace = contact_traces["mujoco_high_on_050"]
    k = int(np.abs(trace.link_ang[:, 0, 1]).argmax())
    w, x, y, z = trace.link_quat[k - 1 : k + 2, 0].T.astype(float)
    pitch = np.unwrap(2 * np.arctan2(y, w))
    rate = (pitch[2] - pitch[0]) / (2 * trace.dt)
    assert np.abs([x, z]).max() < 1e-3  # it turns about y alone
    assert trace.link_ang[k, 0, 1] == pytest.approx(rate, rel=0.3)
