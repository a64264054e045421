"""The lecture's trials: geometry that is seen or felt, balls in trays, falls after build."""

import ast
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.body_runs import make_drop
from lessons.l02.readings import COUNTS, TRIALS

from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l02 import LECTURE, plots, spec, text, trials
from robo_genesis.pipeline.pages.book import find_pages


def geom(faces):
    return SimpleNamespace(get_trimesh=lambda: SimpleNamespace(faces=np.zeros((faces, 3))))


def entity(seen, felt, pieces):
    """An entity with one drawn mesh, and collision triangles in several geoms."""
    return SimpleNamespace(
        morph=object(), vgeoms=[geom(seen)], n_dofs=6, n_qs=7, get_mass=lambda: 0.5,
        geoms=[geom(felt // pieces)] * (pieces - 1) + [geom(felt - felt // pieces * (pieces - 1))],
    )  # fmt: skip


ENTITIES = {name: entity(*values) for name, values in COUNTS.items()}


def test_triangles_and_pieces_are_counted_for_each_entity():
    assert trials.count_shapes(ENTITIES) == TRIALS[trials.SHAPES]
    row = trials.shape_rows(ENTITIES)[2]
    assert (row["visual triangles"], row["collision triangles"]) == (260, 344)
    assert (row["entity"], row["collision geoms"], row["qpos"]) == ("tray", 5, 7)


def run_with(group=None, name=None, value=None, frames=(spec.TRAYS,), rendered=True):
    readings = {key: dict(values) for key, values in TRIALS.items()}
    if group:
        readings[group][name] = value
    picture = np.zeros((540, 720, 3), np.uint8)
    picture[0, 0] = 1
    return SimpleNamespace(
        readings=readings, frames=dict.fromkeys(frames, picture), rendered=rendered
    )


def failing(run):
    return {f.label for check in trials.CHECKS for f in check(run) if not f.passed}


def test_sound_trials_pass_with_a_camera_and_without():
    assert failing(run_with()) == set()
    assert failing(run_with(frames=(), rendered=False)) == set()


@pytest.mark.parametrize(
    ("group", "name", "value", "label"),
    [
        ("shapes", "box_felt", 10, "box_felt"),
        ("shapes", "duck_felt", 3534, "duck_felt"),
        ("shapes", "tray_pieces", 1, "tray_pieces"),
        ("shapes", "hammer_pieces", 1, "hammer_pieces"),
        ("trays", "pieces", 0.1749, "ball_in_pieces_m"),
        ("trays", "hull", 0.0308, "ball_on_the_hull_m"),
        ("further", "higher", 0.2, "higher_m"),
        ("further", "thrown", 0.0, "thrown_m"),
        ("further", "heavier", 0.21, "heavier_m"),
        ("further", "moon", 0.0324, "moon_m"),
    ],
)
def test_another_measurement_is_named(group, name, value, label):
    assert failing(run_with(group, name, value)) == {label}


def test_the_falls_are_those_of_the_stepped_formula():
    # g h² n (n + 1) / 2 with n = 40 and h = 5 ms; thrown: less 1 m/s · 0.2 s
    expected = {"higher": 0.201105, "thrown": 0.001105, "heavier": 0.201105, "moon": 0.03321}
    assert trials.expected_falls() == pytest.approx(expected, abs=1e-9)
    assert "| on the Moon, g = 1.62 m/s² | 0.033210 | 0.033210 |" in text.falls_table(run_with())


def test_a_loop_that_differs_from_the_record_is_named():
    trace = make_drop(spec.BASELINE)
    heights = [float(z) for z in trace.link_pos[:, 0, 2]]
    assert trials.same_heights(heights, trace).passed
    assert "states is 20, expected 21" in trials.same_heights(heights[1:], trace).detail
    heights[7] += 1e-4
    assert "largest_difference_m" in trials.same_heights(heights, trace).detail


def test_the_trays_are_shown_as_a_picture_or_as_heights():
    (picture,) = plots.trays(run_with()).axes
    assert picture.get_images()
    (heights,) = plots.trays(run_with(rendered=False)).axes
    assert [bar.get_height() for bar in heights.patches] == [0.0308, 0.1749]


PAGES = {page.page: page for page in find_pages(BOOK) if page.lesson == "l02"}


@pytest.mark.parametrize(("page", "camera"), [("lecture", "camera"), ("lab", "camera")])
def test_the_camera_that_a_page_declares_in_sight_is_that_of_the_specification(page, camera):
    """The specification's view is a parameter of the bundle."""
    calls = [
        node.value
        for cell in PAGES[page].notebook.cells
        if cell.cell_type == "code"
        for node in ast.walk(ast.parse(cell.source))
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == camera
    ]
    *_, call = [call for call in calls if isinstance(call, ast.Call)]
    given = {keyword.arg: ast.literal_eval(keyword.value) for keyword in call.keywords}
    assert given == {name: value for name, value in spec.VIEW.items() if name != "GUI"}


def test_the_lecture_alone_has_the_frame_of_the_trays():
    assert LECTURE.frames == ("initial", "final", spec.TRAYS)
    assert replace(LECTURE, frames=("initial", "final")) != LECTURE


def test_the_work_sheet_has_the_numbers_and_titles_of_the_lab():
    sheet = (BOOK / "lessons" / "l02-life-cycle" / "worksheet.md").read_text()
    titles = [line for line in sheet.splitlines() if line.startswith("## ")]
    lab = "\n".join(cell.source for cell in PAGES["lab"].notebook.cells)
    assert len(titles) == 9
    assert [title for title in titles if title not in lab.splitlines()] == []
