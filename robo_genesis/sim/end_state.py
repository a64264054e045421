"""Evidence of the first and last state of a run: camera frames or a schematic of its links."""

from collections.abc import Iterator, Mapping

import numpy as np

from robo_genesis.core.checks import Finding, above, equal
from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.camera.frames import FrameError, require_frame


def findings(
    rendered: bool, frames: Mapping[str, np.ndarray], links: FloatArray
) -> Iterator[Finding]:
    """Require two different camera frames, or links that moved where there is no camera.

    Args:
        rendered: whether camera frames show both states; else a schematic of the links does.
        frames: the camera's pictures by name.
        links: (n+1, l, 3) link positions of the run [m], which a schematic draws.
    """
    expected = ["final", "initial"] if rendered else []
    yield equal("frames", sorted(frames), expected)
    if not rendered:
        yield above("moved_m", float(np.abs(links[-1] - links[0]).max()), 0)
    elif sorted(frames) == expected:
        usable = [usable_frame(name, frames[name]) for name in expected]
        yield from usable
        if all(finding.passed for finding in usable):
            red, green, blue = np.moveaxis(frames["initial"] != frames["final"], -1, 0)
            yield above("changed_pixels", int((red | green | blue).sum()), 0)


def usable_frame(name: str, frame: np.ndarray) -> Finding:
    """Require a camera frame that is not empty."""
    try:
        require_frame(frame)
    except FrameError as error:
        return Finding(f"{name}.usable", False, False, f"True. {error}")
    return Finding(f"{name}.usable", True, True, "True")
