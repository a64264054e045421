"""Bodies that land, slide and bounce: known answers, metrics, named checks, sentences, studies."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis import (
    contact_checks,
    contact_metrics,
    contact_plots,
    contact_said,
    contact_studies,
    contacts,
    energy,
    l03,
    second_contacts,
    sliding,
    tables,
)
from robo_genesis.checks import require
from robo_genesis.contact_metrics import SOURCES, UNITS, measure, metric_records, stopped_at
from robo_genesis.contacts import TOP, ContactCase, ContactError
from robo_genesis.evidence.traces import CONTACT_FIELDS
from robo_genesis.trace import ContactTrace, TraceError

MASSES = {"cube": l03.BASELINE.mass, "ball": l03.DROPPED_BALL.mass}
SECONDS = {n: second_contacts.time_constant(c.h) for n, c in l03.STEP_CASES.items()}


def body_at(z, *, quat=(1, 0, 0, 0), vz=0.0, dt=0.01, contacts=0):
    """Return a run of a body at rest in x and y, from its heights."""
    z = np.asarray(z, dtype=np.float32)
    position, velocity = (np.zeros((len(z), 1, 3), np.float32) for _ in range(2))
    position[:, 0, 2], velocity[:, 0, 2] = z, vz
    return ContactTrace(
        np.arange(len(z)) * dt,
        position,
        np.tile(np.float32(quat), (len(z), 1, 1)),
        velocity,
        np.zeros_like(position),
        np.broadcast_to(np.asarray(contacts, np.int32), len(z))[:, None],
        np.zeros((len(z), 1), np.float32),
    )


# Coulomb's friction


def test_coulomb_s_distance_and_time_by_hand():
    # 2 m/s, μ = 0.5, g = 10: 4 / 10 m and 2 / 5 s
    assert sliding.coulomb_distance(2, 0.5, gravity=10) == pytest.approx(0.4)
    assert sliding.coulomb_time(2, 0.5, gravity=10) == pytest.approx(0.4)
    assert sliding.apparent_friction(2, 0.4, gravity=10) == pytest.approx(0.5)


@pytest.mark.parametrize("n", [4, 40, 400])
def test_the_stepped_distance_is_what_a_loop_adds_up_to(n):
    friction, gravity, speed = 0.5, 10.0, 2.0
    h = speed / (friction * gravity) / n  # stops after n steps exactly
    v, x = speed, 0.0
    for _ in range(n):
        v = v - friction * gravity * h
        x = x + v * h
    assert x == pytest.approx(sliding.stepped_distance(speed, friction, h, gravity), rel=1e-12)


@pytest.mark.parametrize(
    ("found", "rule"),
    [(0.5, "the larger"), (0.1, "the smaller"), (0.31, "the mean"), (0.22, "the geometric mean")],
)
def test_the_nearest_rule_is_named(found, rule):
    assert sliding.nearest_rule(found, 0.1, 0.5) == rule


# Cases


def test_a_case_knows_its_step_mass_and_place():
    cube, ball = l03.BASELINE, l03.DROPPED_BALL
    assert (cube.h, cube.steps, cube.rest_height) == pytest.approx((0.005, 150, 0.765))
    assert cube.mass == pytest.approx(0.256)
    assert cube.inertia == pytest.approx(0.256 * 0.08**2 / 6)
    assert ball.mass == pytest.approx(500 * 4 / 3 * np.pi * 0.04**3)
    assert ball.inertia == pytest.approx(0.4 * ball.mass * 0.04**2)
    kinds = {name: case.kind for name, case in l03.CASES.items()}
    assert kinds["baseline"] == contacts.LANDING
    assert kinds["low_on_030"] == contacts.SLIDE
    assert kinds["bounce_sub2"] == contacts.BOUNCE


def test_a_time_that_is_no_whole_number_of_steps_is_refused():
    with pytest.raises(ContactError, match=r"duration is 1\.5 s, no whole number .* 0\.4 s"):
        replace(l03.BASELINE, dt=0.4)
    with pytest.raises(ContactError, match=r"settle is 0\.005 s"):
        replace(l03.BASELINE, settle=0.005)
    with pytest.raises(ContactError, match=r"'cone' was given, valid is 'cube' or 'ball'"):
        replace(l03.BASELINE, shape="cone")


def test_cases_of_one_scene_share_what_a_scene_has_once():
    assert contacts.shared_case({"a": l03.PUSHED, "b": l03.BESIDE}) is l03.PUSHED
    with pytest.raises(ContactError, match=r"b asks for surface_friction=0\.3, .* 0\.5"):
        contacts.shared_case({"a": l03.PUSHED, "b": l03.SLIDES["low_on_030"]})
    with pytest.raises(ContactError, match="at least one"):
        contacts.shared_case({})


def test_parameters_of_the_public_course_are_kept():
    landings = {(c.dt, c.substeps) for c in l03.LANDINGS.values()}
    assert landings == {(0.01, 1), (0.01, 2), (0.02, 1), (0.02, 2)}
    assert {c.duration for c in l03.LANDINGS.values()} == {1.5}
    pairs = {(c.friction, c.surface_friction) for c in l03.SLIDES.values()}
    assert pairs == {(0.1, 0.5), (0.8, 0.5), (0.1, 0.3), (0.8, 0.3)}
    assert {(c.speed, c.settle, c.duration) for c in l03.SLIDES.values()} == {(2.0, 0.3, 2.0)}
    assert (TOP, l03.BASELINE.start[2], l03.BASELINE.size) == (0.725, 1.0, 0.08)


# Energy and clearance


def thrown(speed, h, n):
    """Return a cube that is thrown upwards, stepped by hand as semi-implicit Euler does."""
    case = replace(l03.BASELINE, dt=h, substeps=1, duration=n * h)
    z, v, heights, speeds = 2.0, speed, [2.0], [speed]
    for _ in range(n):
        v = v - case.gravity * h
        z = z + v * h
        heights.append(z)
        speeds.append(v)
    return body_at(heights, vz=np.array(speeds), dt=h), case


def test_the_kept_energy_of_a_thrown_body_stays_and_the_total_one_does_not():
    trace, case = thrown(3.0, 0.01, 60)
    kept, total = energy.kept_energy(trace, case), energy.total_energy(trace, case)
    assert np.ptp(kept) < 1e-6 * kept[0]
    lent = case.mass * case.gravity * case.h * np.ptp(trace.link_vel[:, 0, 2]) / 2
    assert np.ptp(total) == pytest.approx(lent, rel=1e-4)


def test_turning_counts_as_energy():
    case = l03.BASELINE
    trace = body_at([case.rest_height] * 3)
    turning = np.zeros((3, 1, 3), np.float32)
    turning[:, 0, 1] = 10
    spinning = replace(trace, link_ang=turning)
    assert energy.total_energy(spinning, case) == pytest.approx(
        [case.inertia * 100 / 2] * 3, rel=1e-5
    )


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0)])
def test_a_cube_on_its_edge_reaches_lower(axis):
    half = np.pi / 8
    quat = (np.cos(half), *(np.sin(half) * np.array(axis)))  # 45° about a level axis
    trace = body_at([1.0, 1.0], quat=quat)
    expected = 1.0 - 0.04 * np.sqrt(2) - TOP
    assert energy.clearance(trace, l03.BASELINE) == pytest.approx([expected] * 2, abs=1e-6)
    ball = energy.clearance(trace, l03.DROPPED_BALL)
    assert ball == pytest.approx([1.0 - 0.04 - TOP] * 2, abs=1e-6)


def test_turning_about_the_vertical_changes_no_clearance():
    quat = (np.cos(0.3), 0, 0, np.sin(0.3))
    assert energy.clearance(body_at([1.0, 1.0], quat=quat), l03.BASELINE)[0] == pytest.approx(
        0.235, abs=1e-6
    )


def test_flights_are_the_stretches_in_the_air():
    up, down = l03.DROPPED_BALL.rest_height + 0.01, l03.DROPPED_BALL.rest_height - 0.001
    trace = body_at([up] * 4 + [down] * 2 + [up] * 2 + [down] + [up] * 3)
    found = list(energy.flights(trace, l03.DROPPED_BALL))
    assert found == [slice(0, 4), slice(9, 12)]  # two states are too few


def test_a_spring_without_damping_keeps_everything():
    assert energy.kept_at_bounces(0.0) == 1
    assert energy.kept_at_bounces(0.01) == pytest.approx(np.exp(-2 * np.pi * 0.01), rel=1e-4)


# Metrics


def test_metrics_of_a_landing_by_hand():
    rest = l03.BASELINE.rest_height
    z = rest + np.array([0.02, 0.01, -0.008, -0.001, 0.003, 0.002, -0.0001, 0, 0, 0])
    trace = body_at(z, contacts=[0, 0, 0, 4, 0, 0, 4, 4, 4, 4], vz=[0, -1, 0.5, 0.2] + [0] * 6)
    found = contact_metrics.landing_metrics(trace, l03.BASELINE)
    assert found.touchdown == pytest.approx(0.02)
    assert found.penetration == pytest.approx(0.008, abs=1e-6)
    assert found.rebound == pytest.approx(0.003, abs=1e-6)
    assert found.separated == pytest.approx(0.02)  # two samples without contact and clear
    assert found.upward_speed == pytest.approx(0.5)
    assert found.resting_time == pytest.approx(0.06)
    assert found.resting_offset == pytest.approx(0, abs=1e-6)


def test_a_cube_that_never_lands_has_no_touchdown():
    found = contact_metrics.landing_metrics(body_at([1.0] * 5), l03.BASELINE)
    assert (found.touchdown, found.resting_time) == (None, None)
    assert (found.penetration, found.rebound, found.separated) == (0, 0, 0)


def test_a_stop_takes_a_hold():
    speed = np.array([1, 0.005, 0.5] + [0.005] * 11 + [0.0])
    assert stopped_at(speed, 0.01) == 3  # not the one slow sample before
    assert stopped_at(speed[:13], 0.01) is None  # the window ends before the hold does
    assert stopped_at(np.full(40, 0.01), 0.01) is None  # slower, not as slow


def test_metrics_of_a_slide_on_corners(slide_on_corners):
    case = l03.CONE_CASES["low_elliptic"]
    found = contact_metrics.slide_metrics(slide_on_corners(case), case)
    expected = sliding.stepped_distance(2.0, 0.5, case.h)
    assert found.stop_distance == pytest.approx(expected, abs=1e-4)
    assert (found.hop, found.airborne, found.spin) == (0, 0, 0)
    assert found.first_speed == pytest.approx(2 - 0.5 * 9.81 * 0.01, rel=1e-6)


def test_the_kept_share_is_that_of_the_flights(contact_traces):
    case = l03.BOUNCES["bounce_sub20"]
    found = contact_metrics.bounce_metrics(contact_traces["bounce_sub20"], case)
    assert found.start_energy == pytest.approx(case.mass * 9.81 * 0.1, rel=1e-4)
    assert found.first_kept == pytest.approx(100 * energy.kept_at_bounces(0.01), abs=1)
    assert found.later_kept < found.first_kept
    none = contact_metrics.bounce_metrics(body_at([1.0] * 5), case)
    assert (none.first_kept, none.later_kept) == (None, None)


def test_each_metric_has_unit_source_tolerance_and_form(contact_traces):
    metrics = measure(contact_traces, l03.CASES)
    found = metric_records(metrics, l03.EXPECTED_MODEL, MASSES)
    names = {name for of in metrics.values() for name, _, _ in of.items()}
    assert names == UNITS.keys() == SOURCES.keys() == contact_metrics.LABELS.keys()
    assert set(UNITS.values()) <= l03.TOLERANCES.keys() & l03.RESOLUTION.keys()
    known = {name for name, *_ in CONTACT_FIELDS.values()}
    assert {source for of in SOURCES.values() for source in of} <= known
    assert found["mass"]["ball"]["unit"] == "kg"
    assert found["baseline"]["penetration"]["from"] == ["link_pos_m", "link_quat_wxyz"]
    assert {name: tuple(of) for name, of in found.items() if name in l03.CASES} == l03.METRICS


def test_contacts_of_another_length_form_no_run():
    trace = body_at([1.0] * 4)
    with pytest.raises(TraceError, match=r"contacts has shape \(3, 1\), expected \(4, 1\)"):
        replace(trace, contacts=trace.contacts[:3])


# Checks


@pytest.fixture(scope="module")
def experiment(contact_traces, frames) -> contact_checks.ContactExperiment:
    traces = {name: contact_traces[name] for name in l03.CASES}
    return contact_checks.ContactExperiment(
        l03.EXPECTED_MODEL, MASSES, l03.CASES, traces, measure(traces, l03.CASES), "camera", frames
    )


def failing(run) -> list[str]:
    return [check.name for check in contact_checks.run_checks(run) if not check.passed]


def with_trace(run, name, trace):
    """Return the experiment with another run of a case, and metrics of it."""
    traces = run.traces | {name: trace}
    return replace(run, traces=traces, metrics=measure(traces, run.cases))


def moved(run, name, by, field="link_pos", axis=2, start=0):
    """Return the experiment with an array of one case changed along an axis."""
    array = np.array(getattr(run.traces[name], field))
    array[start:, 0, axis] += by
    return with_trace(run, name, replace(run.traces[name], **{field: array}))


def test_a_sound_experiment_passes_every_check(experiment):
    assert failing(experiment) == []
    assert require("l03", contact_checks.run_checks(experiment)) == "L03 CHECK: PASSED"


def test_one_more_link_or_a_wrong_mass_is_named(experiment):
    assert failing(replace(experiment, model=l03.EXPECTED_MODEL | {"links": 2})) == ["structure"]
    assert failing(replace(experiment, masses=MASSES | {"ball": 0.14})) == ["mass"]


def test_a_missing_step_is_named(experiment):
    trace = experiment.traces["bounce_sub1"]
    cut = {f: getattr(trace, f)[:-1] for f in trace.__dataclass_fields__}
    assert "stamps" in failing(with_trace(experiment, "bounce_sub1", ContactTrace(**cut)))


def test_a_start_elsewhere_or_at_another_speed_is_named(experiment):
    assert "start" in failing(moved(experiment, "high_on_030", 0.01, axis=1))
    slower = moved(experiment, "low_on_030", -0.1, field="link_vel", axis=0)
    assert "start" in failing(slower)


def test_a_second_factor_is_named(experiment):
    heavier = replace(l03.LANDINGS["dt10_sub1"], density=600.0)
    assert failing(replace(experiment, cases=l03.CASES | {"dt10_sub1": heavier})) == ["one_factor"]


def test_a_cube_that_hovers_or_falls_through_is_named(experiment):
    trace = experiment.traces["baseline"]
    hovering = replace(trace, contacts=np.zeros_like(trace.contacts))
    assert "lands" in failing(with_trace(experiment, "baseline", hovering))
    assert "lands" in failing(moved(experiment, "baseline", -0.05, start=30))


def test_depths_of_the_same_state_are_named(experiment):
    trace = experiment.traces["dt10_sub1"]
    early = np.roll(trace.penetration, -1, axis=0)
    found = failing(with_trace(experiment, "dt10_sub1", replace(trace, penetration=early)))
    assert found == ["reported_late"]


def test_a_finer_step_that_sinks_deeper_is_named(experiment):
    z = np.array(experiment.traces["baseline"].link_pos)
    z[z[:, 0, 2] < l03.BASELINE.rest_height - 0.005, 0, 2] -= 0.01
    trace = replace(experiment.traces["baseline"], link_pos=z)
    assert failing(with_trace(experiment, "baseline", trace)) == ["finer_sinks_less"]


def test_other_states_at_shared_times_are_named(experiment):
    found = failing(moved(experiment, "dt20_sub2", 1e-5, axis=0, start=5))
    assert found == ["equal_step_equal_states"]


def test_a_cube_that_does_not_settle_is_named(experiment):
    assert "settles" in failing(moved(experiment, "baseline", 0.001, start=120))


def test_a_cube_that_does_not_stop_is_named(experiment):
    found = failing(moved(experiment, "low_on_030", 0.5, field="link_vel", axis=0, start=60))
    assert found == ["stops", "friction_orders", "larger_friction_rules", "near_coulomb"]


def test_a_surface_that_changes_the_other_cube_is_named(experiment):
    assert failing(moved(experiment, "high_on_030", 0.01, axis=0, start=20)) == ["friction_orders"]


def test_a_slide_of_another_rule_is_named(experiment, slide_on_corners):
    smaller = replace(l03.PUSHED, surface_friction=0.25, friction=0.25)
    found = failing(with_trace(experiment, "low_on_050", slide_on_corners(smaller)))
    assert {"larger_friction_rules", "near_coulomb"} <= {*found}


def test_energy_that_leaks_in_flight_is_named(experiment):
    found = failing(moved(experiment, "bounce_sub20", 0.002, start=10))
    assert "level_in_flight" in found


def test_energy_that_does_not_converge_is_named(experiment):
    name = "bounce_sub20"
    for share in (90.0, None):
        other = {name: replace(experiment.bounces()[name], first_kept=share)}
        spoilt = replace(experiment, metrics=experiment.metrics | other)
        assert failing(spoilt) == ["energy_converges"]
    still = body_at([l03.DROPPED_BALL.rest_height + 0.1] * 201)
    assert "energy_converges" in failing(with_trace(experiment, name, still))


def test_one_picture_twice_is_named(experiment, frames):
    same = {"initial": frames["initial"], "final": frames["initial"]}
    assert failing(replace(experiment, frames=same)) == ["posture"]


# Sentences, tables and figures


def test_sentences_tell_what_is_there(experiment):
    text = "\n".join(block.markdown() for block in contact_said.interpretation(experiment))
    assert "Only `baseline` leaves the surface again" in text
    assert "`low_on_050`: 0.1 on 0.5 stops as a cube with" in text
    assert "For the cube with high friction, the other surface changes nothing" in text
    assert "has 101.7 % of its energy after the first bounce, more than before" in text


def test_sentences_of_what_did_not_happen(experiment, slide_on_corners):
    flat = contact_said.slide_sentence(
        "low",
        contact_metrics.slide_metrics(slide_on_corners(l03.PUSHED), l03.PUSHED),
        l03.PUSHED,
    )
    assert "It stayed on the surface." in flat
    going = contact_metrics.slide_metrics(body_at([0.765] * 30, vz=0), l03.PUSHED)
    never = replace(going, stop_distance=None, stop_time=None)
    assert "did not stop within the window" in contact_said.slide_sentence("x", never, l03.PUSHED)
    high = contact_metrics.landing_metrics(body_at([1.0] * 5), l03.BASELINE)
    assert "did not reach the surface" in contact_said.landing_sentence("x", high)
    lost = replace(experiment.bounces()["bounce_sub1"], first_kept=None)
    assert "does not bounce" in contact_said.bounce_sentence(lost, l03.BOUNCES["bounce_sub1"])


def test_a_study_without_a_rebound_says_so(contact_traces):
    found = contact_metrics.landing_metrics(contact_traces["h_1250us"], l03.STEP_CASES["h_1250us"])
    told = contact_said.step_study({0.01: found, 0.001: found}, 0.001)
    assert told[-1] == "At no step does it leave the surface again."
    leaving = replace(found, rebound=0.01)
    assert (
        "the smallest among them"
        in contact_said.step_study({0.01: found, 0.001: leaving}, 0.001)[-1]
    )


def test_tables_take_cases_of_one_kind(experiment):
    table = tables.six_digits(experiment.landings())
    assert table.splitlines()[0] == "| metric | baseline | dt10_sub1 | dt20_sub2 | dt20_sub1 |"
    gone = {"x": replace(experiment.slides()["low_on_050"], stop_time=None)}
    assert "not observed" in tables.six_digits(gone)


def test_figures_are_drawn_with_labelled_axes(experiment, study):
    figure = Figure()
    axes = figure.subplots(3, 1)
    contact_plots.heights(axes[0], experiment.traces, experiment.cases, (0.1, 0.5))
    contact_plots.counted(axes[1], experiment.traces, (0.1, 0.5))
    contact_plots.depths(axes[2], study)
    assert all(ax.get_xlabel() and ax.get_ylabel() for ax in axes)
    three = Figure().subplots(3, 1)
    contact_plots.slides(three, experiment.traces, l03.SLIDES, contact_plots.SLIDE_MARKS)
    assert len(three[0].lines) == 5  # four cubes and the zero
    two = Figure().subplots(2, 1)
    contact_plots.energies(two, experiment.traces, l03.BOUNCES)
    assert len(two[1].lines) == len(l03.BOUNCES)
    one = Figure().subplots()
    contact_plots.stopping(one, {"low_on_050": None}, {"low_on_050": 0.4})
    assert len(one.patches) == 0  # a cube that did not stop has no bar
    contact_plots.kept(Figure().subplots(), {0.01: 90.0, 0.001: None}, 94)
    contact_plots.schematic(Figure().subplots(), experiment.traces["baseline"], l03.BASELINE)


# Studies


@pytest.fixture(scope="module")
def study(contact_traces) -> contact_studies.Studies:
    traces = {name: contact_traces[name] for name in l03.STUDY_CASES}
    return contact_studies.Studies(traces, measure(traces, l03.STUDY_CASES), SECONDS)


def not_held(run) -> list[str]:
    return [check.name for check in contact_studies.run_checks(run) if not check.passed]


def studied(run, name, trace):
    traces = run.traces | {name: trace}
    return replace(run, traces=traces, metrics=measure(traces, l03.STUDY_CASES))


def test_a_sound_study_passes_every_check(study):
    assert not_held(study) == []


def test_another_time_constant_is_named(study):
    other = replace(study, time_constants=SECONDS | {"h_20000us": 0.01})
    assert not_held(other) == ["time_constants"]


def test_a_rebound_that_stays_with_smaller_steps_is_named(study):
    assert not_held(studied(study, "h_2500us", bumped(study, "h_2500us"))) == ["rebound_goes"]


def test_no_rebound_at_all_is_named(study):
    trace = study.traces["baseline"]
    z = np.array(trace.link_pos)
    z[23:, 0, 2] = np.minimum(z[23:, 0, 2], l03.BASELINE.rest_height)
    found = not_held(studied(study, "baseline", replace(trace, link_pos=z)))
    assert "rebound_goes" in found


def bumped(study, name):
    """Return a landing with one sample in the air after it."""
    trace = study.traces[name]
    z = np.array(trace.link_pos)
    z[-20, 0, 2] = l03.BASELINE.rest_height + 0.002
    return replace(trace, link_pos=z)


def test_a_depth_that_goes_on_changing_is_named(study):
    trace = study.traces["h_625us"]
    z = np.array(trace.link_pos)
    z[z[:, 0, 2] < l03.BASELINE.rest_height, 0, 2] -= 0.002
    found = not_held(studied(study, "h_625us", replace(trace, link_pos=z)))
    assert found == ["depth_converges"]


def test_a_blow_that_friction_does_not_pay_is_named(study):
    trace = study.traces["low_on_050"]
    slower = np.array(trace.link_vel)
    slower[1, 0, 0] -= 0.1
    found = not_held(studied(study, "low_on_050", replace(trace, link_vel=slower)))
    assert found == ["hop_is_paid_by_friction"]


def test_a_stop_far_from_coulomb_s_is_named(study):
    trace = study.traces["low_on_050"]
    farther = np.array(trace.link_pos)
    farther[10:, 0, 0] += 0.05
    found = not_held(studied(study, "low_on_050", replace(trace, link_pos=farther)))
    assert found == ["stops_nearly_right"]


def test_a_record_of_each_step_that_moves_otherwise_is_named(study):
    trace = study.traces["h_5000us"]
    aside = np.array(trace.link_pos)
    aside[40:, 0, 1] += 1e-5
    found = not_held(studied(study, "h_5000us", replace(trace, link_pos=aside)))
    assert found == ["records_each_step"]


def test_cubes_that_stay_down_are_named(study, slide_on_corners):
    found = not_held(studied(study, "high_on_050", slide_on_corners(l03.BESIDE)))
    assert found == ["default_cone_hops", "engines_hop_alike"]


def test_an_elliptic_cone_that_hops_is_named(study):
    found = not_held(studied(study, "low_elliptic", study.traces["mujoco_low_elliptic"]))
    assert found == ["elliptic_stays_down", "elliptic_is_stepped_coulomb"]
    farther = np.array(study.traces["low_elliptic"].link_pos)
    farther[10:, 0, 0] += 0.001
    trace = replace(study.traces["low_elliptic"], link_pos=farther)
    assert not_held(studied(study, "low_elliptic", trace)) == ["elliptic_is_stepped_coulomb"]


def test_engines_that_part_are_named(study):
    own = study.traces[l03.OWN_DEFAULTS]
    assert not_held(studied(study, "mujoco_baseline", own)) == ["engines_land_alike"]
    found = not_held(studied(study, "mujoco_low_on_050", study.traces["high_on_050"]))
    assert found == ["engines_hop_alike"]


def test_cones_that_agree_are_named(study):
    found = not_held(studied(study, "mujoco_low_elliptic", study.traces["low_elliptic"]))
    assert found == ["elliptic_cones_part"]


def test_rows_of_a_study_name_both_engines(study):
    rows = contact_studies.engine_rows(study)
    assert [row["MuJoCo"] for row in rows][-1] == l03.OWN_DEFAULTS
    assert rows[0]["more than 0.05 mm from"] == "never"
    assert len(contact_studies.step_rows(study)) == len(l03.STEP_CASES)
    with pytest.raises(KeyError, match="baseline is no slide"):
        study.slide("baseline")
    with pytest.raises(KeyError, match="low_on_050 is no landing"):
        study.landing("low_on_050")


# The second engine


def test_mujoco_turns_in_the_world_s_axes(contact_traces):
    trace = contact_traces["mujoco_high_on_050"]
    k = int(np.abs(trace.link_ang[:, 0, 1]).argmax())
    w, x, y, z = trace.link_quat[k - 1 : k + 2, 0].T.astype(float)
    pitch = np.unwrap(2 * np.arctan2(y, w))
    rate = (pitch[2] - pitch[0]) / (2 * trace.dt)
    assert np.abs([x, z]).max() < 1e-3  # it turns about y alone
    assert trace.link_ang[k, 0, 1] == pytest.approx(rate, rel=0.3)


def test_the_shortest_time_constant_is_two_steps():
    assert second_contacts.time_constant(0.02) == 0.04
    assert second_contacts.time_constant(0.001) == 0.01
    assert second_contacts.load(l03.LANDINGS["dt20_sub1"]).geom_solref[0].tolist() == [0.04, 1]
    own = second_contacts.load(l03.BASELINE, own_defaults=True)
    assert own.geom_solref[0].tolist() == [0.02, 1]


def test_a_case_is_data_that_a_bundle_can_hold():
    assert isinstance(l03.parameters()["cases"]["baseline"]["start"], tuple)
    assert ContactCase(start=(0, 0, 1), duration=1.0).cone == "pyramidal"
