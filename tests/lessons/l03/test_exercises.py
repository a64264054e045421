"""The tests of the student's functions: right ones pass, and typical wrong ones fail."""

import numpy as np
import pytest
from lessons.exercise_cells import solutions
from lessons.fake_scenes import FakeBody, FakeScene

from robo_genesis.lessons.l03 import exercises, spec

SOLVED = solutions("l03")


def scene_with(fixed=True, rho=500, friction=0.5, table=0.7, **settings):
    """Return a function that makes the scene, with mistakes."""

    def make(gs):
        surface = FakeBody(0.0, table, fixed=fixed, friction=0.8)
        resting = spec.BASELINE.rest_height - 1e-4
        cube = FakeBody(rho * 0.08**3, 1.0, resting, friction=friction)
        return FakeScene(surface, cube, **settings), surface, cube

    return make


def pushed(velocity, settle=lambda seconds: round(seconds / 0.01)):
    """Return a function that settles for a number of steps and sets a velocity."""

    def push(scene, cube, speed, seconds):
        for _ in range(settle(seconds)):
            scene.step()
        cube.set_dofs_velocity([speed * share for share in velocity])

    return push


def push_first(scene, cube, speed, settle):
    cube.set_dofs_velocity([speed, 0, 0, 0, 0, 0])
    for _ in range(30):
        scene.step()


def first_slow(t, x, speed):
    k = int(np.flatnonzero(np.abs(speed) < 0.01)[0])
    return t[k], x[k] - x[0]


def end_for_none(t, x, speed):
    found = SOLVED["stop"](t, x, speed)
    return (t[-1], x[-1] - x[0]) if found[0] is None else found


ALONG_X = (1, 0, 0, 0, 0, 0)
CASES = {
    "scene": {
        "right": scene_with(),  # ours runs in the engine, when its page is executed
        "one substep": scene_with(substeps=1),
        "a table that falls": scene_with(fixed=False),
        "the default density": scene_with(rho=200),
        "the friction of the table": scene_with(friction=0.8),
        "a table at half height": scene_with(table=0.725),
    },
    "push": {
        "right": SOLVED["push"],
        "before it settles": push_first,
        "settled in milliseconds": pushed(
            ALONG_X, lambda seconds: round(1000 * seconds)
        ),
        "all DOFs": pushed((1,) * 6),
    },
    "landing": {
        "right": SOLVED["landing"],
        "the sign of the depth": lambda clear: (
            clear.min(),
            SOLVED["landing"](clear)[1],
        ),
        "the start as rebound": lambda clear: (
            SOLVED["landing"](clear)[0],
            clear.max(),
        ),
        "after the deepest sample": lambda clear: (
            SOLVED["landing"](clear)[0],
            max(0.0, clear[clear.argmin() + 1 :].max(initial=0.0)),
        ),
    },
    "stopping": {
        "right": SOLVED["stop"],
        "the first slow sample": first_slow,
        "speed with its sign": lambda t, x, speed: SOLVED["stop"](
            t, x, np.maximum(speed, 0)
        ),
        "end of the window for not observed": end_for_none,
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_the_right_solution_passes(experiments, name, how):
    run = experiments["lab"]
    scene, _, cube = scene_with()(None)
    landings = [(run.traces[n], c, run.metrics[n]) for n, c in spec.LANDINGS.items()]
    more = {
        "scene": (None, spec.BASELINE),
        "push": (scene, cube, spec.PUSHED),
        "landing": (landings,),
        "stopping": ([(run.traces[n], run.metrics[n]) for n in spec.SLIDES],),
    }
    check = getattr(exercises, name)(CASES[name][how], *more[name])
    assert check.passed == (how == "right"), check.detail
