"""Tables, figures and bundles of the lecture and the lab, with a camera and without."""

from dataclasses import replace

import pytest
from closed_views import PLANE, closed_view
from lessons.changed_runs import passed, reading

from robo_genesis.core.checks import evaluate
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.lessons.l05 import checks, plots, spec, text
from robo_genesis.lessons.l05.pages import LAB
from robo_genesis.sim.camera import record as view_record
from robo_genesis.sim.camera.checks import Marker
from robo_genesis.sim.camera.geometry import looking

SPHERE = Marker(13, spec.TARGET, spec.MARKER_RADIUS)


@pytest.fixture(scope="module", params=[True, False], ids=["camera", "RENDER=0"])
def run(request, reaches, frames):
    """The lab as a camera without errors sees it."""
    view = closed_view(
        SPHERE, spec.FOV, CAMERA_RES, looking(spec.VIEW["pos"], spec.VIEW["lookat"])
    )
    segments = {"plane": PLANE, "hand": 10, "marker": SPHERE.number}
    seen = {"view_world": view_record.numbers(view), "segments": segments}
    return replace(
        reaches,
        page=LAB,
        traces={name: reaches.traces[name] for name in spec.CASES},
        readings=reaches.readings | passed(LAB) | seen,
        frames=frames | view_record.frames("world", view) if request.param else {},
        rendered=request.param,
    )


def test_the_checks_hold_and_pictures_are_skipped_where_there_are_none(run):
    assert [check.detail for check in run.outcomes() if not check.passed] == []
    shown = text.marker_table(run), text.depth_table(run), text.conclusions(run)
    assert [text.NO_PICTURE in part for part in shown] == [not run.rendered] * 2 + [
        False
    ]
    assert ("The pixels of the marker are" in shown[2]) == run.rendered
    assert len(plots.picture(run).axes[0].images) == run.rendered
    assert plots.posture(run).axes


@pytest.mark.parametrize("run", [True], indirect=True)
@pytest.mark.parametrize("name", ["world", "hand"])
def test_the_ground_is_judged_in_each_view_of_the_page(run, name):
    pose = looking((0.5, 0.3, 0.6), (0.4, 0.0, 0.0))
    view = closed_view(SPHERE, spec.HAND_FOV, CAMERA_RES, pose)
    readings = {**run.readings, "view_hand": view_record.numbers(view)}
    frames = {**run.frames, **view_record.frames("hand", view)}
    both = replace(run, readings=readings, frames=frames)
    assert evaluate([checks.plane_surface], both)[0].passed
    height = readings[f"view_{name}"]["transform_23"] + 0.01  # 1 cm too high
    raised = reading(f"view_{name}", "transform_23", height)(both)
    (ground,) = evaluate([checks.plane_surface], raised)
    assert f"{name}.largest_m is 0.01" in ground.detail


def test_tables_and_figures_give_the_numbers_of_the_runs(run):
    base = run.metrics["baseline"]
    apart, angle = (
        f"{1000 * value:.3f}" for value in (base.final_distance, base.final_angle)
    )
    assert f"| {apart} | {angle} |" in text.error_table(run)
    assert f"| end to target [mm] | {apart} |" in text.metric_table(run)
    assert "is accepted" in text.conclusions(run)
    assert f"{plots.distance(run).axes[0].lines[0].get_ydata()[-1]:.3f}" == apart
