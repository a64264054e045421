"""Each named check passes for sound runs and fails for one spoiled run; the exercise's promise."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.body_runs import slide_on_corners
from lessons.changed_runs import (
    case,
    copied,
    failed,
    metric,
    put,
    reading,
    shift,
    trace,
)
from lessons.experiments import checks_of, each, run_with

from robo_genesis.lessons.l03 import spec, study, study_spec, text

REST = spec.BASELINE.rest_height


def moved(name, by, field="link_pos", axis=2, first=0, end=None):
    """Return a function that changes an array of one run along an axis from `first` until `end`."""
    return trace(name, **{field: shift((slice(first, end), 0, axis), by)})


def deeper(name):
    """Return a function that lets a cube sink in deeper, at its deepest sample."""
    return trace(
        name, link_pos=lambda at: shift((at[:, 0, 2].argmin(), 0, 2), -0.003)(at)
    )


def on_corners(name, **changes):
    """Return a function that lets a cube slide on four corners, with other settings."""
    return lambda run: replace(
        run,
        traces={
            **run.traces,
            name: slide_on_corners(replace(run.cases[name], **changes)),
        },
    )


def stops_alike(run):
    """Return the run with a cube that slides on four corners at each solver step."""
    for name in study.stops_of_lane(run, "high"):
        run = on_corners(name)(run)
    return run


def equal_tables(run):
    """Return the run after the change that the lab proposes."""
    for name in ("low_on_030", "high_on_030"):
        run = reading("surface_friction", name, 0.5)(run)
        run = copied(name, name.replace("030", "050"))(run)
    return run


def never_rebounding(run):
    for name in study_spec.STEP_CASES["h_5000us"]:
        height = run.traces[name].link_pos[:, 0, 2]
        landed = np.maximum.accumulate(height < REST)
        run = trace(
            name, link_pos=put((landed, 0, 2), np.minimum(height[landed], REST))
        )(run)
    return run


def one_pixel_changes(run):
    initial = run.frames["initial"]
    final = put((0, 0, 0), 9)(initial.copy())
    return replace(run, frames={**run.frames, "final": final})


SPOILERS = {
    "structure": [reading("model", "links", 2)],
    "mass": [reading("mass", "ball", None)],
    "settings": [reading("friction", "low_on_050", 0.45)],
    "stamps": [case("low_on_030", duration=2.01)],
    "one_factor": [case("bounce_sub4", spring=(1.0, 0.02))],
    "lands": [trace("baseline", contacts=np.zeros_like)],
    "reported_late": [trace("dt10_sub1", penetration=lambda a: np.roll(a, -1))],
    "equal_step_equal_states": [moved("dt20_sub2", 1e-5, axis=0, first=5)],
    "settles": [moved("baseline", -0.05, first=30)],
    "stops": [moved("low_on_030", 0.5, "link_vel", 0, first=60)],
    "friction_orders": [moved("high_on_030", 0.01, axis=0, first=20)],
    "near_coulomb": [moved("low_on_030", 0.5, "link_vel", 0, first=60)],
    "level_in_flight": [moved("bounce_sub20", 0.002, first=10)],
    "energy_converges": [metric("bounce_sub100", first_kept=90.0)],
    "posture": [one_pixel_changes],
    "time_constants": [reading(study.GROUP, "h_20000us", 0.01)],
    "rebound_goes": [
        moved("h_500us_10000", 0.002, first=-20, end=-19),
        never_rebounding,
    ],
    "scatter_shrinks": [deeper("h_125us_10000")],
    "depth_by_hand": [deeper("h_125us_10000")],
    "first_step_decides": [deeper("h_10000us_10000")],
    "clean_slides_stay_down": [trace("low_on_030_elliptic", contacts=put(5, 3))],
    "clean_slides_are_coulomb_s": [
        moved("high_on_030_elliptic", 0.001, axis=0, first=10)
    ],
    "clean_slides_order": [moved("high_on_030_elliptic", 0.001, axis=0, first=10)],
    "larger_friction_rules": [on_corners("low_on_050_elliptic", surface_friction=0.3)],
    "hop_follows_step": [
        moved("hop_2500us_low", 0.02, first=1),
        moved("hop_100us_high", 0.02, first=1),
        moved("hop_100us_low", -2.0, "link_vel", 0, end=1),
    ],
    "hop_follows_speed": [moved("hop_200mm_s", 0.002, first=1)],
    "default_cone_hops": [on_corners("high_on_050")],
    "stops_nearly_right": [moved("low_on_050", 0.05, axis=0, first=10)],
    "hop_is_paid_by_friction": [on_corners("high_on_050")],
    "the_cone_alone_hops": [copied("low_on_050_convex", "low_on_050_elliptic")],
    "finer_steps_contradict": [stops_alike],
    "one_stop_converges": [moved("stop_100us_low", 0.05, axis=0, first=10)],
    "engines_land_alike": [
        copied("mujoco_baseline", study_spec.OWN_DEFAULTS),
        moved("mujoco_baseline", 1e-3, axis=0),
        moved("mujoco_baseline", 1e-3, "link_quat"),
    ],
    "engines_hop_alike": [copied("low_on_050_convex", "low_on_050_elliptic")],
    "release_speed": [moved("release_5ms_10000", 0.2, "link_vel", 2, first=220)],
    "stiff_contacts_rebound": [moved("release_10ms_10000", 0.01, first=270)],
}


@pytest.mark.parametrize(("check", "spoil"), each(SPOILERS))
def test_a_spoiled_run_fails_its_check(experiments, check, spoil):
    assert failed(spoil(run_with(experiments, check))) == {check}


def test_each_check_has_a_spoiled_run_and_no_sound_run_fails(experiments):
    assert SPOILERS.keys() == checks_of(experiments)
    assert [failed(run) for run in experiments.values()] == [set()] * len(experiments)


def test_the_lab_says_what_its_runs_show_or_which_check_failed(experiments):
    run = experiments["lab"]
    assert failed(equal_tables(run)) == {"settings", "friction_orders", "near_coulomb"}
    said = text.conclusions(run)
    assert "Its depth is 7.80 mm with two steps of 5 ms" in said
    assert "The check" not in said
    never = text.conclusions(metric("bounce_sub100", first_kept=None)(run))
    found = "bounce_sub100.first_kept_percent is None"
    assert f"The check `energy_converges` failed: {found}" in never
