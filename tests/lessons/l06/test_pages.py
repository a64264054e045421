"""Tables, figures and bundles of the lecture, with a camera and without; the lab's functions."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import shift, trace

from robo_genesis.core.palette import MARKS
from robo_genesis.lessons.l06 import explorer, plots, spec, study, text
from robo_genesis.lessons.l06.pages import LECTURE, target_parts
from robo_genesis.sim.arm.kinematics import HAND


@pytest.fixture(scope="module", params=[True, False], ids=["camera", "RENDER=0"])
def run(request, worlds, frames):
    """The lecture."""
    pictures = frames if request.param else {}
    return replace(worlds, page=LECTURE, frames=pictures, rendered=request.param)


def test_the_checks_hold_and_a_schematic_replaces_frames(run):
    assert [check.detail for check in run.outcomes() if not check.passed] == []
    assert len(plots.posture(run).axes) == (2 if run.rendered else 1)


def test_tables_give_the_numbers_of_the_runs(run):
    m = run.metrics
    last = [f"{1000 * m[name].final_distance:.2f}" for name in spec.WORLDS]
    rows = text.row_table(run).splitlines()[2:]
    assert all(value in row for value, row in zip(last, rows, strict=True))
    assert text.mixed_table(run).count("**refused**") == 1
    equality = [
        line.split("|")[2:-1] for line in text.equality_table(run).splitlines()[2:]
    ]
    *same, alone = equality[: len(study.pairs())]
    assert {float(row[1]) for row in same} == {0}
    assert alone[2].strip() == "0.238 µrad"  # what the fixture adds
    assert [of[2].strip() for of in equality[-4:]] == [
        "0 µrad",
        "1,000 µrad",
        "0 µrad",
        "1.00 rad",
    ]
    assert f"{1000 * m['loaded_robot'].final_distance:.2f} |" in text.variant_table(run)
    assert f"| {1000 * m['stiff_robot'].overshoot:.0f} / " in text.sweep_table(run)


def test_the_map_has_the_sweep_and_opens_at_the_plain_robot(run):
    maps = explorer.explored(run)["maps"]
    cells = [cell for one in maps for row in one["rows"] for cell in row["cells"]]
    (opened,) = (cell for cell in cells if cell["opens"])
    m = run.metrics["plain_robot"]
    assert len(cells) == len(spec.SWEEP) == 256
    assert opened["numbers"] == pytest.approx(
        [1000 * m.final_distance, 1000 * m.overshoot]
    )
    assert opened["sentence"].startswith("KP × 1, KV × 1: passes")


def test_the_conclusions_follow_the_runs(run):
    said = text.conclusions(run)
    assert "Rows 0, 1 and 3 are accepted" in said
    named = min(run.metrics[f"env_{k}"].moved_later for k in (1, 3))
    assert f"moved by {1000 * named:.2f} mm or more, the others by at most 0 µm" in said
    moved = trace("env_0", link_pos=shift((slice(300, None), HAND, 0), 2e-6))(run)
    assert "the others by at most 2 µm" in text.conclusions(moved)


def test_the_replay_has_a_sphere_at_each_target_in_the_colour_of_its_run():
    parts = target_parts()
    assert len(parts) == 4
    centre = parts[1].vertices.mean(axis=0)
    assert centre == pytest.approx(
        spec.TARGETS[0] + np.array([*spec.PLACES[1], 0]), abs=1e-6
    )
    assert parts[1].rgb == tuple(bytes.fromhex(MARKS["first"].light[1:]))
