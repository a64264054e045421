"""Bodies that land, slide and bounce: known answers, metrics, named checks, sentences, studies."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core import tables
from robo_genesis.core.checks import require
from robo_genesis.core.trace import ContactTrace, TraceError
from robo_genesis.evidence.trace_files import CONTACT_FIELDS
from robo_genesis.lessons.l02 import plots as drop_plots
from robo_genesis.lessons.l03 import checks, energy, plots, spec
from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03 import metrics as contact_metrics
from robo_genesis.lessons.l03 import study as contact_studies
from robo_genesis.lessons.l03 import tables as contact_tables
from robo_genesis.lessons.l03 import text as contact_said
from robo_genesis.lessons.l03.metrics import measure, metric_records, metrics_class, stopped_at
from robo_genesis.sim import contacts, mujoco_contacts
from robo_genesis.sim.contacts import TOP, ContactCase, ContactError

THREE = ("bounce_sub1", "bounce_sub2", "bounce_sub100")
MASSES = {"cube": spec.BASELINE.mass, "ball": spec.DROPPED_BALL.mass}
SECONDS = {
    name: mujoco_contacts.time_constant(contact_studies.solver_step(name))
    for name in spec.STEPS_STUDIED
}


def asked(cases):
    """Return the settings of cases as a scene would give them back."""
    return {name: {n: getattr(c, name) for n, c in cases.items()} for name in contacts.SETTINGS}


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


@pytest.mark.parametrize("n", [4.5, 40.5])
def test_a_stop_between_two_steps_is_a_little_farther(n):
    friction, gravity, speed = 0.5, 10.0, 2.0
    h = speed / (friction * gravity) / n
    v, x = speed, 0.0
    while v > friction * gravity * h:
        v = v - friction * gravity * h
        x = x + v * h
    more = x - sliding.stepped_distance(speed, friction, h, gravity)
    assert 0 < more <= friction * gravity * h**2 / 8 * (1 + 1e-9)


@pytest.mark.parametrize("n", [4, 40, 400])
def test_the_stepped_distance_is_what_a_loop_adds_up_to(n):
    friction, gravity, speed = 0.5, 10.0, 2.0
    h = speed / (friction * gravity) / n  # stops after n steps exactly
    v, x = speed, 0.0
    for _ in range(n):
        v = v - friction * gravity * h
        x = x + v * h
    assert x == pytest.approx(sliding.stepped_distance(speed, friction, h, gravity), rel=1e-12)


def test_rules_for_two_coefficients_differ():
    found = {name: rule(0.2, 0.8) for name, rule in sliding.RULES.items()}
    assert found == pytest.approx(
        {"the larger": 0.8, "the smaller": 0.2, "the mean": 0.5, "the geometric mean": 0.4}
    )


# Cases


def test_a_case_knows_its_step_mass_and_place():
    cube, ball = spec.BASELINE, spec.DROPPED_BALL
    assert (cube.h, cube.steps, cube.rest_height) == pytest.approx((0.005, 150, 0.765))
    assert cube.mass == pytest.approx(0.256)
    assert cube.inertia == pytest.approx(0.256 * 0.08**2 / 6)
    assert ball.mass == pytest.approx(500 * 4 / 3 * np.pi * 0.04**3)
    assert ball.inertia == pytest.approx(0.4 * ball.mass * 0.04**2)
    kinds = {name: case.kind for name, case in spec.CASES.items()}
    assert kinds["baseline"] == contacts.LANDING
    assert kinds["low_on_030"] == contacts.SLIDE
    assert kinds["bounce_sub2"] == contacts.BOUNCE


def test_a_time_that_is_no_whole_number_of_steps_is_refused():
    with pytest.raises(ContactError, match=r"duration is 1\.5 s, no whole number .* 0\.4 s"):
        replace(spec.BASELINE, dt=0.4)
    with pytest.raises(ContactError, match=r"settle is 0\.005 s"):
        replace(spec.BASELINE, settle=0.005)
    with pytest.raises(ContactError, match=r"shape 'cone' was given, valid is 'cube' or 'ball'"):
        replace(spec.BASELINE, shape="cone")
    with pytest.raises(ContactError, match=r"cone 'round' was given, valid is 'pyramidal' or"):
        replace(spec.BASELINE, cone="round")


def test_cases_of_one_scene_share_what_a_scene_has_once():
    assert contacts.shared_case({"a": spec.PUSHED, "b": spec.BESIDE}) is spec.PUSHED
    with pytest.raises(ContactError, match=r"b asks for surface_friction=0\.3, .* 0\.5"):
        contacts.shared_case({"a": spec.PUSHED, "b": spec.SLIDES["low_on_030"]})
    with pytest.raises(ContactError, match="at least one"):
        contacts.shared_case({})


def test_parameters_of_the_public_course_are_kept():
    landings = {(c.dt, c.substeps) for c in spec.LANDINGS.values()}
    assert landings == {(0.01, 1), (0.01, 2), (0.02, 1), (0.02, 2)}
    assert {c.duration for c in spec.LANDINGS.values()} == {1.5}
    pairs = {(c.friction, c.surface_friction) for c in spec.SLIDES.values()}
    assert pairs == {(0.1, 0.5), (0.8, 0.5), (0.1, 0.3), (0.8, 0.3)}
    assert {(c.speed, c.settle, c.duration) for c in spec.SLIDES.values()} == {(2.0, 0.3, 2.0)}
    assert (TOP, spec.BASELINE.start[2], spec.BASELINE.size) == (0.725, 1.0, 0.08)


# Energy and clearance


def thrown(speed, h, n):
    """Return a cube that is thrown upwards, stepped by hand as semi-implicit Euler does."""
    case = replace(spec.BASELINE, dt=h, substeps=1, duration=n * h)
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
    case = spec.BASELINE
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
    assert energy.clearance(trace, spec.BASELINE) == pytest.approx([expected] * 2, abs=1e-6)
    ball = energy.clearance(trace, spec.DROPPED_BALL)
    assert ball == pytest.approx([1.0 - 0.04 - TOP] * 2, abs=1e-6)


def test_turning_about_the_vertical_changes_no_clearance():
    quat = (np.cos(0.3), 0, 0, np.sin(0.3))
    assert energy.clearance(body_at([1.0, 1.0], quat=quat), spec.BASELINE)[0] == pytest.approx(
        0.235, abs=1e-6
    )


def test_flights_are_the_stretches_in_the_air():
    up, down = spec.DROPPED_BALL.rest_height + 0.01, spec.DROPPED_BALL.rest_height - 0.001
    trace = body_at([up] * 4 + [down] * 2 + [up] * 2 + [down] + [up] * 3)
    found = list(energy.flights(trace, spec.DROPPED_BALL))
    assert found == [slice(0, 4), slice(9, 12)]  # two states are too few


def test_a_spring_without_damping_keeps_everything():
    assert energy.kept_at_bounces(0.0) == 1
    assert energy.kept_at_bounces(0.01) == pytest.approx(np.exp(-2 * np.pi * 0.01), rel=1e-4)


# Metrics


def test_metrics_of_a_landing_by_hand():
    rest = spec.BASELINE.rest_height
    z = rest + np.array([0.02, 0.01, -0.008, -0.001, 0.003, 0.002, -0.0001, 0, 0, 0])
    trace = body_at(z, contacts=[0, 0, 0, 4, 0, 0, 4, 4, 4, 4], vz=[0, -1, 0.5, 0.2] + [0] * 6)
    found = contact_metrics.landing_metrics(trace, spec.BASELINE)
    assert found.touchdown == pytest.approx(0.02)
    assert found.penetration == pytest.approx(0.008, abs=1e-6)
    assert found.rebound == pytest.approx(0.003, abs=1e-6)
    assert found.separated == pytest.approx(0.02)  # two samples without contact and clear
    assert found.upward_speed == pytest.approx(0.5)
    assert found.resting_time == pytest.approx(0.06)
    assert found.resting_offset == pytest.approx(0, abs=1e-6)


def test_a_cube_that_never_lands_has_no_touchdown():
    found = contact_metrics.landing_metrics(body_at([1.0] * 5), spec.BASELINE)
    assert (found.touchdown, found.resting_time) == (None, None)
    assert (found.penetration, found.rebound, found.separated) == (0, 0, 0)


def test_a_stop_takes_a_hold():
    speed = np.array([1, 0.005, 0.5] + [0.005] * 11 + [0.0])
    assert stopped_at(speed, 0.01) == 3  # not the one slow sample before
    assert stopped_at(speed[:13], 0.01) is None  # the window ends before the hold does
    assert stopped_at(np.full(40, 0.01), 0.01) is None  # slower, not as slow


def test_metrics_of_a_slide_on_corners(slide_on_corners):
    case = spec.CLEAN_SLIDES["low_on_050_elliptic"]
    found = contact_metrics.slide_metrics(slide_on_corners(case), case)
    expected = sliding.stepped_distance(2.0, 0.5, case.h)
    assert found.stop_distance == pytest.approx(expected, abs=1e-4)
    assert (found.hop, found.airborne, found.spin) == (0, 0, 0)
    assert found.first_speed == pytest.approx(2 - 0.5 * 9.81 * 0.01, rel=1e-6)


def test_the_kept_share_is_that_of_the_flights(contact_traces):
    case = spec.BOUNCES["bounce_sub20"]
    found = contact_metrics.bounce_metrics(contact_traces["bounce_sub20"], case)
    assert found.start_energy == pytest.approx(case.mass * 9.81 * 0.1, rel=1e-4)
    assert found.first_kept == pytest.approx(100 * energy.kept_at_bounces(0.01), abs=1)
    assert found.later_kept < found.first_kept
    none = contact_metrics.bounce_metrics(body_at([1.0] * 5), case)
    assert (none.first_kept, none.later_kept) == (None, None)
    resting = contact_metrics.bounce_metrics(body_at([case.rest_height] * 5), case)
    assert (resting.flight_drift, resting.lent) == (None, None)


def test_each_metric_has_unit_source_tolerance_and_form(contact_traces):
    metrics = measure(contact_traces, spec.CASES)
    found = metric_records(metrics, spec.EXPECTED_MODEL, MASSES, asked(spec.CASES))
    units = {unit for of in metrics.values() for _, _, unit in of.items()}
    assert units <= spec.TOLERANCES.keys() & spec.RESOLUTION.keys()
    known = {name for name, *_ in CONTACT_FIELDS.values()}
    assert {s for of in metrics.values() for n in of.about("sources").values() for s in n} <= known
    assert found["mass"]["ball"]["unit"] == "kg"
    assert found["baseline"]["penetration"]["from"] == ["link_pos_m", "link_quat_wxyz"]
    for name, case in spec.CASES.items():
        assert found[name].keys() == metrics_class(case).about("unit").keys()


def test_contacts_of_another_length_form_no_run():
    trace = body_at([1.0] * 4)
    with pytest.raises(TraceError, match=r"contacts has shape \(3, 1\), expected \(4, 1\)"):
        replace(trace, contacts=trace.contacts[:3])


# Checks


@pytest.fixture(scope="module")
def experiment(contact_traces, frames) -> checks.ContactExperiment:
    traces = {name: contact_traces[name] for name in spec.CASES}
    return checks.ContactExperiment(
        spec.EXPECTED_MODEL,
        MASSES,
        asked(spec.CASES),
        spec.CASES,
        traces,
        measure(traces, spec.CASES),
        "camera",
        frames,
    )


def failing(run) -> list[str]:
    return [check.name for check in checks.run_checks(run) if not check.passed]


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
    assert require("l03", checks.run_checks(experiment)) == "L03 CHECK: PASSED"


def test_one_more_link_or_a_wrong_mass_is_named(experiment):
    assert failing(replace(experiment, model=spec.EXPECTED_MODEL | {"links": 2})) == ["structure"]
    for masses in (MASSES | {"ball": 0.14}, {}, MASSES | {"cube": np.nan}):
        assert failing(replace(experiment, masses=masses)) == ["mass"]


def test_another_setting_than_asked_for_is_named(experiment):
    for name, value in (("friction", 0.45), ("surface_friction", np.nan), ("substeps", 1.0)):
        found = experiment.settings | {name: experiment.settings[name] | {"low_on_050": value}}
        assert failing(replace(experiment, settings=found)) == ["settings"]
    for unread in ({}, experiment.settings | {"substeps": {}}):
        assert failing(replace(experiment, settings=unread)) == ["settings"]


def test_the_exercise_fails_what_the_lecture_says(experiment):
    on_050 = {"low_on_030": experiment.traces["low_on_050"],
              "high_on_030": experiment.traces["high_on_050"]}  # fmt: skip
    traces = experiment.traces | on_050
    surfaces = experiment.settings["surface_friction"] | dict.fromkeys(on_050, 0.5)
    spoilt = replace(
        experiment,
        traces=traces,
        metrics=measure(traces, spec.CASES),
        settings=experiment.settings | {"surface_friction": surfaces},
    )
    assert failing(spoilt) == ["settings", "friction_orders", "near_coulomb"]


def test_a_missing_step_is_named(experiment):
    trace = experiment.traces["bounce_sub1"]
    cut = {f: getattr(trace, f)[:-1] for f in trace.__dataclass_fields__}
    assert "stamps" in failing(with_trace(experiment, "bounce_sub1", ContactTrace(**cut)))


def test_a_start_elsewhere_or_at_another_speed_is_named(experiment):
    assert "start" in failing(moved(experiment, "high_on_030", 0.01, axis=1))
    slower = moved(experiment, "low_on_030", -0.1, field="link_vel", axis=0)
    assert "start" in failing(slower)


def test_a_second_factor_is_named(experiment):
    for name, other in (("dt10_sub1", {"duration": 1.6}), ("bounce_sub4", {"spring": (1.0, 0.02)})):
        case = replace(spec.CASES[name], **other)
        assert "one_factor" in failing(replace(experiment, cases=spec.CASES | {name: case}))


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


def test_other_states_at_shared_times_are_named(experiment):
    found = failing(moved(experiment, "dt20_sub2", 1e-5, axis=0, start=5))
    assert found == ["equal_step_equal_states"]
    turning = moved(experiment, "dt20_sub2", 1e-3, field="link_ang", start=5)
    assert failing(turning) == ["equal_step_equal_states"]


def test_a_cube_that_does_not_settle_is_named(experiment):
    assert "settles" in failing(moved(experiment, "baseline", 0.001, start=120))


def test_a_cube_that_does_not_stop_is_named(experiment):
    found = failing(moved(experiment, "low_on_030", 0.5, field="link_vel", axis=0, start=60))
    assert found == ["stops", "friction_orders", "near_coulomb"]


def test_a_surface_that_changes_the_other_cube_is_named(experiment):
    assert failing(moved(experiment, "high_on_030", 0.01, axis=0, start=20)) == ["friction_orders"]


def test_a_slide_of_another_rule_is_named(experiment, slide_on_corners):
    smaller = replace(spec.PUSHED, surface_friction=0.25, friction=0.25)
    found = failing(with_trace(experiment, "low_on_050", slide_on_corners(smaller)))
    assert "near_coulomb" in found


def test_energy_that_leaks_in_flight_is_named(experiment):
    found = failing(moved(experiment, "bounce_sub20", 0.002, start=10))
    assert "level_in_flight" in found
    still = body_at([spec.DROPPED_BALL.rest_height] * 201)
    assert "level_in_flight" in failing(with_trace(experiment, "bounce_sub20", still))


def test_energy_that_does_not_converge_is_named(experiment):
    name = "bounce_sub100"
    for share in (90.0, None):
        other = {name: replace(experiment.bounces()[name], first_kept=share)}
        spoilt = replace(experiment, metrics=experiment.metrics | other)
        assert failing(spoilt) == ["energy_converges"]
    still = body_at([spec.DROPPED_BALL.rest_height + 0.1] * 201)
    assert "energy_converges" in failing(with_trace(experiment, name, still))


def test_one_picture_twice_is_named(experiment, frames):
    same = {"initial": frames["initial"], "final": frames["initial"]}
    assert failing(replace(experiment, frames=same)) == ["posture"]


# Sentences, tables and figures


def test_sentences_tell_what_is_there(experiment):
    text = "\n".join(block.markdown() for block in contact_said.interpretation(experiment))
    assert "`baseline` rebounds. Whether that is physics" in text
    assert "`low_on_050`: 0.1 on 0.5. By its distance it stopped as with 0.5" in text
    assert "For the cube with high friction, the other surface changes nothing" in text
    assert "has 101.7 % of its energy after the first bounce, more than before" in text


def test_sentences_of_what_did_not_happen(experiment, slide_on_corners):
    flat = contact_said.slide_sentence(
        "low",
        contact_metrics.slide_metrics(slide_on_corners(spec.PUSHED), spec.PUSHED),
        spec.PUSHED,
    )
    assert "It stayed on the surface." in flat
    going = contact_metrics.slide_metrics(body_at([0.765] * 30, vz=0), spec.PUSHED)
    never = replace(going, stop_distance=None, stop_time=None)
    assert "did not stop in the window" in contact_said.slide_sentence("x", never, spec.PUSHED)
    high = contact_metrics.landing_metrics(body_at([1.0] * 5), spec.BASELINE)
    assert "did not reach the surface" in contact_said.landing_sentence("x", high)
    lost = replace(experiment.bounces()["bounce_sub1"], first_kept=None)
    assert "does not bounce" in contact_said.bounce_sentence(lost, spec.BOUNCES["bounce_sub1"])


def test_a_study_without_a_rebound_says_so(contact_traces):
    name = "h_1250us_10000"
    found = contact_metrics.landing_metrics(contact_traces[name], spec.LANDED_AGAIN[name])
    told = contact_said.step_study({0.01: [found], 0.001: [found]})
    assert told[-1] == "At no step does any of them rebound."
    leaving = replace(found, rebound=0.01)
    told = contact_said.step_study({0.01: [found], 0.001: [leaving]})
    assert "the smallest step among them" in told[-1]


def test_tables_take_cases_of_one_kind(experiment):
    table = tables.six_digits(experiment.landings())
    assert table.splitlines()[0] == "| metric | baseline | dt10_sub1 | dt20_sub2 | dt20_sub1 |"
    gone = {"x": replace(experiment.slides()["low_on_050"], stop_time=None)}
    assert "not observed" in tables.six_digits(gone)


def test_figures_are_drawn_with_labelled_axes(experiment, study):
    figure = Figure()
    axes = figure.subplots(3, 1)
    plots.heights(axes[0], experiment.traces, experiment.cases, (0.1, 0.5))
    plots.counted(axes[1], experiment.traces, (0.1, 0.5))
    plots.depths(axes[2], study)
    assert all(ax.get_xlabel() and ax.get_ylabel() for ax in axes)
    three = Figure().subplots(3, 1)
    plots.slides(three, experiment.traces, spec.SLIDES, plots.SLIDE_MARKS)
    assert len(three[0].lines) == 5  # four cubes and the zero
    two = Figure().subplots(2, 1)
    plots.energies(two, experiment.traces, {n: spec.BOUNCES[n] for n in THREE})
    assert len(two[1].lines) == 3
    one = Figure().subplots()
    plots.stopping(one, {"low_on_050": None}, {"low_on_050": 0.4})
    assert len(one.patches) == 0  # a cube that did not stop has no bar
    plots.kept(Figure().subplots(), {0.01: 90.0, 0.001: None}, 94)
    drop_plots.schematic(Figure().subplots(), experiment.traces["baseline"], 0.08, contacts.TOP)


# Studies


@pytest.fixture(scope="module")
def study(contact_traces) -> contact_studies.Studies:
    traces = {name: contact_traces[name] for name in spec.STUDY_CASES}
    return contact_studies.Studies(traces, measure(traces, spec.STUDY_CASES), SECONDS)


def not_held(run) -> list[str]:
    return [check.name for check in contact_studies.run_checks(run) if not check.passed]


def studied(run, name, trace):
    traces = run.traces | {name: trace}
    return replace(run, traces=traces, metrics=measure(traces, spec.STUDY_CASES))


def shifted(run, name, by, field="link_pos", axis=2, where=slice(None)):
    """Return the studies with an array of one run changed along an axis at some states."""
    array = np.array(getattr(run.traces[name], field))
    array[where, 0, axis] += by
    return studied(run, name, replace(run.traces[name], **{field: array}))


def test_a_sound_study_passes_every_check(study):
    assert not_held(study) == []


def test_another_time_constant_is_named(study):
    for value in (0.01, np.nan):
        other = replace(study, time_constants=SECONDS | {"h_20000us": value})
        assert not_held(other) == ["time_constants"]


def test_a_record_of_each_step_that_moves_otherwise_is_named(study):
    found = not_held(shifted(study, spec.AS_BASELINE, 1e-5, where=slice(20, 40)))
    assert found == ["records_each_step"]


def test_a_rebound_that_stays_with_smaller_steps_is_named(study):
    name = "h_625us_10000"
    up = spec.BASELINE.rest_height + 0.002 - study.traces[name].link_pos[-20, 0, 2]
    assert not_held(shifted(study, name, up, where=slice(-20, -19))) == ["rebound_goes"]


def test_no_rebound_at_all_is_named(study):
    run = study
    for name in spec.STEP_CASES["h_5000us"]:
        z = np.array(run.traces[name].link_pos)
        landed = np.maximum.accumulate(z[:, 0, 2] < spec.BASELINE.rest_height)
        z[landed, 0, 2] = np.minimum(z[landed, 0, 2], spec.BASELINE.rest_height)
        run = studied(run, name, replace(run.traces[name], link_pos=z))
    assert "rebound_goes" in not_held(run)


def test_a_depth_that_hangs_on_the_start_at_fine_steps_is_named(study):
    name = "h_125us_10000"
    deep = study.traces[name].link_pos[:, 0, 2] < spec.BASELINE.rest_height - 0.005
    assert not_held(shifted(study, name, -0.003, where=deep)) == ["scatter_shrinks"]


def test_cubes_that_stay_down_are_named(study, slide_on_corners):
    found = not_held(studied(study, "high_on_050", slide_on_corners(spec.BESIDE)))
    assert found == ["default_cone_hops", "hop_is_paid_by_friction", "engines_hop_alike"]


def test_a_blow_that_friction_does_not_pay_is_named(study):
    found = not_held(shifted(study, "low_on_050", -0.1, "link_vel", 0, slice(1, 2)))
    assert found == ["hop_is_paid_by_friction"]


def test_a_stop_far_from_coulomb_s_is_named(study):
    found = not_held(shifted(study, "low_on_050", 0.05, axis=0, where=slice(10, None)))
    assert found == ["stops_nearly_right"]


def test_a_clean_slide_that_hops_is_named(study):
    found = not_held(shifted(study, "low_on_030_elliptic", 0.001, where=slice(10, 12)))
    assert found == ["clean_slides_stay_down"]
    trace = study.traces["low_on_030_elliptic"]
    three = replace(trace, contacts=np.where(np.arange(201)[:, None] == 5, 3, trace.contacts))
    assert not_held(studied(study, "low_on_030_elliptic", three)) == ["clean_slides_stay_down"]


def test_a_clean_slide_that_stops_elsewhere_is_named(study):
    found = not_held(shifted(study, "low_on_050_elliptic", 0.001, axis=0, where=slice(10, None)))
    assert found == ["clean_slides_are_coulomb_s"]


def test_another_rule_of_friction_is_named(study, slide_on_corners):
    mean = replace(spec.PUSHED, friction=0.3, surface_friction=0.3, cone="elliptic")
    found = not_held(studied(study, "low_on_050_elliptic", slide_on_corners(mean)))
    assert found == ["clean_slides_are_coulomb_s", "larger_friction_rules"]


def test_a_round_cone_that_stays_down_is_named(study):
    clean = study.traces["low_on_050_elliptic"]
    found = not_held(studied(study, "low_on_050_convex", clean))
    assert found == ["the_cone_alone_hops", "engines_hop_alike"]


def test_engines_that_part_are_named(study):
    own = study.traces[spec.OWN_DEFAULTS]
    assert not_held(studied(study, "mujoco_baseline", own)) == ["engines_land_alike"]
    found = not_held(studied(study, "mujoco_low_on_050", study.traces["high_on_050"]))
    assert found == ["engines_hop_alike"]


def test_rows_of_a_study_name_both_engines(study):
    rows = contact_tables.engine_rows(study)
    assert [row["MuJoCo"] for row in rows] == [*spec.ENGINE_PAIRS.values(), spec.OWN_DEFAULTS]
    assert (rows[0]["over 0.05 mm from"], rows[0]["contacts there"]) == ("never", "– and –")
    assert rows[-1]["over 0.05 mm from"] != "never"
    assert len(contact_tables.step_rows(study)) == len(spec.STEPS_STUDIED)
    slides = contact_tables.slide_rows(study, ["low_on_050"], stepped=True)
    assert slides[0]["v² / (2 μ g) − v h / 2 [m]"] == "0.40275"
    assert contact_tables.slide_rows(study, ["low_on_050"])[0]["v² / (2 μ g) [m]"] == "0.40775"
    with pytest.raises(KeyError, match="baseline is no slide"):
        study.slide("baseline")
    with pytest.raises(KeyError, match="low_on_050 is no landing"):
        study.landing("low_on_050")


def test_a_distance_between_runs_takes_shared_times_and_no_lanes(study):
    fine = contact_studies.distance_between(study, "h_10000us_10000", "mujoco_dt20_sub1")
    assert len(fine) == 21  # every second state of the finer one
    assert fine[0] == 0


def test_the_cases_of_the_lesson_are_chosen_and_rows_say_how_many_steps():
    rows = contact_said.landing_rows(spec.LANDINGS)
    assert [row["solver steps"] for row in rows] == ["300", "150", "150", "75"]


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
    assert mujoco_contacts.time_constant(0.02) == 0.04
    assert mujoco_contacts.time_constant(0.001) == 0.01
    assert mujoco_contacts.load(spec.LANDINGS["dt20_sub1"]).geom_solref[0].tolist() == [0.04, 1]
    own = mujoco_contacts.load(spec.BASELINE, own_defaults=True)
    assert own.geom_solref[0].tolist() == [0.02, 1]


def test_a_case_is_data_that_a_bundle_can_hold():
    assert isinstance(spec.parameters()["cases"]["baseline"]["start"], tuple)
    assert ContactCase(start=(0, 0, 1), duration=1.0).cone == "pyramidal"
