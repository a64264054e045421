"""The calls that a built or an unbuilt scene accepts: tried, counted, compared with the rule."""

from types import SimpleNamespace

import pytest

from robo_genesis.lessons.l02 import LECTURE, life_cycle
from robo_genesis.lessons.l02.spec import AFTER, BEFORE, BELONGS


class GenesisException(Exception):  # noqa: N818 - the engine's name
    """An exception with the name of the engine's."""


class World:
    """A scene with one box and one camera that refuses the calls that the engine refuses."""

    def __init__(self):
        self.built = False

    def _needs(self, built: bool):
        if self.built != built:
            raise GenesisException(
                "Scene is already built." if self.built else "Not built.\nAt all."
            )

    def add_entity(self, *_, **options):
        self._needs(False)

    add_camera = add_entity

    def build(self):
        self._needs(False)
        self.built = True

    def step(self, *_):
        self._needs(True)

    reset = get_pos = set_pos = render = step


def tried(rendered=True):
    world = World()
    return life_cycle.try_both_sides(world, world, world if rendered else None, "morph")


def problems(counts, rendered):
    run = SimpleNamespace(readings={life_cycle.GROUP: counts}, rendered=rendered)
    return [f.problem for f in life_cycle.sides_of_build(run) if not f.passed]


def test_every_call_is_tried_on_both_sides_and_belongs_to_one():
    counts = life_cycle.counts(tried())
    assert counts == life_cycle.expected(rendered=True)
    assert sum(counts.values()) == len(BELONGS)
    assert problems(counts, rendered=True) == []
    declared = LECTURE.readings(True)[life_cycle.GROUP]
    assert declared.kind == "exact"
    assert declared.units.keys() == counts.keys()


def test_without_rendering_no_camera_is_tried():
    counts = life_cycle.counts(tried(rendered=False))
    assert not [name for name in counts if name.startswith("camera.render")]
    assert problems(counts, rendered=False) == []
    assert "camera.render before build, accepted is not observed, expected False" in problems(
        counts, rendered=True
    )


def test_a_refusal_is_kept_with_type_and_first_line():
    assert tried()["scene.step", BEFORE] == "GenesisException: Not built."
    with pytest.raises(AttributeError, match="no_such_call"):  # a broken call is not a refusal
        life_cycle.refusal(lambda: World().no_such_call())


def test_the_table_has_a_row_for_each_call():
    rows = {row["call"]: row for row in life_cycle.rows(tried())}
    assert set(rows) == {f"`{call}`" for call in BELONGS}
    assert rows["`scene.add_entity`"][BEFORE] == "accepted"
    assert rows["`scene.add_entity`"][AFTER] == "GenesisException: Scene is already built."


@pytest.mark.parametrize("name", life_cycle.expected(rendered=True))
def test_a_call_that_moved_to_the_other_side_is_named(name):
    counts = life_cycle.counts(tried())
    found = problems(counts | {name: 1 - counts[name]}, rendered=True)
    was = bool(counts[name])
    assert found == [f"{name}, accepted is {not was}, expected {was}"]
