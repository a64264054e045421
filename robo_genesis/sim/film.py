"""Camera frames of chosen samples, taken during a run."""

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from robo_genesis.sim import session

QUALITY = 70
"""JPEG quality: high enough that no blocks are visible at the printed size."""

VIEW = (slice(140, 420), slice(270, 550))
"""Rows and columns of a frame that show the robot [pixel]."""


class Filmed:
    """A scene with camera frames of some samples; everything else is delegated to the scene.

    Sample 0 is the state before the first step. A camera only reads the state; the page still
    compares this run with one without frames.

    Args:
        scene: the built scene.
        camera: of that scene.
        samples: the numbers of the samples.
    """

    def __init__(self, scene: Any, camera: Any, samples: Sequence[int]) -> None:
        self._scene, self._camera, self._samples = scene, camera, frozenset(samples)
        self._steps = 0
        self.frames: dict[int, np.ndarray] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._scene, name)

    def step(self) -> None:
        """Advance the scene; take the frames that are due before and after."""
        self._take()
        self._scene.step()
        self._steps += 1
        self._take()

    def _take(self) -> None:
        if self._steps in self._samples and self._steps not in self.frames:
            self.frames[self._steps] = session.capture(self._camera)


def strip(axes: Sequence[Axes], frames: Mapping[int, np.ndarray], dt: float) -> Sequence[Axes]:
    """Show frames by sample number, each below its time [s]."""
    for ax, (sample, frame) in zip(axes, sorted(frames.items()), strict=True):
        ax.imshow(frame[VIEW])
        ax.set_axis_off()
        ax.set_title(f"t = {sample * dt:.2f} s", fontsize="small")
    return axes


def jpeg(figure: Figure) -> bytes:
    """Return a figure of photographs as JPEG: an SVG file would be ten times as large."""
    stream = io.BytesIO()
    figure.savefig(stream, format="jpeg", dpi=90, pil_kwargs={"quality": QUALITY})
    return stream.getvalue()
