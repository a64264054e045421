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
        (
            {"get_links_pos": lambda: [[0, 0, 0.4]]},
            r"a height of 0\.4 m.*asks for 0\.5 m, at rest",
        ),
        (
            {"get_links_vel": lambda: [[0, 0, 1.5]]},
            r"with velocity \[0\.0, 0\.0, 1\.5\] m/s",
        ),
    ],
)
def test_a_scene_that_was_not_made_ready_for_the_case_is_refused(found, message):
    ready = {"dt": 0.01, "substeps": 2, "is_built": True, "reset": lambda: None}
    ready |= {
        f"get_links_{name}": lambda: [[0, 0, 0]] for name in ("quat", "vel", "ang")
    }
    scene = SimpleNamespace(**ready | {"get_links_pos": lambda: [[0, 0, 0.5]]} | found)
    with pytest.raises(CaseError, match=message):
        run_drop(scene, scene, spec.BASELINE)
