"""What the lecture tries on scenes that pretend: calls on both sides of build, and counts."""

import ast

import pytest
from lessons.exercise_cells import page_of

from robo_genesis.core.project import BOOK
from robo_genesis.lessons.l02 import life_cycle, spec
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
    attempts = life_cycle.try_both_sides(
        scene, scene, scene if rendered else None, "morph"
    )
    assert life_cycle.counts(attempts) == life_cycle.expected(rendered)
    row = {
        "call": "`scene.step`",
        BEFORE: "GenesisException: Not built.",
        AFTER: "accepted",
    }
    assert row in life_cycle.rows(attempts)


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
    sheet = (
        (BOOK / "lessons" / "l02-life-cycle" / "worksheet.md").read_text().splitlines()
    )
    titles = [line for line in sheet if line.startswith("## ")]
    lab = "\n".join(
        cell.source for cell in page_of("l02", "lab").notebook.cells
    ).splitlines()
    assert len(titles) == 9
    assert {*titles} <= {*lab}
