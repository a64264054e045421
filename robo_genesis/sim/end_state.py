"""Evidence of the first and last state of a run: camera frames or a schematic of its links."""

from collections.abc import Mapping

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.camera import FrameError, require_frame


def problems(rendered: bool, frames: Mapping[str, np.ndarray], links: FloatArray) -> list[str]:
    """Return the problems of the evidence of the first and last state, none if it is valid.

    Args:
        rendered: whether camera frames show both states; else a schematic of the links does.
        frames: the camera's pictures by name.
        links: (n+1, l, 3) link positions of the run [m], which a schematic draws.
    """
    if not rendered:
        found = ["a schematic must not come with camera frames"] if frames else []
        return found + (["no link moved"] if (links[0] == links[-1]).all() else [])
    if set(frames) != {"initial", "final"}:
        return [f"camera frames are {sorted(frames)}, expected initial and final"]
    try:
        for frame in frames.values():
            require_frame(frame)
    except FrameError as error:
        return [str(error)]
    same = (frames["initial"] == frames["final"]).all()
    return ["initial and final frame are the same picture"] if same else []
