"""The side of `scene.build()` on which each call belongs: every call is tried on both sides.

A change in what an engine accepts changes the recorded counts.
"""

from collections.abc import Callable, Mapping
from typing import Any

from robo_genesis.core.checks import Findings, equal
from robo_genesis.core.experiment import Experiment

from . import spec
from .spec import AFTER, BEFORE

# Group of a bundle's metrics: 1 where the engine accepted a call, 0 where it refused
# it.
GROUP = "life_cycle"

REFUSAL = "GenesisException"  # The exception with which the engine refuses a call

RENDER = "camera.render"  # The call that needs a camera

# By call and side: the engine's refusal, None if it accepted the call.
Attempts = Mapping[tuple[str, str], str | None]


def refusal(call: Callable[[], Any]) -> str | None:
    """Return type and first line of the engine's refusal, None if it accepts the call.

    Any other exception comes from a broken call and is raised.
    """
    try:
        call()
    except Exception as error:
        if type(error).__name__ != REFUSAL:  # the engine is not imported here
            raise
        first_line = str(error).strip().split("\n")[0]
        return f"{REFUSAL}: {first_line}"
    return None


def try_both_sides(scene: Any, box: Any, camera: Any, morph: Any) -> Attempts:
    """Try every call before `build` and after it.

    Args:
        scene: a scene that is not built yet; the calls spoil it.
        box: one of its entities.
        camera: one of its cameras, None where rendering is off; then rendering is not
            tried.
        morph: the morph of another entity.
    """
    tried = {
        "scene.add_entity": lambda: scene.add_entity(morph),
        "scene.add_camera": lambda: scene.add_camera(GUI=False),
        "scene.step": scene.step,
        "scene.reset": scene.reset,
        "entity.get_pos": box.get_pos,
        "entity.set_pos": lambda: box.set_pos((0.0, 0.0, 0.5)),
        **({} if camera is None else {RENDER: camera.render}),
        "scene.build": scene.build,  # the last, because it changes the side
    }
    return {
        (name, side): refusal(tried[name]) for side in (BEFORE, AFTER) for name in tried
    }


def rows(attempts: Attempts) -> list[dict[str, str]]:
    """Return one row per call: the outcome on each side."""
    return [
        {"call": f"`{call}`"}
        | {side: attempts[call, side] or "accepted" for side in (BEFORE, AFTER)}
        for call in dict.fromkeys(call for call, _ in attempts)
    ]


def expected(rendered: bool) -> dict[str, bool]:
    """Return by the name of each count whether the engine must accept the call.

    Without rendering no camera is tried.
    """
    return {
        f"{call} {side}": side == belongs
        for call, belongs in spec.BELONGS.items()
        if rendered or call != RENDER
        for side in (BEFORE, AFTER)
    }


def counts(attempts: Attempts) -> dict[str, int]:
    """Return 1 for each attempt that the engine accepted, 0 for each that it refused."""
    return {
        f"{call} {side}": int(found is None) for (call, side), found in attempts.items()
    }


def sides_of_build(run: Experiment) -> Findings:
    """The engine accepts each call on its own side of build and refuses it on the other."""
    for name, right in expected(run.rendered).items():
        yield equal(f"{name}, accepted", run.readings[GROUP].get(name), int(right))
