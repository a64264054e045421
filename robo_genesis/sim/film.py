"""Camera frames of chosen samples, taken during a run."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from robo_genesis.sim.camera import capture


class FilmedScene:
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
            self.frames[self._steps] = capture(self._camera)
