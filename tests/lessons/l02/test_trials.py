"""What the lecture tries on scenes that pretend: calls on both sides of build, counts, mistakes."""

import ast
from types import SimpleNamespace

import numpy as np
import pytest
from lessons.exercise_cells import page_of

from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l02 import life_cycle, mistakes, spec
from robo_genesis.lessons.l02.spec import AFTER, BEFORE


class GenesisException(Exception):  # noqa: N818 - the engine's name
    """An exception with the name of the engine's."""


class Pretended:
    """Scene, box and camera in one, which refuses the calls that the engine refuses."""

    def __init__(self):
        self.built = False

    def declare(self, *_, **options):
        if self.built:
            raise GenesisException("Scene is already built.\nAt all.")

    add_entity = add_camera = declare

    def build(self):
        self.declare()
        self.built = True

    def step(self, *_):
        if not self.built:
            raise GenesisException("Not built.\nAt all.")

    reset = get_pos = set_pos = render = step


@pytest.mark.parametrize("rendered", [True, False])
def test_every_call_is_tried_on_both_sides_and_belongs_to_one(rendered):
    scene = Pretended()
    attempts = life_cycle.try_both_sides(scene, scene, scene if rendered else None, "morph")
    assert life_cycle.counts(attempts) == life_cycle.expected(rendered)
    row = {"call": "`scene.step`", BEFORE: "GenesisException: Not built.", AFTER: "accepted"}
    assert row in life_cycle.rows(attempts)


CASE = spec.BASELINE
FALL = CASE.height - 4.905 * (np.arange(61) * CASE.dt) ** 2
LANDS = np.maximum(FALL, CASE.size / 2)


ALIKE = [(mistakes.fixed_body, FALL), (mistakes.no_collision, LANDS)]


@pytest.mark.parametrize(("mistake", "motion"), ALIKE)
def test_a_symptom_is_not_found_where_both_bodies_move_alike(monkeypatch, mistake, motion):
    def fake(scene, case, steps, **bodies):
        return np.arange(steps + 1) * case.dt, dict.fromkeys(bodies, motion[: steps + 1])

    monkeypatch.setattr(mistakes, "heights", fake)
    wrong, right = (SimpleNamespace(n_dofs=n, geoms=[], vgeoms=[]) for n in (0, 6))
    failure = mistake(None, wrong, right, CASE)
    assert not failure.shown
    words = {*" ".join([failure.evidence, *failure.curves]).split()}
    assert not {"fixed", "collision", "ghost"} & words  # the evidence does not name the mistake


@pytest.mark.parametrize("page", ["lecture", "lab"])
def test_the_camera_that_a_page_declares_is_that_of_the_specification(page):
    """The specification's view is a parameter of the bundle."""
    calls = [
        node.value
        for cell in page_of("l02", page).notebook.cells
        if cell.cell_type == "code"
        for node in ast.walk(ast.parse(cell.source))
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "camera"
    ]
    *_, call = [call for call in calls if isinstance(call, ast.Call)]
    given = {keyword.arg: ast.literal_eval(keyword.value) for keyword in call.keywords}
    assert given == {name: value for name, value in spec.VIEW.items() if name != "GUI"}


def test_the_work_sheet_has_the_titles_of_the_lab():
    sheet = (BOOK / "lessons" / "l02-life-cycle" / "worksheet.md").read_text().splitlines()
    titles = [line for line in sheet if line.startswith("## ")]
    lab = "\n".join(cell.source for cell in page_of("l02", "lab").notebook.cells).splitlines()
    assert len(titles) == 9
    assert {*titles} <= {*lab}
