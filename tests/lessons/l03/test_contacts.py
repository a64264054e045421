"""Bodies that land, slide and bounce: known answers, metrics, named checks, sentences, studies."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import body_at, slide_on_corners
from lessons.l03.conftest import MASSES, READINGS
from matplotlib.figure import Figure
from matplotlib.text import Text

from robo_genesis.core import plotting
from robo_genesis.core.checks import require
from robo_genesis.core.experiment import Experiment, Run
from robo_genesis.core.trace import ContactTrace, TraceError
from robo_genesis.lessons.l03 import LAB, energy, friction, plots, spec, study_spec, tables, text
from robo_genesis.lessons.l03.metrics import (
    bounce_metrics,
    case_metrics,
    landing_metrics,
    slide_metrics,
    stopped_at,
)
from robo_genesis.sim.bodies import contacts
from robo_genesis.sim.bodies.contacts import TOP, ContactError

THREE = ("bounce_sub1", "bounce_sub2", "bounce_sub100")


# Coulomb's friction


def test_coulomb_s_distance_and_time_by_hand():
    # 2 m/s, μ = 0.5, g = 10: 4 / 10 m and 2 / 5 s
    assert friction.coulomb_distance(2, 0.5, gravity=10) == pytest.approx(0.4)
    assert friction.coulomb_time(2, 0.5, gravity=10) == pytest.approx(0.4)
    assert friction.apparent_friction(2, 0.4, gravity=10) == pytest.approx(0.5)


@pytest.mark.parametrize("n", [4, 40, 400, 4.5, 40.5])
def test_the_stepped_distance_is_what_a_loop_adds_up_to(n):
    mu, gravity, speed = 0.5, 10.0, 2.0
    h = speed / (mu * gravity) / n  # the body stops after n steps
    v, x = speed, 0.0
    for _ in range(int(n)):
        v = v - mu * gravity * h
        x = x + v * h
    longer = x - friction.stepped_distance(speed, mu, h, gravity)
    if n == int(n):
        assert longer == pytest.approx(0, abs=1e-12)
    else:
        assert 0 < longer <= mu * gravity * h**2 / 8 * (1 + 1e-9)


def test_rules_for_two_coefficients_differ():
    found = {name: rule(0.2, 0.8) for name, rule in friction.RULES.items()}
    assert list(found.values()) == pytest.approx([0.8, 0.2, 0.5, 0.4])
    assert friction.pair_friction(spec.PUSHED) == 0.5


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


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dt": 0.4}, r"duration is 1\.5 s, no whole number .* 0\.4 s"),
        ({"settle": 0.005}, r"settle is 0\.005 s"),
        ({"shape": "cone"}, r"shape 'cone' was given, valid is 'cube' or 'ball'"),
        ({"cone": "round"}, r"cone 'round' was given, valid is 'pyramidal' or"),
    ],
)
def test_a_case_that_cannot_be_run_is_refused(changes, message):
    with pytest.raises(ContactError, match=message):
        replace(spec.BASELINE, **changes)


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
    kept, total = energy.conserved_energy(trace, case), energy.total_energy(trace, case)
    assert np.ptp(kept) < 1e-6 * kept[0]
    flight_change = case.mass * case.gravity * case.h * np.ptp(trace.link_vel[:, 0, 2]) / 2
    assert np.ptp(total) == pytest.approx(flight_change, rel=1e-4)


def test_turning_counts_as_energy():
    case = spec.BASELINE
    trace = body_at([case.rest_height] * 3)
    turning = np.zeros((3, 1, 3), np.float32)
    turning[:, 0, 1] = 10
    spinning = replace(trace, link_ang=turning)
    assert energy.total_energy(spinning, case) == pytest.approx(
        [case.inertia * 100 / 2] * 3, rel=1e-5
    )


@pytest.mark.parametrize(
    ("axis", "reach"),
    [((1, 0, 0), 0.04 * np.sqrt(2)), ((0, 1, 0), 0.04 * np.sqrt(2)), ((0, 0, 1), 0.04)],
)
def test_a_cube_on_its_edge_reaches_lower(axis, reach):
    half = np.pi / 8  # 45° about the axis
    trace = body_at([1.0, 1.0], quat=(np.cos(half), *(np.sin(half) * np.array(axis))))
    expected = 1.0 - reach - TOP
    assert energy.clearance(trace, spec.BASELINE) == pytest.approx([expected] * 2, abs=1e-6)
    ball = energy.clearance(trace, spec.DROPPED_BALL)
    assert ball == pytest.approx([1.0 - 0.04 - TOP] * 2, abs=1e-6)


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
    found = landing_metrics(trace, spec.BASELINE)
    assert (found.penetration, found.rebound) == pytest.approx((0.008, 0.003), abs=1e-6)
    assert (found.touchdown, found.upward_speed) == pytest.approx((0.02, 0.5))
    assert found.separated == pytest.approx(0.02)  # two samples without contact and clear
    assert (found.resting_time, found.resting_offset) == pytest.approx((0.06, 0), abs=1e-6)


def test_a_cube_that_never_lands_has_no_touchdown():
    found = landing_metrics(body_at([1.0] * 5), spec.BASELINE)
    assert (found.touchdown, found.resting_time) == (None, None)
    assert (found.penetration, found.rebound, found.separated) == (0, 0, 0)


def test_a_stop_takes_a_hold():
    speed = np.array([1, 0.005, 0.5] + [0.005] * 11 + [0.0])
    assert stopped_at(speed, 0.01) == 3  # not the one slow sample before
    assert stopped_at(speed[:13], 0.01) is None  # the window ends before the hold does
    assert stopped_at(np.full(40, 0.01), 0.01) is None  # slower, not as slow


def test_metrics_of_a_slide_on_corners():
    case = study_spec.ELLIPTIC["low_on_050_elliptic"]
    found = slide_metrics(slide_on_corners(case), case)
    expected = friction.stepped_distance(2.0, 0.5, case.h)
    assert found.stop_distance == pytest.approx(expected, abs=1e-4)
    assert (found.hop, found.airborne, found.spin) == (0, 0, 0)
    assert found.first_speed == pytest.approx(2 - 0.5 * 9.81 * 0.01, rel=1e-6)


def test_the_kept_share_is_that_of_the_flights(contact_traces):
    case = spec.BOUNCES["bounce_sub20"]
    found = bounce_metrics(contact_traces["bounce_sub20"], case)
    assert found.start_energy == pytest.approx(case.mass * 9.81 * 0.1, rel=1e-4)
    assert found.first_kept == pytest.approx(100 * energy.kept_at_bounces(0.01), abs=1)
    assert found.later_kept < found.first_kept
    none = bounce_metrics(body_at([1.0] * 5), case)
    assert (none.first_kept, none.later_kept) == (None, None)
    resting = bounce_metrics(body_at([case.rest_height] * 5), case)
    assert (resting.flight_drift, resting.flight_change) == (None, None)


def test_contacts_of_another_length_form_no_run():
    trace = body_at([1.0] * 4)
    with pytest.raises(TraceError, match=r"contacts has shape \(3, 1\), expected \(4, 1\)"):
        replace(trace, contacts=trace.contacts[:3])


# Checks


@pytest.fixture(scope="module")
def experiment(experiments) -> Experiment:
    return experiments["lab"]


def failing(run) -> list[str]:
    return [check.name for check in run.outcomes() if not check.passed]


def with_trace(run, name, trace):
    return replace(run, traces=run.traces | {name: trace})


def with_reading(group, found):
    return lambda run: replace(run, readings=run.readings | {group: found})


def changed(name, field, change):
    """Return a function that gives one run another array, made from a copy of its own."""

    def spoil(run):
        array = change(np.array(getattr(run.traces[name], field)))
        return with_trace(run, name, replace(run.traces[name], **{field: array}))

    return spoil


def shift(name, by, field="link_pos", axis=2, first=0, end=None):
    """Return a function that changes an array of one run along an axis from `first` until `end`."""

    def change(array):
        array[first:end, 0, axis] += by
        return array

    return changed(name, field, change)


def test_a_sound_experiment_passes_every_check(experiment):
    assert failing(experiment) == []
    assert require("l03", experiment.outcomes()) == "L03 CHECK: PASSED"


def with_setting(name, value):
    return with_reading(name, READINGS["lab"][name] | {"low_on_050": value})


def with_case(name, **changes):
    runs = LAB.runs | {name: Run(replace(spec.CASES[name], **changes))}
    return lambda run: replace(run, page=replace(LAB, runs=runs))


def without_last_step(run):
    trace = run.traces["bounce_sub1"]
    cut = {f: getattr(trace, f)[:-1] for f in trace.__dataclass_fields__}
    return with_trace(run, "bounce_sub1", ContactTrace(**cut))


def with_kept(share):
    """Return a function that gives the ball with the finest step another share of its energy."""

    def measure(trace, case):
        found = case_metrics(trace, case)
        finest = case == spec.BOUNCES["bounce_sub100"]
        return replace(found, first_kept=share) if finest else found

    return lambda run: replace(run, page=replace(LAB, measure=measure))


def as_slide(name, case, **changes):
    return lambda run: with_trace(run, name, slide_on_corners(replace(case, **changes)))


def ball_at(name, above):
    still = body_at([spec.DROPPED_BALL.rest_height + above] * 201)
    return lambda run: with_trace(run, name, still)


FAILING = {
    "one more link": (
        with_reading("model", spec.EXPECTED_MODEL | {"links": 2}), {"structure"}),
    "a wrong mass": (with_reading("mass", MASSES | {"ball": 0.14}), {"mass"}),
    "no mass": (with_reading("mass", {}), {"mass"}),
    "a mass that is no number": (with_reading("mass", MASSES | {"cube": np.nan}), {"mass"}),
    "another friction": (with_setting("friction", 0.45), {"settings"}),
    "another friction of the surface": (with_setting("surface_friction", np.nan), {"settings"}),
    "other substeps": (with_setting("substeps", 1.0), {"settings"}),
    "settings that were not read": (
        lambda run: replace(run, readings={n: run.readings[n] for n in ("model", "mass")}),
        {"settings"}),
    "substeps that were not read": (with_reading("substeps", {}), {"settings"}),
    "a missing step": (without_last_step, {"stamps"}),
    "a start elsewhere": (shift("high_on_030", 0.01, axis=1), {"start"}),
    "a start at another speed": (
        shift("low_on_030", -0.1, field="link_vel", axis=0, end=1), {"start"}),
    "a second factor of a landing": (
        with_case("dt10_sub1", duration=1.6), {"one_factor", "stamps"}),
    "a second factor of a bounce": (with_case("bounce_sub4", spring=(1.0, 0.02)), {"one_factor"}),
    "a cube that hovers": (changed("baseline", "contacts", np.zeros_like), {"lands"}),
    "a cube that falls through": (shift("baseline", -0.05, first=30), {"lands", "settles"}),
    "depths of the same state": (
        changed("dt10_sub1", "penetration", lambda depth: np.roll(depth, -1)), {"reported_late"}),
    "other positions at shared times": (
        shift("dt20_sub2", 1e-5, axis=0, first=5), {"equal_step_equal_states"}),
    "other turning at shared times": (shift("dt20_sub2", 1e-3, field="link_ang", first=5),
        {"equal_step_equal_states"}),
    "a cube that does not settle": (shift("baseline", 0.001, first=120), {"settles"}),
    "a cube that does not stop": (shift("low_on_030", 0.5, field="link_vel", axis=0, first=60),
        {"stops", "friction_orders", "near_coulomb"}),
    "a surface that changes the other cube": (
        shift("high_on_030", 0.01, axis=0, first=20), {"friction_orders"}),
    "a slide of another rule": (
        as_slide("low_on_050", spec.PUSHED, surface_friction=0.25, friction=0.25),
        {"friction_orders", "near_coulomb"}),
    "energy that leaks in flight": (shift("bounce_sub20", 0.002, first=10), {"level_in_flight"}),
    "no flight": (ball_at("bounce_sub20", 0.0), {"start", "level_in_flight", "energy_converges"}),
    "energy that does not converge": (with_kept(90.0), {"energy_converges"}),
    "no share kept": (with_kept(None), {"energy_converges"}),
    "no bounce": (ball_at("bounce_sub100", 0.1), {"energy_converges"}),
    "one picture twice": (lambda run: replace(
        run, frames=dict.fromkeys(run.frames, run.frames["initial"])), {"posture"}),
}  # fmt: skip


@pytest.mark.parametrize("name", FAILING)
def test_a_wrong_experiment_fails_its_checks(experiment, name):
    spoil, names = FAILING[name]
    assert set(failing(spoil(experiment))) == names


def test_the_exercise_fails_what_the_lecture_says(experiment):
    on_050 = {"low_on_030": experiment.traces["low_on_050"],
              "high_on_030": experiment.traces["high_on_050"]}  # fmt: skip
    surfaces = experiment.readings["surface_friction"] | dict.fromkeys(on_050, 0.5)
    spoilt = with_reading("surface_friction", surfaces)(experiment)
    spoilt = replace(spoilt, traces=experiment.traces | on_050)
    assert failing(spoilt) == ["settings", "friction_orders", "near_coulomb"]


# Sentences, tables and figures


def test_sentences_of_the_lab(experiment):
    found = "\n".join(block.markdown() for block in text.interpretation(experiment))
    assert "With two steps in 10 ms the cube rebounds. These runs cannot show whether that" in found
    assert "**Cube 0.1 on table 0.5.** Its distance corresponds to μ = 0.5" in found
    assert "For the cube with a friction of 0.8, the other table changes its distance by 0" in found
    assert "has 101.7 % of its energy after the first bounce, more than before" in found


def test_sentences_of_what_did_not_happen(experiment):
    flat = slide_metrics(slide_on_corners(spec.PUSHED), spec.PUSHED)
    assert "It stayed on the surface." in text.slide_sentence("x", flat, spec.PUSHED)
    going = slide_metrics(body_at([0.765] * 30, vz=0), spec.PUSHED)
    never = replace(going, stop_distance=None, stop_time=None)
    assert "did not stop in the window" in text.slide_sentence("x", never, spec.PUSHED)
    high = landing_metrics(body_at([1.0] * 5), spec.BASELINE)
    assert "did not reach the surface" in text.landing_sentence("x", high)
    lost = replace(experiment.metrics["bounce_sub1"], first_kept=None)
    assert "does not bounce" in text.bounce_sentence(lost, spec.BOUNCES["bounce_sub1"])


def test_figures_are_drawn_with_labelled_axes(experiment):
    ax = plots.heights(Figure().subplots(), experiment.traces, experiment.cases, (0.1, 0.5))
    assert ax.get_xlabel()
    assert ax.get_ylabel()
    four = Figure().subplots(4, 1)
    plots.counted(four, experiment.traces, (0.1, 0.5))
    heads = [ax.get_title(loc="left").partition(" (")[0] for ax in four]
    assert heads == [spec.LABELS[name] for name in spec.LANDINGS]
    three = Figure().subplots(3, 1)
    plots.slides(three, experiment.traces, spec.SLIDES, plots.SLIDE_MARKS, spec.LABELS)
    assert len(three[0].lines) == 5  # four cubes and the zero
    two = Figure().subplots(2, 1)
    plots.energies(two, experiment.traces, {n: spec.BOUNCES[n] for n in THREE})
    assert len(two[1].lines) == 3
    one = Figure().subplots()
    plots.stopping(one, {"low_on_050": None}, {"low_on_050": 0.4})
    assert len(one.patches) == 0  # a cube that did not stop has no bar
    plots.kept(Figure().subplots(), {0.01: 90.0, 0.001: None}, 94)
    plotting.body_schematic(Figure().subplots(), experiment.traces["baseline"], 0.08, contacts.TOP)


def test_readers_see_words_instead_of_names(experiment):
    shown = [text.conclusions(experiment), tables.landings(experiment), tables.slides(experiment)]
    shown += [tables.bounces(experiment), str(tables.landing_rows(spec.LANDINGS))]
    for figure in (plots.landings, plots.contact_counts, plots.pushed, plots.stopping_distances):
        drawn = figure(experiment)
        shown += [found.get_text() for found in drawn.findobj(Text)]
    names = [name for name in spec.CASES if any(name in part for part in shown)]
    assert names == []
    assert set(spec.CASES) <= set(spec.LABELS)


def test_measured_curves_are_solid(experiment):
    for figure in (plots.landings, plots.contact_counts, plots.pushed, plots.ball_energies):
        lines = [line for ax in figure(experiment).axes for line in ax.lines]
        assert {line.get_linestyle() for line in lines} == {"-"}


def test_a_number_keeps_its_unit_in_a_line():
    table = tables.markdown([{"h": "2.5 ms", "depth": "0.9 to 1.2 mm", "run": "one step in 10 ms"}])
    assert "| 2.5\u00a0ms | 0.9 to 1.2\u00a0mm | one step in 10\u00a0ms |" in table


def test_rows_say_how_many_steps():
    rows = tables.landing_rows(spec.LANDINGS)
    assert [row["solver steps"] for row in rows] == ["300", "150", "150", "75"]


@pytest.mark.parametrize(
    ("value", "unit", "text_of"),
    [
        (0.006431, "m", "6.43 mm"), (-2.5e-5, "m", "−0.025 mm"), (0.41040, "m", "0.4104 m"),
        (0.00123, "J", "1.23 mJ"), (0.22, "s", "0.22 s"), (None, "m", "not observed"),
    ],
)  # fmt: skip
def test_a_value_has_a_unit_of_its_size(value, unit, text_of):
    assert tables.readable(value, unit) == text_of
