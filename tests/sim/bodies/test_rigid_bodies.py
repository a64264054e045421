"""A scene is dropped only if it is ready for its case."""

from types import SimpleNamespace

import pytest

from robo_genesis.lessons.l02 import spec
from robo_genesis.sim.bodies.rigid_bodies import run_drop
from robo_genesis.sim.session import CaseError


@pytest.mark.parametrize(
    ("found", "message"),
    [
        (
            {"substeps": 4},
            r"built with dt=0.01, substeps=4.*asks for dt=0.01, substeps=2",
        ),
        ({"is_built": False}, r"call scene\.build\(\)"),
    ],
)
def test_a_scene_that_was_not_made_ready_for_the_case_is_refused(found, message):
    ready = {"dt": 0.01, "substeps": 2, "is_built": True, "reset": lambda: None}
    scene = SimpleNamespace(**ready | found)
    with pytest.raises(CaseError, match=message):
        run_drop(scene, scene, spec.BASELINE)
