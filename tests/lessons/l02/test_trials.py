"""What the lecture tries on scenes that pretend: calls on both sides of build, and counts."""

import pytest

from robo_genesis.lessons.l02 import life_cycle
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
