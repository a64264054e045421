"""Which calls went through on which side of build: kept, counted, held to where they belong."""

import pytest

from robo_genesis.lessons.l02 import life_cycle
from robo_genesis.lessons.l02.life_cycle import AFTER, BEFORE, BELONGS


class GenesisException(Exception):  # noqa: N818 - the engine's name
    """As the engine's."""


class World:
    """A scene with one box and one camera that refuses what the engine refuses."""

    def __init__(self):
        self.built = False

    def _needs(self, built: bool):
        if self.built != built:
            said = "Scene is already built." if self.built else "Not built.\nAt all."
            raise GenesisException(said)

    def add_entity(self, morph):
        self._needs(False)

    def add_camera(self, **options):
        self._needs(False)

    def build(self):
        self._needs(False)
        self.built = True

    def step(self):
        self._needs(True)

    reset = get_pos = render = step

    def set_pos(self, pos):
        self._needs(True)


def tried(rendered=True):
    world = World()
    return life_cycle.try_both_sides(world, world, world if rendered else None, "morph")


def test_every_call_is_tried_on_both_sides_and_belongs_to_one():
    counts = life_cycle.counts(tried())
    assert set(counts) == set(life_cycle.names(rendered=True))
    assert sum(counts.values()) == len(BELONGS)
    assert life_cycle.check(counts, rendered=True).passed


def test_without_rendering_no_camera_is_tried():
    counts = life_cycle.counts(tried(rendered=False))
    assert not [name for name in counts if name.startswith("camera.render")]
    assert life_cycle.check(counts, rendered=False).passed
    failed = life_cycle.check(counts, rendered=True)
    assert not failed.passed
    assert "camera.render before build was not tried" in failed.detail


def test_a_refusal_is_kept_with_type_and_first_line():
    (step,) = [a for a in tried() if (a.call, a.side) == ("scene.step", BEFORE)]
    assert step.refusal == "GenesisException: Not built."


def test_a_call_that_is_broken_is_no_refusal():
    with pytest.raises(AttributeError, match="no_such_call"):
        life_cycle.attempt("call", BEFORE, lambda: World().no_such_call())


def test_the_table_has_a_row_for_each_call():
    rows = {row["call"]: row for row in life_cycle.rows(tried())}
    assert set(rows) == {f"`{call}`" for call in BELONGS}
    assert rows["`scene.add_entity`"][BEFORE] == "goes through"
    assert rows["`scene.add_entity`"][AFTER] == "GenesisException: Scene is already built."


@pytest.mark.parametrize("call", BELONGS)
@pytest.mark.parametrize("side", [BEFORE, AFTER])
def test_a_call_that_moved_to_the_other_side_is_named(call, side):
    counts = life_cycle.counts(tried())
    name = f"{call} {side}"
    outcome = life_cycle.check(counts | {name: 1 - counts[name]}, rendered=True)
    assert not outcome.passed
    assert outcome.detail == f"{call} {'was refused' if counts[name] else 'went through'} {side}"


def test_counts_are_metrics_of_the_bundle():
    counts = life_cycle.counts(tried())
    group = life_cycle.records(counts)[life_cycle.GROUP]
    assert {name: of["value"] for name, of in group.items()} == counts
    assert {of["class"] for of in group.values()} == {"exact"}
