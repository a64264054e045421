"""Each named check passes for sound runs and fails for one spoiled run; the exercise's promise."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import body_at, slide_on_corners
from lessons.changed_runs import case, copied, failed, frames, put, reading, shift, trace

from robo_genesis.lessons.l03 import spec, study, study_spec, text
from robo_genesis.lessons.l03.metrics import case_metrics

REST = spec.BASELINE.rest_height


def moved(name, by, field="link_pos", axis=2, first=0, end=None):
    """Return a function that changes an array of one run along an axis from `first` until `end`."""
    return trace(name, **{field: shift((slice(first, end), 0, axis), by)})


def on_corners(*names, **changes):
    """Return a function that lets cubes slide on four corners, with other settings."""

    def spoil(run):
        slides = {n: slide_on_corners(replace(run.cases[n], **changes)) for n in names}
        return replace(run, traces=run.traces | slides)

    return spoil


def with_kept(share):
    """Return a function that gives the ball with the finest step another share of its energy."""

    def measure(trace, case):
        found = case_metrics(trace, case)
        finest = case == spec.BOUNCES["bounce_sub100"]
        return replace(found, first_kept=share) if finest else found

    return lambda run: replace(run, page=replace(run.page, measure=measure))


def deeper(position):
    position[position[:, 0, 2].argmin(), 0, 2] -= 0.003
    return position


def equal_tables(run):
    """Return the run after the change that the lab proposes; its answer names what fails."""
    for name in ("low_on_030", "high_on_030"):
        run = reading("surface_friction", name, 0.5)(run)
        run = copied(name, name.replace("030", "050"))(run)
    return run


def never_rebounding(run):
    for name in study_spec.STEP_CASES["h_5000us"]:
        height = run.traces[name].link_pos[:, 0, 2]
        landed = np.maximum.accumulate(height < REST)
        stays = np.minimum(height[landed], REST)
        run = trace(name, link_pos=put((landed, 0, 2), stays))(run)
    return run


STILL = body_at([spec.DROPPED_BALL.rest_height] * 201)
FAILING = {
    "lab": {
        "one more link": (reading("model", "links", 2), {"structure"}),
        "no mass": (reading("mass", "ball", None), {"mass"}),
        "another friction": (reading("friction", "low_on_050", 0.45), {"settings"}),
        "settings that were not read": (
            lambda run: replace(run, readings=run.readings | {"substeps": {}}), {"settings"}),
        "a missing step": (case("low_on_030", duration=2.01), {"stamps", "one_factor"}),
        "a second factor": (case("bounce_sub4", spring=(1.0, 0.02)), {"one_factor"}),
        "a cube that hovers": (trace("baseline", contacts=np.zeros_like), {"lands"}),
        "a cube that falls through": (moved("baseline", -0.05, first=30), {"lands", "settles"}),
        "depths of the same state": (
            trace("dt10_sub1", penetration=lambda a: np.roll(a, -1)), {"reported_late"}),
        "other positions at shared times": (
            moved("dt20_sub2", 1e-5, axis=0, first=5), {"equal_step_equal_states"}),
        "a cube that does not stop": (
            moved("low_on_030", 0.5, "link_vel", 0, first=60),
            {"stops", "friction_orders", "near_coulomb"}),
        "a table that changes the other cube": (
            moved("high_on_030", 0.01, axis=0, first=20), {"friction_orders"}),
        "energy that leaks in flight": (
            moved("bounce_sub20", 0.002, first=10), {"level_in_flight"}),
        "no flight": (
            lambda run: replace(run, traces=run.traces | {"bounce_sub20": STILL}),
            {"level_in_flight", "energy_converges"}),
        "energy that does not converge": (with_kept(90.0), {"energy_converges"}),
        "no share kept": (with_kept(None), {"energy_converges"}),
        "one picture twice": (frames(initial="initial", final="initial"), {"posture"}),
        "equal tables": (equal_tables, {"settings", "friction_orders", "near_coulomb"}),
    },
    "lecture": {
        "another time constant": (
            reading(study.GROUP, "h_20000us", 0.01), {"time_constants"}),
        "a record of each step that moves otherwise": (
            moved(study_spec.AS_BASELINE, 1e-5, first=20, end=40), {"records_each_step"}),
        "a rebound that stays with smaller steps": (
            trace("h_500us_10000", link_pos=put((-20, 0, 2), REST + 0.002)), {"rebound_goes"}),
        "no rebound at all": (never_rebounding, {"records_each_step", "rebound_goes"}),
        "a depth that depends on the start at fine steps": (
            trace("h_125us_10000", link_pos=deeper), {"scatter_shrinks", "depth_by_hand"}),
        "a first step in the table that is not the deepest": (
            trace("h_10000us_10000", link_pos=deeper), {"first_step_decides"}),
        "a clean slide that hops": (
            moved("low_on_030_elliptic", 0.001, first=10, end=12), {"clean_slides_stay_down"}),
        "a clean slide on three corners": (
            trace("low_on_030_elliptic", contacts=put(5, 3)), {"clean_slides_stay_down"}),
        "a clean slide that stops elsewhere": (
            moved("high_on_030_elliptic", 0.001, axis=0, first=10),
            {"clean_slides_are_coulomb_s", "clean_slides_order"}),
        "another rule of friction": (
            on_corners("low_on_050_elliptic", friction=0.3, surface_friction=0.3),
            {"clean_slides_are_coulomb_s", "clean_slides_order", "larger_friction_rules"}),
        "a hop that a finer step does not reduce": (
            moved("hop_2500us_low", 0.02, first=1), {"hop_follows_step"}),
        "a hop that stays at the finest step": (
            moved("hop_100us_high", 0.02, first=1), {"hop_follows_step"}),
        "a slow push that hops": (moved("hop_200mm_s", 0.002, first=1), {"hop_follows_speed"}),
    },
    "contact": {
        "a pushed cube that stays down": (
            on_corners("high_on_050"),
            {"default_cone_hops", "hop_is_paid_by_friction", "half_the_step_contradicts",
             "engines_hop_alike"}),
        "a blow that friction does not explain": (
            moved("low_on_050", -0.1, "link_vel", 0, first=1, end=2), {"hop_is_paid_by_friction"}),
        "a stop far from Coulomb's": (
            moved("low_on_050", 0.05, axis=0, first=10), {"stops_nearly_right"}),
        "a round cone that stays down": (
            copied("low_on_050_convex", "low_on_050_elliptic"),
            {"the_cone_alone_hops", "engines_hop_alike"}),
        "a stop that does not converge": (
            moved("stop_100us_low", 0.05, axis=0, first=10), {"one_stop_converges"}),
        "engines that land apart": (
            copied("mujoco_baseline", study_spec.OWN_DEFAULTS), {"engines_land_alike"}),
    },
    "energy": {
        "a release that is too fast": (
            moved("release_5ms_10000", 0.2, "link_vel", 2, first=220), {"release_speed"}),
        "a soft contact that rebounds": (
            moved("release_10ms_10000", 0.01, first=270), {"stiff_contacts_rebound"}),
    },
}  # fmt: skip


@pytest.mark.parametrize(("page", "name"), [(p, name) for p, of in FAILING.items() for name in of])
def test_a_wrong_run_fails_its_checks(experiments, page, name):
    spoil, names = FAILING[page][name]
    assert failed(spoil(experiments[page])) == names


def test_the_lab_says_what_its_runs_show_or_which_check_failed(experiments):
    said = text.conclusions(experiments["lab"])
    assert "Its depth is 7.80 mm with two steps of 5 ms" in said
    assert "The check" not in said
    never = with_kept(None)(experiments["lab"])
    assert "The check `energy_converges` failed: bounce_sub100.first_kept_percent is not obs" in (
        text.conclusions(never)
    )
