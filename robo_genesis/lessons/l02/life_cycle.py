"""On which side of `scene.build()` a call belongs: each is tried on both, and what it said is kept.

The calls are a lesson's subject; a change of what an engine allows shows in the recorded counts.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from robo_genesis.core.checks import Check
from robo_genesis.core.metrics import count_records

GROUP = "life_cycle"
"""Of a bundle's metrics: 1 where a call went through, 0 where it was refused."""

BEFORE, AFTER = "before build", "after build"

REFUSAL = "GenesisException"
"""The engine's own exception, with which it refuses a call."""

RENDER = "camera.render"

BELONGS = {
    "scene.add_entity": BEFORE,
    "scene.add_camera": BEFORE,
    "scene.build": BEFORE,
    "scene.step": AFTER,
    "scene.reset": AFTER,
    "box.get_pos": AFTER,
    "box.set_pos": AFTER,
    RENDER: AFTER,
}
"""The side on which each call goes through; on the other one it must be refused."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One call, tried on one side; `refusal` is what the engine said, None if it went through."""

    call: str
    side: str
    refusal: str | None

    @property
    def name(self) -> str:
        """Its name among the counts of a bundle."""
        return f"{self.call} {self.side}"


def attempt(call: str, side: str, run: Callable[[], Any]) -> Attempt:
    """Call, and keep the engine's refusal, type and first line, if there is one.

    Any other exception is no refusal but a broken call, and goes on.
    """
    try:
        run()
    except Exception as error:
        if type(error).__name__ != REFUSAL:  # the engine is not imported here
            raise
        lines = str(error).strip().splitlines()
        return Attempt(call, side, f"{REFUSAL}: {lines[0] if lines else ''}")
    return Attempt(call, side, None)


def calls(scene: Any, box: Any, camera: Any, morph: Any) -> dict[str, Callable[[], Any]]:
    """Return what is tried, by name; `build` comes last, since it changes the side.

    Args:
        scene: one that may be spoilt.
        box: an entity of it.
        camera: of it, None where rendering is off; then rendering is not tried.
        morph: of one more entity.
    """
    tried: dict[str, Callable[[], Any]] = {
        "scene.add_entity": lambda: scene.add_entity(morph),
        "scene.add_camera": lambda: scene.add_camera(GUI=False),
        "scene.step": scene.step,
        "scene.reset": scene.reset,
        "box.get_pos": box.get_pos,
        "box.set_pos": lambda: box.set_pos((0.0, 0.0, 0.5)),
    }
    if camera is not None:
        tried[RENDER] = camera.render
    return tried | {"scene.build": scene.build}


def try_both_sides(scene: Any, box: Any, camera: Any, morph: Any) -> tuple[Attempt, ...]:
    """Try every call before `build` and after it.

    The arguments are those of `calls`; the scene is not built yet, and is spoilt afterwards.
    """
    tried = calls(scene, box, camera, morph)
    return tuple(
        attempt(call, side, run) for side in (BEFORE, AFTER) for call, run in tried.items()
    )


def rows(attempts: Iterable[Attempt]) -> list[dict[str, str]]:
    """Return a row for each call: what happened on either side."""
    found = {(a.call, a.side): a.refusal for a in attempts}
    return [
        {"call": f"`{call}`"}
        | {side: found[call, side] or "goes through" for side in (BEFORE, AFTER)}
        for call in dict.fromkeys(call for call, _ in found)
    ]


def names(rendered: bool) -> list[str]:
    """Return the name of every count of a bundle; without rendering no camera was tried."""
    tried = [call for call in BELONGS if rendered or call != RENDER]
    return [f"{call} {side}" for call in tried for side in (BEFORE, AFTER)]


def counts(attempts: Iterable[Attempt]) -> dict[str, int]:
    """Return 1 for each attempt that went through, 0 for each that was refused."""
    return {a.name: int(a.refusal is None) for a in attempts}


def records(went: Mapping[str, int]) -> dict[str, dict[str, dict[str, Any]]]:
    """Return the counts as a group of `metrics.json`."""
    return {GROUP: count_records(went)}


def check(went: Mapping[str, int], rendered: bool) -> Check:
    """Return the named check that each call went through on its side alone."""
    problems = [f"{name} was not tried" for name in names(rendered) if name not in went]
    problems += [
        f"{call} {'went through' if went[f'{call} {side}'] else 'was refused'} {side}"
        for call, belongs in BELONGS.items()
        for side in (BEFORE, AFTER)
        if f"{call} {side}" in went and bool(went[f"{call} {side}"]) != (side == belongs)
    ]
    held = "Each call goes through on its own side of build, and is refused on the other."
    return Check("sides_of_build", not problems, "; ".join(problems) or held)
