"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

import pytest
from lessons.exercise_cells import undetected
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l03 import exercises, spec


def scene_with(fixed=True, rho=500, friction=0.5, table=0.7, **settings):
    """Return a function that makes the scene, with mistakes."""

    def make(gs):
        surface = FakeBody(0.0, table, fixed=fixed, friction=0.8)
        resting = spec.BASELINE.rest_height - 1e-4
        cube = FakeBody(rho * 0.08**3, 1.0, resting, friction=friction)
        return FakeScene(surface, cube, **settings), surface, cube

    return make


SCENES = {
    "right": scene_with(),  # ours runs in the engine, when its page is executed
    "one substep": scene_with(substeps=1),
    "a table that falls": scene_with(fixed=False),
    "the default density": scene_with(rho=200),
    "the friction of the table": scene_with(friction=0.8),
    "a table at half height": scene_with(table=0.725),
}


@pytest.mark.parametrize("how", SCENES)
def test_only_the_right_scene_passes(how):
    check = exercises.scene(SCENES[how], None, spec.BASELINE)
    assert check.passed == (how == "right"), check.detail


SET = "cube.set_dofs_velocity([speed, 0, 0, 0, 0, 0])"
MISTAKES = {  # by function, what is replaced in our solution, and what replaces it
    "push": {
        f"scene.step()\n    {SET}": [f"{SET}\n        scene.step()"],
        "round(settle / scene.dt)": ["round(1000 * settle)"],
        "[speed, 0, 0, 0, 0, 0]": ["[speed] * 6"],
    },
    "landing": {
        "max(0.0, -clear.min())": ["clear.min()"],
        "clear[touched[0] + 1:] if touched.size else clear[:0]": ["clear"],
        "touched[0]": ["clear.argmin()"],
    },
    "stop": {
        "slow[k : k + hold + 1].all()": ["slow[k]"],
        "np.abs(speed)": ["speed"],
        "return None, None": ["return t[-1], x[-1] - x[0]"],
    },
}


@pytest.mark.parametrize("name", MISTAKES)
def test_each_mistake_is_found(experiments, name):
    run = experiments["lab"]
    scene, _, cube = scene_with()(None)
    landings = [(run.traces[n], c, run.metrics[n]) for n, c in spec.LANDINGS.items()]
    slides = [(run.traces[n], run.metrics[n]) for n in spec.SLIDES]
    test, *given = {
        "push": (exercises.push, scene, cube, spec.PUSHED),
        "landing": (exercises.landing, landings),
        "stop": (exercises.stopping, slides),
    }[name]
    assert undetected(test, MISTAKES[name], "l03", name, *given) == []
